#include "host/evidence/accuracy.hpp"

#include <cmath>
#include <limits>
#include <numbers>

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger::evidence;

namespace {
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();
}

TEST_GROUP(Accuracy) {
  static constexpr double kHalfPitch_rad = std::numbers::pi / 16;
  const Parameters truth{1, 20, 5, 0.002};
  const Parameters bound{1e-3, 0.1, 0.05, 1e-4};
  const Parameters sigmas{2e-3, 0.2, 0.1, 2e-4};
  Accuracy accuracy{kHalfPitch_rad};

  void off(const Parameters& error, bool isFlagged = false) {
    accuracy.add(truth, bound, {truth + error, sigmas, isFlagged});
  }
};

TEST(Accuracy, ErrorsHaveTheirFigures) {
  Errors errors;
  for (int i = -100; i < 0; ++i) errors.add(i);
  LONGS_EQUAL(100, errors.count());
  DOUBLES_EQUAL(-50.5, errors.mean(), 1e-12);
  DOUBLES_EQUAL(std::sqrt(101.0 * 201 / 6), errors.rms(), 1e-9);  // squares of 1 .. 100
  DOUBLES_EQUAL(50, errors.quantile(0.5), 0);
  DOUBLES_EQUAL(95, errors.quantile(0.95), 0);
  DOUBLES_EQUAL(1, errors.quantile(1e-9), 0);
  DOUBLES_EQUAL(100, errors.worst(), 0);
}

TEST(Accuracy, NoErrorsHaveNoFigures) {
  const Errors none;
  CHECK_TRUE(std::isnan(none.mean()) && std::isnan(none.rms()) && std::isnan(none.worst()));
}

TEST(Accuracy, ErrorsAreComparedWithBoundAndSigma) {
  off({3e-3, 0, 0, 0});
  off({0, -0.4, 0, 1e-4});
  DOUBLES_EQUAL(3 / std::sqrt(2), accuracy.overBound(kAngle).rms(), 1e-9);
  DOUBLES_EQUAL(4, accuracy.overBound(kNormal).worst(), 1e-9);
  DOUBLES_EQUAL(2, accuracy.overSigma(kNormal).worst(), 1e-9);
  DOUBLES_EQUAL(0.5, accuracy.overSigma(kMoment).worst(), 1e-9);
  DOUBLES_EQUAL(-0.2, accuracy.errors(kNormal).mean(), 1e-12);
  LONGS_EQUAL(2, accuracy.touches());
  LONGS_EQUAL(0, accuracy.gross() + accuracy.flagged() + accuracy.overconfident());
}

TEST(Accuracy, AWrongPlaceIsCountedAndSilentUnlessFlagged) {
  off({0.99 * kHalfPitch_rad, 0, 0, 0}, true);
  off({1.01 * kHalfPitch_rad, 3, 0, 0}, true);
  off({-1.01 * kHalfPitch_rad, 3, 0, 0});
  LONGS_EQUAL(2, accuracy.gross());
  LONGS_EQUAL(1, accuracy.silent());
  LONGS_EQUAL(2, accuracy.flagged());
  LONGS_EQUAL(1, accuracy.overconfident());
  LONGS_EQUAL(1, accuracy.errors(kNormal).count());
  LONGS_EQUAL(1, accuracy.overSigma(kNormal).count());
}

TEST(Accuracy, SixSigmasInAnyParameterAreOverconfident) {
  for (int i = 0; i < 4; ++i)
    for (const double far : {5.9, -6.1}) {
      Parameters error = Parameters::Zero();
      error[i] = far * sigmas[i];
      off(error);
    }
  LONGS_EQUAL(4, accuracy.overconfident());
}

TEST(Accuracy, TheSeamOfTheRingIsNoErrorOfARevolution) {
  accuracy.add({0.001, 20, 5, 0}, bound, {{2 * std::numbers::pi - 0.001, 20, 5, 0}, sigmas});
  DOUBLES_EQUAL(-0.002, accuracy.errors(kAngle).mean(), 1e-12);
}

TEST(Accuracy, WhatIsNotToldIsNotCompared) {
  accuracy.add(truth, {1e-3, 0.1, 0.05, 0}, {{1, 20, 5, kNaN}, {1e-3, 0.1, 0.1, kNaN}});
  LONGS_EQUAL(0, accuracy.errors(kMoment).count() + accuracy.overBound(kMoment).count() +
                     accuracy.overSigma(kMoment).count());
  LONGS_EQUAL(1, accuracy.overBound(kTangential).count());
  accuracy.add(truth, Parameters::Constant(std::numeric_limits<double>::infinity()), {truth, sigmas});
  LONGS_EQUAL(1, accuracy.overBound(kTangential).count());
}

TEST(Accuracy, NoNumberIsNoPlace) {
  accuracy.add(truth, bound, {{kNaN, 20, 5, 0}, sigmas});
  LONGS_EQUAL(1, accuracy.gross());
  LONGS_EQUAL(1, accuracy.silent());
}

TEST(Accuracy, TouchesWithoutAnAnswerAreMissed) {
  accuracy.addMissed();
  off({0, 0, 0, 0});
  LONGS_EQUAL(2, accuracy.touches());
  LONGS_EQUAL(1, accuracy.missed());
}
