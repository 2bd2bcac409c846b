#include "firmware/core/gauge_watch.hpp"

#include "firmware/core/locate.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

constexpr GaugeSet kFive = 1u << 5;

template <int Gauges>
struct Watched : Utest {
  const ModelRing ring{ModelRing::configOf(Gauges)};

  std::vector<double> sum(const Press& one, const Press& other) {
    auto strains = ring.strains(one);
    const auto others = ring.strains(other);
    for (std::size_t i = 0; i < strains.size(); ++i) strains[i] += others[i];
    return strains;
  }
  bool misfits(const std::vector<double>& strains) {
    const auto raw = ring.raw(strains);
    const std::uint32_t energy = gateEnergy(ring.constants(), raw);
    return isMisfit(ring.tables(), raw, energy, locate(ring.tables(), FitMode::kRefined, raw, energy));
  }
  Misfit examined(const std::vector<double>& strains) {
    const auto raw = ring.raw(strains);
    return examine(ring.tables(), 0, raw, gateEnergy(ring.constants(), raw));
  }
};

}  // namespace

TEST_GROUP_BASE(GaugeWatch, Watched<16>) { GaugeWatch watch; };
TEST_GROUP_BASE(GaugeWatchOfAFineRing, Watched<24>){};

TEST(GaugeWatch, TwoAccusationsInFourSetsTakeAGaugeOutOfUse) {
  watch.accuse(kFive);
  LONGS_EQUAL(0, watch.outOfUse());
  for (int i = 0; i < 3; ++i) watch.accuse(0);
  watch.accuse(kFive);
  LONGS_EQUAL(kFive, watch.outOfUse());
}

TEST(GaugeWatch, AccusationsFarApartAreForgotten) {
  for (int round = 0; round < 100; ++round) {
    watch.accuse(kFive);
    for (int i = 0; i < 16; ++i) watch.accuse(0);
  }
  LONGS_EQUAL(0, watch.outOfUse());
}

TEST(GaugeWatch, LastingMisfitsAreLookedIntoAtOnceAndThenNowAndAgain) {
  int looks = 0;
  for (int i = 0; i < 4; ++i) looks += watch.wantsToExamine();
  LONGS_EQUAL(4, looks);
  for (int i = 0; i < 640; ++i) looks += watch.wantsToExamine();
  LONGS_EQUAL(14, looks);
  watch.allIsWell();
  CHECK_TRUE(watch.wantsToExamine());
}

TEST(GaugeWatch, OneContactFits) {
  Presses presses(16, 30, 601);
  for (int i = 0; i < 2000; ++i) CHECK_FALSE(misfits(ring.strains(presses.next())));
}

TEST(GaugeWatch, TwoContactsAreSeveral) {
  const auto strains = sum({2.3, 20, 0}, {9.6, 15, 5});
  CHECK_TRUE(misfits(strains));
  CHECK_TRUE(examined(strains).several);
  LONGS_EQUAL(0, examined(strains).culprit);
}

TEST(GaugeWatch, AGaugeThatReadsWhatNothingElseSeesIsTheCulprit) {
  std::vector<double> strains(16, 0.0);
  strains[5] = 2e-3;
  LONGS_EQUAL(kFive, examined(strains).culprit);
  strains = ring.strains({10.2, 20, 0});
  strains[5] = 4e-3;
  CHECK_TRUE(misfits(strains));
  LONGS_EQUAL(kFive, examined(strains).culprit);
}

TEST(GaugeWatchOfAFineRing, OneContactFits) {
  Presses presses(24, 30, 603);
  for (int i = 0; i < 1000; ++i) CHECK_FALSE(misfits(ring.strains(presses.next())));
}

// 4 pitches from gauge 5, on either side.
TEST(GaugeWatchOfAFineRing, AGaugeOfTheOuterPairIsTheCulpritWhereItIsFarOff) {
  for (const double position : {8.7, 9.0, 9.3, 1.0, 0.8}) {
    auto strains = ring.strains({position, 20, 10});
    strains[5] += 8e-3;
    CHECK_TRUE(misfits(strains));
    LONGS_EQUAL(kFive, examined(strains).culprit);
  }
}

TEST(GaugeWatchOfAFineRing, WhatMayBeEitherOfTheOuterPairIsNoSecondContact) {
  for (const double position : {8.7, 9.0, 9.3, 1.0, 0.8}) {
    auto strains = ring.strains({position, 20, 10});
    strains[5] -= 2e-3;
    CHECK_TRUE(misfits(strains));
    CHECK_FALSE(examined(strains).several);
    LONGS_EQUAL(0, examined(strains).culprit & ~kFive);
  }
}

TEST_GROUP(JumpWatch) {
  const ModelRing ring;
  JumpWatch watch{ring.constants()};
  Presses random{16, 1, 602};

  GaugeSet taken(const std::vector<double>& strains) {
    const auto raw = ring.raw(strains);
    return watch.take(ring.constants(), raw, gateEnergy(ring.constants(), raw));
  }

  /// Sample sets until a gauge is found noisy; all have the noise of a reading, `gauge` so many times that.
  std::pair<GaugeSet, int> found(std::size_t gauge, double noisier, int most) {
    for (int set = 1; set <= most; ++set) {
      std::vector<double> strains(16);
      for (double& strain : strains) strain = random.noise(ring.noise_strain());
      strains[gauge] *= noisier;
      if (const GaugeSet culprits = taken(strains); culprits != 0) return {culprits, set};
    }
    return {0, most};
  }
};

TEST(JumpWatch, FindsTheNoisyGauge) {
  for (const std::size_t gauge : {0u, 7u, 15u}) LONGS_EQUAL(1u << gauge, found(gauge, 5, 10'000).first);
}

TEST(JumpWatch, FindsTenTimesTheNoiseWithinThreeRoundsOfTheRing) {
  int longest = 0;
  for (int trial = 0; trial < 50; ++trial) longest = std::max(longest, found(7, 10, 10'000).second);
  CHECK(longest <= 3 * 16 * 9);
}

TEST(JumpWatch, HealthyGaugesAreNotNoisy) { LONGS_EQUAL(0, found(0, 1, 200'000).first); }

TEST(JumpWatch, AStepIsNotNoise) {
  for (int set = 0; set < 1000; ++set) LONGS_EQUAL(0, taken(std::vector<double>(16, set / 40 % 2 * 1e-3)));
}

TEST(JumpWatch, WhatMovesTheRestOfTheRingIsATouch) {
  for (int set = 0; set < 1000; ++set)
    LONGS_EQUAL(0, taken(ring.strains({set % 16 / 2.0, set % 3 * 5.0, 0})));
}
