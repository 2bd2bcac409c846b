#include "host/bench/training.hpp"

#include <cmath>

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger::bench;

TEST_GROUP(Training) {
  const BenchFinger finger;

  /// RMS error of place over readings that it wasn't trained on [pitches].
  double errorOf(const Perceptron& perceptron) const {
    double squares = 0;
    for (std::uint64_t i = 0; i < 400; ++i) {
      const Reading reading = readingOf(finger, 4711, i, 0);
      const double found = double{perceptron(reading.sample.strain).position_pitch};
      squares += std::pow(std::remainder(found - reading.truth.position_pitch, double{kGauges}), 2) / 400;
    }
    return std::sqrt(squares);
  }
};

TEST(Training, TheSameSeedGivesTheSameWeights) {
  const Training brief{.steps = 20, .seed = 3}, other{.steps = 20, .seed = 4};
  CHECK(trainedPerceptron(finger, brief).last.weight == trainedPerceptron(finger, brief).last.weight);
  CHECK(trainedPerceptron(finger, brief).last.weight != trainedPerceptron(finger, other).last.weight);
}

TEST(Training, AFewHundredStepsTeachTheNearestGauge) {
  const double before = errorOf(trainedPerceptron(finger, {.steps = 1}));
  const double after = errorOf(trainedPerceptron(finger, {.steps = 400}));
  CHECK(after < 0.35);
  CHECK(after < before / 2);
}
