#include <cmath>

#include "firmware/core/detect.hpp"

#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(NoiseMeter) {
  const ModelRing ring{ModelRing::asDrawn()};
  NoiseMeter meter;
  Presses random{16, 1, 501};

  void take(const std::vector<double>& strains) { take(strains, ring.allGauges()); }
  void take(const std::vector<double>& strains, GaugeSet gauges) {
    meter.take(ring.constants(), ring.raw(strains), gauges);
  }
  /// A second of white noise, so many times the configured one.
  void takeNoise(double times) {
    for (int set = 0; set < 1000; ++set)
      take(random.noisy(std::vector<double>(16, 0.0), times * ring.noise_strain()));
  }
  double found() const { return meter.variance_q4() / 16.0; }
};

TEST(NoiseMeter, StartsAtTheConfiguredNoise) {
  LONGS_EQUAL(kConfiguredNoise_q4, meter.variance_q4());
  CHECK_FALSE(meter.isNoisy());
}

TEST(NoiseMeter, ConfiguredNoiseIsNotNoisy) {
  for (int second = 0; second < 60; ++second) {
    takeNoise(1);
    CHECK(found() < 1.6);
    CHECK_FALSE(meter.isNoisy());
  }
}

TEST(NoiseMeter, MeasuresTheVarianceOfMoreNoise) {
  for (const double times : {3.0, 5.0, 10.0}) {
    meter = {};
    takeNoise(times);
    // Sixteen comparisons of 16 gauges: 6 % of spread.
    DOUBLES_EQUAL(1, found() / (times * times), 0.3);
    CHECK_TRUE(meter.isNoisy());
  }
}

TEST(NoiseMeter, IsRightOnAverageForAnyNumberOfGauges) {
  for (const int gauges : {8, 16, 32}) {
    const ModelRing any{ModelRing::asDrawn(gauges)};
    Presses noise{gauges, 1, 502};
    double sum = 0;
    constexpr int kSeconds = 60;
    for (int second = 0; second < kSeconds; ++second) {
      meter = {};
      for (int set = 0; set < 1000; ++set)
        meter.take(any.constants(),
                   any.raw(noise.noisy(std::vector<double>(static_cast<std::size_t>(gauges), 0.0),
                                       5 * any.noise_strain())),
                   any.allGauges());
      sum += meter.variance_q4() / 16.0 / 25;
    }
    DOUBLES_EQUAL(1, sum / kSeconds, 0.05);
  }
}

TEST(NoiseMeter, CalmsDownWithTheRing) {
  takeNoise(10);
  takeNoise(1);
  CHECK_FALSE(meter.isNoisy());
}

TEST(NoiseMeter, HumCountsInFull) {
  const double amplitude = 60e-6;
  for (int set = 0; set < 1000; ++set)
    take(std::vector<double>(16, amplitude * std::sin(2 * std::numbers::pi * set / 20 + 0.3)));
  CHECK_TRUE(meter.isNoisy());
  const double ratio = amplitude / ring.noise_strain();
  CHECK(found() > 0.2 * ratio * ratio && found() < 2 * ratio * ratio);
}

TEST(NoiseMeter, WhatAGaugeThatDoesNotWorkReadsIsNoNoise) {
  for (int set = 0; set < 1000; ++set) {
    std::vector<double> strains(16, 0.0);
    strains[5] = set / NoiseMeter::kLag % 2 == 0 ? 0.06 : -0.06;
    // It is known now and then: of two sets that are compared one is enough.
    take(strains, set % NoiseMeter::kEvery == 0 ? ring.allGauges() & ~(GaugeSet{1} << 5) : ring.allGauges());
  }
  CHECK_FALSE(meter.isNoisy());
}

TEST(NoiseMeter, DriftIsNoNoise) {
  // 20 microstrain in 10 s.
  for (int set = 0; set < 10'000; ++set)
    take(random.noisy(std::vector<double>(16, 2e-9 * set), ring.noise_strain()));
  CHECK_FALSE(meter.isNoisy());
}

TEST(NoiseMeter, WhatWasBeforeATouchIsNotComparedWithWhatIsAfter) {
  for (int round = 0; round < 100; ++round) {
    for (int set = 0; set < 5; ++set) take(std::vector<double>(16, round % 2 * 1e-3));
    meter.interrupt();
  }
  CHECK_FALSE(meter.isNoisy());
}

// A touch that is not told from a disturbance is a step where it begins and one where it ends, wherever they
// meet the comparisons.
TEST(NoiseMeter, AStepOrTwoAreNoNoise) {
  for (const int length : {8, 16, 30, 48, 1000})
    for (int first = 100; first < 100 + NoiseMeter::kEvery; ++first) {
      meter = {};
      for (int set = 0; set < 300; ++set) {
        const bool isTouched = set >= first && set < first + length;
        take(random.noisy(std::vector<double>(16, isTouched ? 1e-3 : 0.0), ring.noise_strain()));
        CHECK_FALSE(meter.isNoisy());
      }
    }
}

TEST(NoiseMeter, TheLoudestNoiseThereCanBeSaturates) {
  for (int set = 0; set < 1000; ++set)
    take(std::vector<double>(16, set / NoiseMeter::kLag % 2 == 0 ? 0.06 : -0.06));
  CHECK_TRUE(meter.isNoisy());
}
