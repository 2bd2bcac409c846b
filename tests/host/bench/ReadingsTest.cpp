#include "host/bench/readings.hpp"

#include <algorithm>
#include <cmath>

#include "common/fixed_real.hpp"
#include "host/bench/make_bundle.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::bench;

TEST_GROUP(Readings) {
  const BenchFinger finger;
  Reading reading(std::uint64_t seed, std::uint64_t number, double noise = 1e-3) const {
    return readingOf(finger, seed, number, noise);
  }
  static double largest(const Reading& a, const Reading& b) {
    double most = 0;
    for (std::size_t i = 0; i < kGauges; ++i)
      most = std::max(most, std::abs(double{a.sample.strain[i]} - double{b.sample.strain[i]}));
    return most;
  }
};

TEST(Readings, AReadingIsAFunctionOfSeedAndNumber) {
  for (int i = 0; i < 10; ++i) reading(1, static_cast<std::uint64_t>(i));
  CHECK(reading(5, 7).sample.strain_q32 == reading(5, 7).sample.strain_q32);
  CHECK(reading(5, 7).sample.strain_q32 != reading(6, 7).sample.strain_q32);
  CHECK(reading(5, 7).sample.strain_q32 != reading(5, 8).sample.strain_q32);
}

// Held as numbers: another library or machine that draws otherwise is another benchmark.
TEST(Readings, TheFirstReadingOfTheBenchmarkIsThisOne) {
  const Reading first = reading(kLevelSettings[1].seed, 0);
  DOUBLES_EQUAL(7.914886075428, first.truth.position_pitch, 1e-9);
  DOUBLES_EQUAL(27.328798018338, first.truth.normal, 1e-9);
}

TEST(Readings, PlacesCoverTheRingAndDirectionsTheCone) {
  std::array<int, kGauges> seen{};
  for (std::uint64_t i = 0; i < 3200; ++i) {
    const Place<double> truth = reading(2, i).truth;
    ++seen[static_cast<std::size_t>(truth.position_pitch)];
    DOUBLES_EQUAL(kBenchLoad_n_per_m, std::hypot(truth.normal, truth.tangential), 1e-9);
    CHECK(std::abs(truth.tangential) <= truth.normal * (1 + 1e-9));
  }
  for (const int count : seen) CHECK(count > 130 && count < 270);  // 200 expected, 5 sigma
}

TEST(Readings, NoiseHasTheDeviationAskedFor) {
  double squares = 0;
  for (std::uint64_t i = 0; i < 2000; ++i) {
    const Reading noisy = reading(3, i, 1e-2), clean = reading(3, i, 0);
    squares += std::pow(double{noisy.sample.strain[4]} - double{clean.sample.strain[4]}, 2) / 2000;
  }
  const double sigma = 1e-2 * finger.peakPerLoad() * kBenchLoad_n_per_m;
  DOUBLES_EQUAL(1, std::sqrt(squares) / sigma, 0.08);  // 5 sigma of 2000 draws
}

TEST(Readings, BothFormatsHoldTheSameStrain) {
  const Sample sample = reading(4, 4).sample;
  for (std::size_t i = 0; i < kGauges; ++i)
    DOUBLES_EQUAL(toReal(StrainQ32::fromRaw(sample.strain_q32[i])), double{sample.strain[i]}, 1e-9);
}

// The bound's own definition, by differences of the readings themselves.
TEST(Readings, WithoutNoiseTheBoundIsZeroAndItGrowsInProportion) {
  const simulation::Touch place{.angle_rad = 3.2 * BenchFinger::pitch_rad(),
                                .normal_n_per_m = 25,
                                .tangential_n_per_m = 10,
                                .width_m = 0};
  DOUBLES_EQUAL(0, finger.bound(place, 0).norm(), 1e-15);
  DOUBLES_EQUAL(10, finger.bound(place, 1e-4).norm() / finger.bound(place, 1e-5).norm(), 1e-9);
}

TEST(Readings, CleanReadingsDifferFromNoisyOnes) {
  CHECK(largest(reading(5, 1, 0), reading(5, 1, 1e-2)) > 1e-5);
  DOUBLES_EQUAL(0, reading(5, 1, 0).bound[0], 0);
}
