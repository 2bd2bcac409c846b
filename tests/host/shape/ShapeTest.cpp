#include "host/shape/shape.hpp"

#include <cmath>
#include <limits>

#include "host/contact/contact.hpp"
#include "host/contact/contact_field.hpp"
#include "host/shape/quantiles.hpp"
#include "tests/host/shape/rings.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::shape;
using namespace strainfinger::testing;

TEST_GROUP(Shape) {
  config::FingerConfig config = ringOf(0.7, 32);
  const double angle_rad = 3.3;

  /// Noise as a share of the peak strain of 20 N/m.
  std::optional<Shape> shapeOf(const Eigen::VectorXd& strains, double noise) {
    config.gauges.noise_strain = noise * 20 * peakStrain(config);
    return ShapeEstimator(config).estimate(strains);
  }

  Eigen::VectorXd ellipse(double width_mm) const {
    return ellipseStrains(config, {angle_rad, 20, 5, momentOfWidth(width_mm * 1e-3 / kSurface_m)});
  }

  /// What the gauges read of a solved contact whose normal is at angle_rad.
  Eigen::VectorXd contactStrains(const contact::Contact& contact) const {
    std::vector<double> angles_rad;
    const TouchModel ring(config);
    for (int i = 0; i < ring.gauges(); ++i) angles_rad.push_back(ring.gaugeAngle_rad(i) - angle_rad);
    const std::vector<model::Row> rows{model::kErr};
    return contact::computeContactField(contact::SurfaceKernel(config.finger.annulus()), contact.tractions,
                                        config.gauges.radius_m, angles_rad, rows);
  }

  contact::Contact contactOf(const contact::Indenter& indenter, double load_n_per_m) const {
    contact::ContactRequest request;
    request.indenter = indenter;
    request.size = {contact::ContactSize::Kind::kLoad, load_n_per_m};
    return contact::solveContact(contact::SurfaceKernel(config.finger.annulus()), request);
  }

  static void checkWithinBands(const Touch& known, const Shape& shape) {
    const auto check = [](double value, const Measured& found) {
      DOUBLES_EQUAL(value, found.value, kTwoSided95 * found.sigma);
    };
    check(known.angle_rad, shape.angle_rad);
    check(known.normal_n_per_m, shape.normal_n_per_m);
    check(known.tangential_n_per_m, shape.tangential_n_per_m);
    check(kSurface_m * equivalentWidth_rad(known.moment_rad2), *shape.width_m);
  }

  /// A flat end with corners: equal line loads at Chebyshev's nodes.
  Eigen::VectorXd punch(double half_m) const {
    constexpr int kNodes = 60;
    Eigen::VectorXd strains = Eigen::VectorXd::Zero(config.gauges.count);
    for (int k = 0; k < kNodes; ++k) {
      const double place = std::cos(std::numbers::pi * (k + 0.5) / kNodes) * half_m / kSurface_m;
      strains += ellipseStrains(config, {angle_rad + place, 20.0 / kNodes, 0, 0});
    }
    return strains;
  }
};

// 6 mm wide: the pressure is no exact ellipse.
TEST(Shape, MeasuresTheContactOfACylinder) {
  const contact::Contact contact = contactOf(contact::Indenter::cylinder(30e-3), 60);
  const auto shape = shapeOf(contactStrains(contact), 1e-3);
  DOUBLES_EQUAL(angle_rad, shape->touch.angle_rad, 1e-6);
  DOUBLES_EQUAL(60, shape->normal_n_per_m.value, 0.01);
  DOUBLES_EQUAL(0, shape->tangential_n_per_m.value, 0.01);
  DOUBLES_EQUAL(contact.width_m, shape->width_m->value, 2e-3 * contact.width_m);
  DOUBLES_EQUAL(1 / 30e-3, shape->curvature_per_m->value, 0.5);
  CHECK_TRUE(shape->curvature_per_m->sigma > 0.1 && shape->curvature_per_m->sigma < 2);
  CHECK_TRUE(shape->widthLimit_m > contact.width_m);
  CHECK_TRUE(shape->fitProbability > 0.9);
}

TEST(Shape, ANarrowTouchHasALimitOfItsWidthOnly) {
  const auto shape = shapeOf(ellipse(0.3), 1e-2);
  CHECK_FALSE(shape->width_m.has_value());
  CHECK_FALSE(shape->curvature_per_m.has_value());
  CHECK_FALSE(shape->profile.has_value());
  CHECK_TRUE(shape->widthLimit_m > 0.3e-3 && shape->widthLimit_m < 2e-3);
  CHECK_TRUE(shape->directions >= 2);
}

// The curvature follows the width: with 1 % more of it 2 % less, and less for the load's part in it.
TEST(Shape, ACurvatureIsKnownHalfAsWellAsTheWidth) {
  const auto shape = shapeOf(ellipse(4), 1e-2);
  const double both_per_m = shape->curvature_per_m->value + 1 / kSurface_m;
  const double ratio =
      (shape->curvature_per_m->sigma / both_per_m) / (shape->width_m->sigma / shape->width_m->value);
  CHECK_TRUE(ratio > 1.7 && ratio < 2.7);
}

TEST(Shape, ASparseRingTellsNeitherWidthNorClass) {
  config = ringOf(0.85, 16);  // a pitch of 3.6 depths
  const auto shape = shapeOf(ellipse(6), 1e-5);
  CHECK_TRUE(shape->isSparse);
  CHECK_FALSE(shape->width_m.has_value() || shape->profile.has_value());
  config = ringOf(0.85, 32);
  CHECK_FALSE(shapeOf(ellipse(6), 1e-3)->isSparse);
}

TEST(Shape, NamesAClassTheReadingsSeparate) {
  const auto named = [](const std::optional<Shape>& shape) {
    return shape->profile ? nameOf(*shape->profile) : "none";
  };
  STRCMP_EQUAL("punch", named(shapeOf(punch(2.5e-3), 1e-3)));
  STRCMP_EQUAL("round", named(shapeOf(ellipse(6), 1e-3)));
  STRCMP_EQUAL("none", named(shapeOf(punch(2.5e-3), 1e-1)));
  STRCMP_EQUAL("none", named(shapeOf(ellipse(2), 1e-3)));
}

// Without noise in the readings the profile that made them fits best: all is its own, or within the bands.
TEST(Shape, WhatHangsOnTheProfileSaysSo) {
  const TouchModel ring(config);
  int warned = 0, named = 0;
  for (const Profile profile : allProfiles())
    for (const double width_mm : {2.0, 3.0, 4.0, 6.0})
      for (const double noise : {1e-4, 1e-3, 1e-2}) {
        const Touch touch{angle_rad, 20, 5, momentOfWidth(width_mm * 1e-3 / kSurface_m)};
        const auto shape = shapeOf(ring.respond(profile, touch).strains, noise);
        warned += shape->isOfEllipse;
        named += shape->profile == profile;
        if (shape->width_m && !shape->isOfEllipse) checkWithinBands(touch, *shape);
      }
  CHECK_TRUE(warned > 0 && named > 0);
}

TEST(Shape, TwoTouchesAreNoneThatFits) {
  const Eigen::VectorXd other = ellipseStrains(config, {angle_rad + 2, 10, 0, 0});
  STRCMP_EQUAL("round", nameOf(*shapeOf(ellipse(6), 1e-3)->profile));
  const auto shape = shapeOf(ellipse(6) + other, 1e-3);
  CHECK_TRUE(shape->fitProbability < kUnlikely);
  CHECK_FALSE(shape->profile.has_value());
}

TEST(Shape, WhatIsTooWideSaysSo) {
  const auto shape = shapeOf(ellipse(14), 1e-3);  // the fit goes up to 1 rad, 12.7 mm
  CHECK_TRUE(shape->isWidthAtLimit);
  CHECK_FALSE(shapeOf(ellipse(6), 1e-3)->isWidthAtLimit);
}

TEST(Shape, AnUntouchedFingerHasNone) { CHECK_FALSE(shapeOf(Eigen::VectorXd::Zero(32), 1e-3).has_value()); }

TEST(Shape, ThePressureIsThatOfTheLoad) {
  config.gauges.noise_strain = 1e-3 * 20 * peakStrain(config);
  const ShapeEstimator estimator(config);
  const Eigen::VectorXd strains = ellipse(4);
  const auto shape = estimator.estimate(strains);
  const double half_rad = estimator.pressedHalf_rad(*shape);
  DOUBLES_EQUAL(2e-3 / kSurface_m, half_rad, 1e-5);
  const Eigen::VectorXd offsets = Eigen::VectorXd::LinSpaced(2001, -half_rad, half_rad);
  const auto pressure = estimator.pressure(*shape, strains, offsets);
  DOUBLES_EQUAL(20, pressure.pressure_pa.mean() * 4e-3, 0.2);
  CHECK_TRUE(pressure.sigma_pa.minCoeff() > 0);
}

// The error of a model is a noise of its own, as large as the touch.
TEST(Shape, ToleratesWhatAModelErrorAllows) {
  Eigen::VectorXd strains = ellipse(0.5);
  for (Eigen::Index i = 0; i < strains.size(); i += 2) strains[i] *= 1.03;
  CHECK_TRUE(shapeOf(strains, 1e-4)->fitProbability < kUnlikely);
  config.gauges.model_error = 0.03;
  const auto tolerant = shapeOf(strains, 1e-4);
  CHECK_TRUE(tolerant->fitProbability > 0.01);
  DOUBLES_EQUAL(angle_rad, tolerant->angle_rad.value, 2 * tolerant->angle_rad.sigma);
}

TEST(Shape, SigmasHoldWhatNoResidualShows) {
  config.calibration.place_error_m = 3e-4;
  config.calibration.load_error = 0.01;
  config.calibration.moment_error_m2 = 1e-7;
  const auto known = shapeOf(ellipse(4), 1e-3);
  config.calibration = {};
  const auto shape = shapeOf(ellipse(4), 1e-3);
  const auto added = [](const Measured& one, const Measured& other) {
    return std::sqrt(one.sigma * one.sigma - other.sigma * other.sigma);
  };
  DOUBLES_EQUAL(3e-4 / kSurface_m, added(known->angle_rad, shape->angle_rad), 1e-9);
  DOUBLES_EQUAL(0.01 * 20, added(known->normal_n_per_m, shape->normal_n_per_m), 1e-6);
  DOUBLES_EQUAL(0.01 * 20, added(known->tangential_n_per_m, shape->tangential_n_per_m), 1e-6);
  const double width_m = shape->width_m->value;  // 16 times the moment is its square
  DOUBLES_EQUAL(8 * 1e-7 / width_m, added(*known->width_m, *shape->width_m), 1e-9);
}
