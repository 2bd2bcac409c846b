#include "host/shape/touch_fit.hpp"

#include <Eigen/LU>
#include <cmath>

#include "tests/host/shape/rings.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::shape;
using namespace strainfinger::testing;

TEST_GROUP(TouchFit) {
  const config::FingerConfig config = ringOf(0.7, 32);
  const TouchModel model{config};
  const double noise = 1e-2 * peakStrain(config);

  TouchFit fitOf(const Touch& truth, const Touch& start) const {
    return refine(model, Profile::kEllipse, ellipseStrains(config, truth), noise, start);
  }

  static void areEqual(const Touch& known, const Touch& found) {
    DOUBLES_EQUAL(known.angle_rad, found.angle_rad, 1e-9);
    DOUBLES_EQUAL(known.normal_n_per_m, found.normal_n_per_m, 1e-7);
    DOUBLES_EQUAL(known.tangential_n_per_m, found.tangential_n_per_m, 1e-7);
    DOUBLES_EQUAL(known.moment_rad2, found.moment_rad2, 1e-9);
  }
};

TEST(TouchFit, FindsWhatMadeItsReadings) {
  for (const double width_mm : {0.0, 1.0, 4.0, 8.0})
    for (const double tangential : {0.0, -7.0}) {
      const Touch truth{2.1, 10, tangential, momentOfWidth(width_mm * 1e-3 / kSurface_m)};
      const TouchFit fit = fitOf(truth, {2.14, 8, 1, 0.005});
      areEqual(truth, fit.touch);
      CHECK_TRUE(fit.chiSquared < 1e-10);
      CHECK_FALSE(fit.isAtLimit);
    }
}

// (J^T J)^-1 noise^2 with J by differences of strains made another way.
TEST(TouchFit, ItsCovarianceIsTheCramerRaoBound) {
  const Touch truth{2.1, 10, 3, momentOfWidth(4e-3 / kSurface_m)};
  const Eigen::Vector4d steps(1e-4, 1e-2, 1e-2, 1e-5);
  Eigen::MatrixX4d jacobian(32, 4);
  for (int k = 0; k < 4; ++k) {
    Eigen::Vector4d move = Eigen::Vector4d::Zero();
    move[k] = steps[k];
    const auto at = [&](double sign) {
      return ellipseStrains(config,
                            {truth.angle_rad + sign * move[0], truth.normal_n_per_m + sign * move[1],
                             truth.tangential_n_per_m + sign * move[2], truth.moment_rad2 + sign * move[3]});
    };
    jacobian.col(k) = (at(1) - at(-1)) / 2;
  }
  const Eigen::Matrix4d known =
      noise * noise * (jacobian.transpose() * jacobian).inverse().eval();  // in steps: well scaled
  const auto found = fitOf(truth, truth).covariance;
  for (int k = 0; k < 4; ++k) DOUBLES_EQUAL(1, std::sqrt(found(k, k) / known(k, k)) / steps[k], 1e-4);
}

TEST(TouchFit, AMomentStaysWithinItsLimits) {
  const Touch wide{2.1, 10, 0, 1.2 * TouchModel::kMostMoment_rad2};
  const TouchFit fit = fitOf(wide, {2.1, 10, 0, TouchModel::kMostMoment_rad2 / 2});
  DOUBLES_EQUAL(TouchModel::kMostMoment_rad2, fit.touch.moment_rad2, 0);
  CHECK_TRUE(fit.isAtLimit);
  DOUBLES_EQUAL(2.1, fit.touch.angle_rad, 5e-3);  // the others go on
}

TEST(TouchFit, WhatReadingsDoNotTellIsUnknown) {
  const TouchFit fit = refine(model, Profile::kEllipse, Eigen::VectorXd::Zero(32), noise, {2.1, 0, 0, 0.001});
  CHECK_TRUE(std::isinf(fit.covariance(0, 0)));  // no load: no place
}
