#include "host/evidence/bound.hpp"

#include <Eigen/Dense>
#include <cmath>
#include <limits>
#include <numbers>
#include <vector>

#include "host/evidence/accuracy.hpp"
#include "host/evidence/touches.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::evidence;

TEST_GROUP(Bound) {
  static constexpr double kSurface_m = 12.7e-3;
  const config::FingerConfig config;
  const FitModel model{config};

  FittedContact contact(double angle_rad, double normal, double tangential, double width_m) const {
    return model.describe({angle_rad, normal, tangential, width_m, model::Profile::kUniform});
  }

  struct Typical {
    double arc_um, normal_n_per_m, moment_mm2;
  };
  /// RMS over all places and load directions.
  Typical typicalOf(double width_m, const Unknowns& unknowns) const {
    TouchRanges ranges;
    ranges.width_m = {width_m, width_m};
    ranges.profile = model::Profile::kUniform;
    const TouchDraws draws(config.gauges, ranges, 1);
    Errors arc, normal, moment;
    for (std::uint64_t i = 0; i < 4000; ++i) {
      const Parameters bound =
          cramerRaoBound(model, model.describe(draws.at(i)), unknowns, config.gauges.noise_strain);
      arc.add(bound[kAngle] * kSurface_m * 1e6);
      normal.add(bound[kNormal]);
      moment.add(bound[kMoment] * kSurface_m * kSurface_m * 1e6);
    }
    return {arc.rms(), normal.rms(), moment.rms()};
  }
};

// Computed for the default finger by another program, with a uniform pressure's derivatives: one digit less
// sharp.
TEST(Bound, IsWhatItWasKnownToBe) {
  struct Known {
    double width_m, arc_um, arcFitted_um, normal_n_per_m;
  };
  for (const Known& known :
       {Known{0, 5.0, 6.8, 0.071}, Known{1e-3, 5.3, 7.2, 0.071}, Known{2e-3, 6.4, 8.6, 0.074}}) {
    const Typical told = typicalOf(known.width_m, kWidthKnown),
                  fitted = typicalOf(known.width_m, kWidthUnknown);
    DOUBLES_EQUAL(1, told.arc_um / known.arc_um, 0.03);
    DOUBLES_EQUAL(1, fitted.arc_um / known.arcFitted_um, 0.03);
    DOUBLES_EQUAL(1, fitted.normal_n_per_m / known.normal_n_per_m, 0.02);
    DOUBLES_EQUAL(0.009, fitted.moment_mm2, 0.0005);
    DOUBLES_EQUAL(0, told.moment_mm2, 0);
  }
}

// The information matrix of a line load, written down from the impulse response.
TEST(Bound, OfALineLoadIsTheInverseOfItsInformation) {
  const model::ImpulseResponse response(config.finger.annulus(), config.gauges.radius_m,
                                        config.gauges.component);
  const std::vector<int> leftOut{3, 9};
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (int gauge = 0; gauge < 16; ++gauge) {
    if (gauge == 3 || gauge == 9) continue;
    const auto value = response.at(gauge * std::numbers::pi / 8 - 1.3);
    const Eigen::Vector3d row(-20 * value.normalSlope - 7 * value.tangentialSlope, value.normal,
                              value.tangential);
    information += row * row.transpose();
  }
  const Eigen::Vector3d expected = 6e-6 * information.inverse().diagonal().cwiseSqrt();
  const Parameters found = cramerRaoBound(model, contact(1.3, 20, 7, 0), kWidthKnown, 6e-6, leftOut);
  for (int i = 0; i < 3; ++i) DOUBLES_EQUAL(1, found[i] / expected[i], 1e-6);
}

// The same by differences of the readings, all eight unknowns of two contacts together.
TEST(Bound, OfTwoContactsIsTheInverseOfTheirInformation) {
  const std::vector<FittedContact> contacts{contact(1.3, 20, 7, 2e-3), contact(2.3, 9, -3, 1e-3)};
  const auto found = cramerRaoBound(model, contacts, kWidthUnknown, 6e-6);
  Eigen::MatrixXd columns(16, 8);
  const double steps[] = {1e-5, 1e-3, 1e-3, 1e-6};
  for (std::size_t which = 0; which < 2; ++which)
    for (std::size_t i = 0; i < 4; ++i) {
      const auto readingsAt = [&](double step) {
        auto moved = contacts;
        double* const members[] = {&moved[which].angle_rad, &moved[which].load.normal_n_per_m,
                                   &moved[which].load.tangential_n_per_m, &moved[which].load.moment_rad2};
        *members[i] += step;
        return model.readings(moved);
      };
      columns.col(static_cast<Eigen::Index>(4 * which + i)) =
          (readingsAt(steps[i]) - readingsAt(-steps[i])) / (2 * steps[i]);
    }
  const Eigen::MatrixXd scaled = columns * columns.colwise().norm().cwiseInverse().asDiagonal();
  const Eigen::VectorXd expected =
      (6e-6 * (scaled.transpose() * scaled).inverse().diagonal().cwiseSqrt()).array() /
      columns.colwise().norm().transpose().array();
  for (Eigen::Index i = 0; i < 8; ++i)
    DOUBLES_EQUAL(1, found[static_cast<std::size_t>(i / 4)][i % 4] / expected[i], 1e-4);
}

TEST(Bound, ContactsFarApartAreFoundLikeEachAlone) {
  const std::vector<FittedContact> contacts{contact(0.3, 20, 7, 2e-3), contact(3.3, 9, -3, 1e-3)};
  const auto together = cramerRaoBound(model, contacts, kWidthUnknown, 6e-6);
  for (std::size_t which = 0; which < 2; ++which) {
    const Parameters alone = cramerRaoBound(model, contacts[which], kWidthUnknown, 6e-6);
    for (int i = 0; i < 4; ++i) DOUBLES_EQUAL(1, together[which][i] / alone[i], 0.02);
  }
}

TEST(Bound, ContactsNearEachOtherAreHardToTellAndInOnePlaceImpossible) {
  const FittedContact first = contact(0.3, 20, 7, 2e-3), near = contact(0.7, 9, -3, 1e-3);
  const Parameters alone = cramerRaoBound(model, first, kWidthUnknown, 6e-6);
  const std::vector<FittedContact> apart{first, near}, same{first, first};
  CHECK_TRUE(cramerRaoBound(model, apart, kWidthUnknown, 6e-6)[0][kAngle] > 2 * alone[kAngle]);
  CHECK_TRUE(std::isinf(cramerRaoBound(model, same, kWidthUnknown, 6e-6)[1][kNormal]));
}

TEST(Bound, TooFewGaugesTellNothing) {
  std::vector<int> leftOut;
  for (int gauge = 3; gauge < 16; ++gauge) leftOut.push_back(gauge);
  const FittedContact pressed = contact(0.4, 20, 7, 2e-3);
  CHECK_TRUE(std::isinf(cramerRaoBound(model, pressed, kWidthUnknown, 6e-6, leftOut)[kAngle]));
  CHECK_TRUE(std::isfinite(cramerRaoBound(model, pressed, kWidthKnown, 6e-6, leftOut)[kAngle]));
}

TEST(Bound, WhatIsKnownIsFreeOfErrorAndHelpsTheOthers) {
  const FittedContact pressed = contact(0.4, 20, 7, 2e-3);
  const Parameters all = cramerRaoBound(model, pressed, kWidthUnknown, 6e-6);
  const Parameters placed = cramerRaoBound(model, pressed, {kNormal, kTangential}, 6e-6);
  DOUBLES_EQUAL(0, placed[kAngle], 0);
  DOUBLES_EQUAL(0, placed[kMoment], 0);
  CHECK_TRUE(placed[kNormal] < all[kNormal] && placed[kTangential] < all[kTangential]);
}
