#include "host/simulation/noise.hpp"

#include <cmath>
#include <cstdio>

#include <CppUTest/TestHarness.h>

using strainfinger::simulation::Noise;

TEST_GROUP(Noise) {
  static constexpr int kSamples = 31'250;  ///< of 32 channels: a million numbers
  const Noise noise{1};

  template <typename Function>
  double mean(Function function) {
    double sum = 0;
    for (std::uint64_t sample = 0; sample < kSamples; ++sample)
      for (std::uint32_t channel = 0; channel < 32; ++channel) sum += function(sample, channel);
    return sum / (32.0 * kSamples);
  }
};

// The limits below are five standard errors of a million standard normal numbers.
TEST(Noise, MomentsAreThoseOfTheStandardNormalDistribution) {
  const auto moment = [&](int power) {
    return mean([&](auto sample, auto channel) { return std::pow(noise.at(sample, channel), power); });
  };
  DOUBLES_EQUAL(0, moment(1), 5 * std::sqrt(1e-6));
  DOUBLES_EQUAL(1, moment(2), 5 * std::sqrt(2e-6));
  DOUBLES_EQUAL(0, moment(3), 5 * std::sqrt(15e-6));
  DOUBLES_EQUAL(3, moment(4), 5 * std::sqrt(96e-6));
}

TEST(Noise, TheShareBeyondEachSigmaIsTheNormalDistributions) {
  for (const double limit : {0.5, 1.0, 2.0, 3.0, 4.0}) {
    const double expected = std::erfc(limit / std::sqrt(2.0));
    const double share = mean([&](auto s, auto c) { return std::fabs(noise.at(s, c)) > limit ? 1.0 : 0.0; });
    DOUBLES_EQUAL(expected, share, 5 * std::sqrt(expected * 1e-6));
  }
}

TEST(Noise, NeighboursInTimeInTheRingAndInSeedAreUncorrelated) {
  const Noise other(2);
  DOUBLES_EQUAL(0, mean([&](auto s, auto c) { return noise.at(s, c) * noise.at(s + 1, c); }), 5e-3);
  DOUBLES_EQUAL(0, mean([&](auto s, auto c) { return noise.at(s, c) * noise.at(s, (c + 1) % 32); }), 5e-3);
  DOUBLES_EQUAL(0, mean([&](auto s, auto c) { return noise.at(s, c) * other.at(s, c); }), 5e-3);
}

// Oracle: the same generator written in Python.
TEST(Noise, ANumberOfASeedNeverChanges) { DOUBLES_EQUAL(0.369697707109835, Noise(1).at(7, 3), 1e-14); }

TEST(Noise, ANumberDependsOnItsAddressAlone) {
  const double first = noise.at(7, 3);
  noise.at(8, 3);
  DOUBLES_EQUAL(first, Noise(1).at(7, 3), 0);
}
