#include "host/shape/touch_model.hpp"

#include <vector>

#include "host/model/field.hpp"
#include "tests/host/shape/rings.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::shape;
using namespace strainfinger::testing;

TEST_GROUP(TouchModel) {
  config::FingerConfig config = ringOf(0.7, 16);
  const Touch touch{1.234, 10, -4, momentOfWidth(0.3)};

  TouchModel model() const { return TouchModel(config); }
  double peak() const { return 10 * peakStrain(ringOf(0.7, 16)); }
};

TEST(TouchModel, ReadsWhatLineLoadsUnderTheEllipseAddUpTo) {
  for (const auto component : {StrainComponent::kRadial, StrainComponent::kHoop, StrainComponent::kShear}) {
    config.gauges.component = component;
    config.gauges.arc_length_m = 1e-3;
    config.gauges.first_angle_deg = 7;
    const Eigen::VectorXd strains = model().respond(Profile::kEllipse, touch).strains;
    DOUBLES_EQUAL(0, (strains - ellipseStrains(config, touch)).cwiseAbs().maxCoeff(), 1e-12 * peak());
  }
}

TEST(TouchModel, EachGaugeReadsFromWhereItsCalibrationHasIt) {
  config = asBuilt(config);
  for (const auto component : {StrainComponent::kRadial, StrainComponent::kShear}) {
    config.gauges.component = component;
    const Eigen::VectorXd strains = model().respond(Profile::kEllipse, touch).strains;
    DOUBLES_EQUAL(0, (strains - ellipseStrains(config, touch)).cwiseAbs().maxCoeff(), 1e-12 * peak());
  }
}

// The model of uniform loads has been there before, and is tested on its own.
TEST(TouchModel, ReadsWhatAUniformLoadMakes) {
  const TouchModel ring = model();
  const double width_rad = 2 * halfWidth_rad(Profile::kUniform, touch.moment_rad2);
  const model::SurfaceLoad load{touch.normal_n_per_m, touch.tangential_n_per_m, 0, width_rad};
  std::vector<double> angles_rad;
  for (int i = 0; i < ring.gauges(); ++i) angles_rad.push_back(ring.gaugeAngle_rad(i) - touch.angle_rad);
  const std::vector<model::Row> rows{model::kErr};
  const auto known =
      model::computeField(config.finger.annulus(), config.gauges.radius_m, load, angles_rad, rows);
  const auto strains = ring.respond(Profile::kUniform, touch).strains;
  DOUBLES_EQUAL(0, (strains - known.col(0)).cwiseAbs().maxCoeff(), 1e-12 * peak());
}

TEST(TouchModel, SlopesAreDerivatives) {
  const TouchModel ring = model();
  const auto slopes = ring.respond(Profile::kEllipse, touch).slopes;
  const std::vector<double> steps{1e-6, 1e-3, 1e-3, 1e-7};
  for (int member = 0; member < 4; ++member) {
    Eigen::Vector4d move = Eigen::Vector4d::Zero();
    move[member] = steps[static_cast<std::size_t>(member)];
    const auto at = [&](double sign) {
      const Touch moved{touch.angle_rad + sign * move[0], touch.normal_n_per_m + sign * move[1],
                        touch.tangential_n_per_m + sign * move[2], touch.moment_rad2 + sign * move[3]};
      return ring.respond(Profile::kEllipse, moved).strains;
    };
    const Eigen::VectorXd difference = (at(1) - at(-1)) / (2 * move[member]);
    DOUBLES_EQUAL(0, (slopes.col(member) - difference).norm(), 1e-7 * slopes.col(member).norm());
  }
}

TEST(TouchModel, LineStrainsAreImpulseResponses) {
  const TouchModel ring = model();
  const Eigen::Vector2d angles_rad(0.1, 3);
  const auto strains = ring.normalLineStrains(angles_rad);
  const model::ImpulseResponse line(config.finger.annulus(), config.gauges.radius_m, config.gauges.component);
  for (int i = 0; i < ring.gauges(); ++i)
    for (const Eigen::Index k : {0, 1})
      DOUBLES_EQUAL(line.at(ring.gaugeAngle_rad(i) - angles_rad[k]).normal, strains(i, k), 1e-13 * peak());
}

// Half the decay of a line load's harmonics is left: as smooth as a gauge twice as far from the surface, so
// no larger than the squared peak.
TEST(TouchModel, IsRegularDownToItsLeastMoment) {
  const TouchModel ring = model();
  Touch narrow = touch;
  narrow.moment_rad2 = ring.leastMoment_rad2();
  CHECK_TRUE(narrow.moment_rad2 < 0);
  CHECK_TRUE(ring.respond(Profile::kEllipse, narrow).strains.cwiseAbs().maxCoeff() < 20 * peak());
}
