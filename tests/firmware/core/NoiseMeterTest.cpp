#include <algorithm>
#include <cmath>
#include <cstdio>

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
    // It is known but now and then: of two sets that are compared one is enough.
    take(strains, set % NoiseMeter::kEvery == NoiseMeter::kLag ? ring.allGauges()
                                                               : ring.allGauges() & ~(GaugeSet{1} << 5));
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

TEST(NoiseMeter, AGaugeThatIsNoisyByItselfIsNamedAndTheRingIsMeasuredWithoutIt) {
  for (const int gauges : {12, 16, 32}) {
    const ModelRing any{ModelRing::asDrawn(gauges)};
    Presses noise{gauges, 1, 503};
    int first_set = 0, last_set = 0;
    constexpr int kFingers = 100;
    for (int finger = 0; finger < kFingers; ++finger) {
      meter = {};
      const auto failed = static_cast<std::size_t>(finger % gauges);
      int found_set = 0;
      for (int set = 0; set < 2000; ++set) {
        auto strains =
            noise.noisy(std::vector<double>(static_cast<std::size_t>(gauges), 0.0), any.noise_strain());
        strains[failed] *= 10;
        meter.take(any.constants(), any.raw(strains), any.allGauges());
        if (found_set == 0 && meter.noisyGauges() != 0) found_set = set;
      }
      UNSIGNED_LONGS_EQUAL(GaugeSet{1} << failed, meter.noisyGauges());
      CHECK_TRUE(meter.isNoisy());
      CHECK_COMPARE(found(), <, 1.6);
      first_set = finger == 0 ? found_set : std::min(first_set, found_set);
      last_set = std::max(last_set, found_set);
    }
    std::printf("%d gauges: found after %d to %d sets ", gauges, first_set, last_set);
    CHECK_COMPARE(first_set, >, NoiseMeter::kLag);
    CHECK_COMPARE(last_set, <, 1000);
  }
}

TEST(NoiseMeter, OfGaugesThatAreAlikeNoneIsNoisyByItself) {
  for (const double times : {0.1, 1.0, 2.0, 30.0}) {
    meter = {};
    for (int second = 0; second < 60; ++second) {
      takeNoise(times);
      UNSIGNED_LONGS_EQUAL(0, meter.noisyGauges());
    }
  }
}

TEST(NoiseMeter, HumThatIsUnevenIsNoGaugesOwnNoise) {
  for (int set = 0; set < 10'000; ++set) {
    const double hum = 300e-6 * std::sin(2 * std::numbers::pi * set / 20 + 0.3);
    std::vector<double> strains(16, 0.2 * hum);
    strains[3] = hum;
    take(random.noisy(strains, ring.noise_strain()));
    UNSIGNED_LONGS_EQUAL(0, meter.noisyGauges());
  }
}

// Badly shielded or not: hum is smooth from set to set.
TEST(NoiseMeter, HumOfOneGaugeIsNotNamed) {
  for (const double hertz : {50.0, 60.0, 100.0}) {
    for (const double amplitude : {100e-6, 1e-3}) {
      for (int set = 0; set < 10'000; ++set) {
        std::vector<double> strains(16, 0.0);
        strains[7] = amplitude * std::sin(2 * std::numbers::pi * hertz * set / 1000);
        take(random.noisy(strains, ring.noise_strain()));
        UNSIGNED_LONGS_EQUAL(0, meter.noisyGauges());
      }
    }
  }
}

// Four sets, in which a loud gauge is looked at, are a period of it.
TEST(NoiseMeter, InterferenceOfAQuarterOfTheSampleRateIsMeasured) {
  for (int set = 0; set < 10'000; ++set) {
    std::vector<double> strains(16, 0.0);
    strains[7] = 200e-6 * std::sin(2 * std::numbers::pi * (set / 4.0 + 0.1));
    take(random.noisy(strains, ring.noise_strain()));
  }
  CHECK_TRUE(meter.isNoisy());
}

TEST(NoiseMeter, SetsThatMayBeAContactsAreNotCompared) {
  for (int set = 0; set < 10'000; ++set) {
    const bool mayBeContact = set % 16 >= 8;
    const auto strains =
        random.noisy(std::vector<double>(16, 0.0), (mayBeContact ? 10 : 1) * ring.noise_strain());
    meter.take(ring.constants(), ring.raw(strains), ring.allGauges(), mayBeContact);
    CHECK_COMPARE(found(), <, 1.6);
  }
}

TEST(NoiseMeter, ANoisyGaugeIsNamedInSetsThatMayBeAContacts) {
  for (int set = 0; set < 1000; ++set) {
    auto strains = random.noisy(std::vector<double>(16, 0.0), ring.noise_strain());
    strains[9] *= 10;
    meter.take(ring.constants(), ring.raw(strains), ring.allGauges(), true);
  }
  UNSIGNED_LONGS_EQUAL(1 << 9, meter.noisyGauges());
  DOUBLES_EQUAL(1, found(), 1e-9);
}

// Else it would come and go.
TEST(NoiseMeter, AGaugeOfTwiceTheOthersNoiseIsTakenAsItIs) {
  for (int set = 0; set < 100'000; ++set) {
    auto strains = random.noisy(std::vector<double>(16, 0.0), ring.noise_strain());
    strains[9] *= 2;
    take(strains);
    UNSIGNED_LONGS_EQUAL(0, meter.noisyGauges());
  }
}

TEST(NoiseMeter, OfTwoGaugesThatAreNoisyBothAreNamed) {
  for (int set = 0; set < 3000; ++set) {
    auto strains = random.noisy(std::vector<double>(16, 0.0), ring.noise_strain());
    strains[4] *= 100;
    strains[5] *= 10;
    take(strains);
  }
  UNSIGNED_LONGS_EQUAL(1 << 4 | 1 << 5, meter.noisyGauges());
}

// What it reads on one side alone may be a contact's.
TEST(NoiseMeter, AGaugeThatIsRoughOnOneSideOfItsZeroIsNotNamed) {
  for (int set = 0; set < 20'000; ++set) {
    auto strains = random.noisy(std::vector<double>(16, 0.0), ring.noise_strain());
    strains[9] = 15 * std::abs(strains[9]);
    take(strains);
    UNSIGNED_LONGS_EQUAL(0, meter.noisyGauges());
  }
}

TEST(NoiseMeter, ACodeThatFlickersInARingWithoutNoiseIsNotNoisy) {
  for (int set = 0; set < 2000; ++set) {
    std::vector<double> strains(16, 0.0);
    strains[7] = random.noisy({0.0}, 1.0)[0] > 0 ? ring.noise_strain() : -ring.noise_strain();
    take(strains);
    UNSIGNED_LONGS_EQUAL(0, meter.noisyGauges());
  }
}

TEST(NoiseMeter, SpikesOfOneGaugeNowAndThenAreNotItsNoise) {
  for (int set = 0; set < 100'000; ++set) {
    std::vector<double> strains(16, 0.0);
    if (set % 29 == 0) strains[3] = set % 2 == 0 ? 1e-2 : -1e-2;
    take(random.noisy(strains, ring.noise_strain()));
    UNSIGNED_LONGS_EQUAL(0, meter.noisyGauges());
  }
}

TEST(NoiseMeter, AGaugeThatIsCalmAgainCountsAgainAfterASecond) {
  for (int set = 0; set < 60'000; ++set) {
    auto strains = random.noisy(std::vector<double>(16, 0.0), ring.noise_strain());
    strains[9] *= 10;
    take(strains);
  }
  UNSIGNED_LONGS_EQUAL(1 << 9, meter.noisyGauges());
  for (int set = 0; set < 900; ++set) take(std::vector<double>(16, 0.0));
  UNSIGNED_LONGS_EQUAL(1 << 9, meter.noisyGauges());  // it doesn't come and go
  takeNoise(1);
  UNSIGNED_LONGS_EQUAL(0, meter.noisyGauges());
  CHECK_FALSE(meter.isNoisy());
}
