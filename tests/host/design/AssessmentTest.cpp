#include "host/design/assessment.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/model/impulse_response.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::design;

TEST_GROUP(Assessment) {
  config::FingerConfig config;
  simulation::Touch touch{0, 30, 0, 1e-3, model::Profile::kUniform};

  Assessment of(int gauges, double radius_m) {
    config.gauges.count = gauges;
    config.gauges.radius_m = radius_m;
    return assess(config, touch);
  }
};

// The information matrix of a line load at each of 256 places of a pitch, written down from the impulse
// response.
TEST(Assessment, BoundsOfALineAreThoseOfItsInformation) {
  config.contact.width_m = 0;
  touch = {0, 30, 12, 0, model::Profile::kUniform};
  const model::ImpulseResponse response(config.finger.annulus(), config.gauges.radius_m,
                                        config.gauges.component);
  std::vector<double> arcs_m, normals;
  for (int place = 0; place < 256; ++place) {
    Eigen::MatrixX3d columns(16, 3);
    for (int gauge = 0; gauge < 16; ++gauge) {
      const auto value = response.at((gauge - place / 256.0) * std::numbers::pi / 8);
      columns.row(gauge) << value.normal, value.tangential,
          30 * value.normalSlope + 12 * value.tangentialSlope;
    }
    const Eigen::Matrix3d covariance = (columns.transpose() * columns).inverse();
    normals.push_back(6e-6 * std::sqrt(covariance(0, 0)));
    arcs_m.push_back(12.7e-3 * 6e-6 * std::sqrt(covariance(2, 2)));
  }
  const auto check = [](std::vector<double> expected, const Bound& bound) {
    std::sort(expected.begin(), expected.end());
    DOUBLES_EQUAL(1, bound.median / ((expected[127] + expected[128]) / 2), 1e-6);
    DOUBLES_EQUAL(1, bound.worst / expected.back(), 1e-6);
  };
  const Assessment found = assess(config, touch);
  STRCMP_EQUAL("", found.problem.c_str());
  check(arcs_m, found.bounds.value().arc_m);
  check(normals, found.bounds->normal_n_per_m);
}

TEST(Assessment, BoundsAreProportionalToNoise) {
  const Bounds one = assess(config, touch).bounds.value();
  config.gauges.noise_strain *= 3;
  const Bounds three = assess(config, touch).bounds.value();
  DOUBLES_EQUAL(3, three.arc_m.worst / one.arc_m.worst, 1e-9);
  DOUBLES_EQUAL(3, three.tangential_n_per_m.median / one.tangential_n_per_m.median, 1e-9);
  DOUBLES_EQUAL(3, three.width_m->worst / one.width_m->worst, 1e-9);
}

// Gauges of a dense ring are many readings of the same field: N of them tell sqrt(N) times as much.
TEST(Assessment, TwiceTheGaugesOfADenseRingTellRootTwoTimesAsMuch) {
  const Bounds few = of(40, 9.4e-3).bounds.value(), many = of(80, 9.4e-3).bounds.value();
  DOUBLES_EQUAL(std::sqrt(2), few.normal_n_per_m.median / many.normal_n_per_m.median, 0.02);
}

TEST(Assessment, AKnownWidthHasNoBoundAndTellsMoreOfPlaces) {
  touch.tangential_n_per_m = 15;
  const Bounds unknown = assess(config, touch).bounds.value();
  config.contact.width_m = 1e-3;
  const Bounds known = assess(config, touch).bounds.value();
  CHECK_FALSE(known.width_m.has_value());
  CHECK_COMPARE(known.arc_m.worst, <, unknown.arc_m.worst);
}

TEST(Assessment, ALineHasNoWidthToBeOff) {
  touch.width_m = 0;
  CHECK_FALSE(assess(config, touch).bounds.value().width_m.has_value());
}

TEST(Assessment, WhatTheFirmwareMakesOfTheFingerIsToldBeside) {
  const Trial trial = assess(config, touch).trial.value();
  LONGS_EQUAL(24568, trial.tableBytes);
  DOUBLES_EQUAL(1, trial.certainShare, 0);
  DOUBLES_EQUAL(65, trial.fullScale_n_per_m, 1);
  CHECK_COMPARE(trial.detected_n_per_m, <, 1);
}

TEST(Assessment, FewerGaugesThanTheFirmwareFitsHaveBoundsAndAProblem) {
  const Assessment found = of(8, config.gauges.radius_m);
  CHECK_TRUE(std::isfinite(found.bounds.value().arc_m.worst));
  CHECK_FALSE(found.trial.has_value());
  STRCMP_CONTAINS("gauges.count = 8 must be", found.problem.c_str());
}

TEST(Assessment, BoundsOfMoreUnknownsThanReadingsAreInfinite) {
  CHECK_TRUE(std::isinf(of(3, config.gauges.radius_m).bounds.value().arc_m.median));
}

TEST(Assessment, GaugesTooShallowForTheirSpacingAreAProblem) {
  STRCMP_CONTAINS("too shallow for their spacing", of(12, 11.9e-3).problem.c_str());
}

// On the default finger 65 N/m read full scale over a gauge, of which touches may use 95 %.
TEST(Assessment, ATouchBeyondFullScaleIsAProblem) {
  touch.width_m = 0;
  touch.normal_n_per_m = 61;
  STRCMP_EQUAL("", assess(config, touch).problem.c_str());
  touch.normal_n_per_m = 63;
  STRCMP_CONTAINS("gauges.full_scale_strain = 0.03", assess(config, touch).problem.c_str());
}

TEST(Assessment, ATouchThatTheGateMayMissIsAProblem) {
  touch.normal_n_per_m = 0.5;
  STRCMP_CONTAINS("may go unnoticed", assess(config, touch).problem.c_str());
}

// Below 95 times the noise where it is felt most a touch is flagged.
TEST(Assessment, ATouchThatTheFirmwareFlagsIsAProblem) {
  config.gauges.noise_strain = 3e-5;
  touch.width_m = 1e-3;
  touch.normal_n_per_m = 5;
  const Assessment weak = assess(config, touch);
  DOUBLES_EQUAL(0, weak.trial.value().certainShare, 0);
  STRCMP_CONTAINS("the firmware flags this touch as uncertain", weak.problem.c_str());
  touch.normal_n_per_m = 10;
  STRCMP_EQUAL("", assess(config, touch).problem.c_str());
}

// The fit cannot tell such a touch from a wider one.
TEST(Assessment, ATouchAsWideAsTheTablesCoverIsAProblemOfTheTables) {
  touch.width_m = 4e-3;
  STRCMP_EQUAL("", assess(config, touch).problem.c_str());
  config.contact.largest_width_m = 4e-3;
  STRCMP_CONTAINS("as wide as the tables cover: a larger contact.largest_width_m than 0.004 is needed",
                  assess(config, touch).problem.c_str());
}

// Sparse, shallow gauges hardly tell a wide touch's place from its width.
TEST(Assessment, PlacesThatReadingsDoNotDetermineAreCounted) {
  DOUBLES_EQUAL(1, assess(config, touch).bounds->identifiableShare, 0);
  touch = {0, 0.4, 0, 8e-3, model::Profile::kUniform};
  const Assessment found = of(12, 10.9e-3);
  DOUBLES_EQUAL(0.84, found.bounds.value().identifiableShare, 0.1);
  STRCMP_CONTAINS("% of the places the readings don't determine the touch", found.problem.c_str());
}

// 2 pi 12.7 mm / 12 over 3.3 mm.
TEST(Assessment, ASparseRingIsAProblem) {
  STRCMP_CONTAINS("2.015 times their depth apart", of(12, 9.4e-3).problem.c_str());
}

TEST(Assessment, NoiseBelowTheConvertersStepIsAProblem) {
  config.gauges.noise_strain = 1e-9;
  const Assessment found = assess(config, touch);
  STRCMP_CONTAINS("less than the quantisation alone", found.problem.c_str());
  CHECK_TRUE(found.bounds.has_value());
}

TEST(Assessment, IsOfTheFingerAsDrawn) {
  const Bounds drawn = assess(config, touch).bounds.value();
  config.calibration.gain.assign(16, 1.3);
  config.as_built.gain = 0.1;
  for (int i = 0; i < 16; ++i) config.gauges.angles_deg.push_back(i * 22.5 + i % 2);
  DOUBLES_EQUAL(drawn.arc_m.worst, assess(config, touch).bounds->arc_m.worst, 0);
}
