#include "host/bench/training.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger::bench;

TEST_GROUP(Training) {
  const BenchFinger finger;

  /// Median error of place over readings that it wasn't trained on [pitches].
  double errorOf(const Perceptron& perceptron) const {
    std::vector<double> errors;
    for (std::uint64_t i = 0; i < 401; ++i) {
      const Reading reading = readingOf(finger, 4711, i, 0);
      const double found = double{perceptron(reading.sample.strain).position_pitch};
      errors.push_back(std::abs(std::remainder(found - reading.truth.position_pitch, double{kGauges})));
    }
    std::nth_element(errors.begin(), errors.begin() + 200, errors.end());
    return errors[200];
  }
};

TEST(Training, TheSameSeedGivesTheSameWeights) {
  const Training brief{.steps = 20, .seed = 3, .contacts = 640},
      other{.steps = 20, .seed = 4, .contacts = 640};
  CHECK(trainedPerceptron(finger, brief).last.weight == trainedPerceptron(finger, brief).last.weight);
  CHECK(trainedPerceptron(finger, brief).last.weight != trainedPerceptron(finger, other).last.weight);
}

TEST(Training, AFewThousandStepsTeachWhereInThePitchAContactIs) {
  const double before = errorOf(trainedPerceptron(finger, {.steps = 1, .contacts = 64}));
  const double after = errorOf(trainedPerceptron(finger, {.steps = 4000, .contacts = 6400}));
  CHECK(after < 0.1);
  CHECK(after < before / 2);
}
