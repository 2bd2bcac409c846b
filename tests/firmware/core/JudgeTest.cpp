#include "firmware/core/judge.hpp"

#include <cmath>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(Judge) {
  TableConstants constants{};
  ScaledReadings readings;
  Solution solution;

  void setup() override {
    constants.gauge_count = 16;
    constants.cone_q8 = 320;  // 1.25
    constants.largest_moment_um2 = 4'000'000;
    readings.variances.reading_q4 = 100 << 4;
    solution.hypothesis = {1, true, allGauges(16)};
    solution.contact[0] = {0, 8000, 0, 0};
  }
  bool isAdmissibleWith(Number normal, Number tangential) {
    return isAdmissible(constants, ContactState{0, normal, tangential, 0});
  }
  bool isPromisingWith(Number normal, Number tangential) {
    solution.contact[0] = {0, normal, tangential, 0};
    return isPromising(constants, solution);
  }
  bool isAcceptedAt(Wide energy) {
    solution.residualEnergy = energy;
    return isAccepted(constants, solution, readings);
  }
  bool isFirmWith(int reading, Number moment_um2) {
    readings.value.fill(0);
    readings.value[3] = static_cast<std::int16_t>(reading);
    solution.contact[0].moment_q20 = static_cast<Number>((Wide{moment_um2} << 20) / 4'000'000);
    return isFirm(constants, solution, readings);
  }
};

TEST(Judge, AnAdmissibleContactPressesWithinItsCone) {
  CHECK_TRUE(isAdmissibleWith(1000, 0));
  CHECK_TRUE(isAdmissibleWith(1000, 1250));
  CHECK_TRUE(isAdmissibleWith(1000, -1250));
  CHECK_FALSE(isAdmissibleWith(1000, 1251));
  CHECK_FALSE(isAdmissibleWith(1000, -1251));
  CHECK_FALSE(isAdmissibleWith(0, 0));
  CHECK_FALSE(isAdmissibleWith(-1000, 0));
}

TEST(Judge, BothContactsOfAPairHaveToBeAdmissible) {
  solution.hypothesis.contacts = 2;
  CHECK_FALSE(isAdmissible(constants, solution));
  solution.contact[1] = {0, 500, 100, 0};
  CHECK_TRUE(isAdmissible(constants, solution));
  solution.contact[0].tangential = 20'000;
  CHECK_FALSE(isAdmissible(constants, solution));
}

TEST(Judge, OfOneContactTheOtherDoesNotMatter) {
  solution.contact[1] = {0, -1, 1'000'000, 0};
  CHECK_TRUE(isAdmissible(constants, solution));
  CHECK_TRUE(isPromising(constants, solution));
}

TEST(Judge, APromisingContactIsWithinFourTimesItsCone) {
  CHECK_TRUE(isPromisingWith(1000, 5000));
  CHECK_TRUE(isPromisingWith(1000, -5000));
  CHECK_FALSE(isPromisingWith(1000, 5004));
  CHECK_FALSE(isPromisingWith(0, 0));
}

TEST(Judge, FreedomsAreReadingsLessUnknowns) {
  LONGS_EQUAL(12, freedoms({1, true, allGauges(16)}));
  LONGS_EQUAL(13, freedoms({1, false, allGauges(16)}));
  LONGS_EQUAL(11, freedoms({1, true, allGauges(16) & ~GaugeSet{4}}));
  LONGS_EQUAL(8, freedoms({2, true, allGauges(16)}));
}

TEST(Judge, ReadingsAreExplainedUpToTheGate) {
  // 12 degrees of freedom: chi-squared of 2 * 12 + 28.
  CHECK_TRUE(isAcceptedAt(0));
  CHECK_TRUE(isAcceptedAt(5200));
  CHECK_FALSE(isAcceptedAt(5201));
}

TEST(Judge, TheGateFollowsTheVariance) {
  readings.variances.reading_q4 = 400 << 4;
  CHECK_TRUE(isAcceptedAt(20'800));
  CHECK_FALSE(isAcceptedAt(20'801));
}

TEST(Judge, TheGateHasRoomForOtherProfiles) {
  readings.value[2] = -32'000;  // a part of it, squared, for each of 12 degrees of freedom
  const double room = 12 * std::ldexp(32'000.0 * 32'000, -2 * threshold::kProfileErrorBits);
  CHECK_TRUE(isAcceptedAt(5200 + static_cast<Wide>(0.95 * room)));
  CHECK_FALSE(isAcceptedAt(5201 + static_cast<Wide>(1.05 * room)));
}

TEST(Judge, InadmissibleContactsExplainNothingThoughWhatTheyLeaveIsWithinTheGate) {
  solution.contact[0].normal = -8000;
  CHECK_FALSE(isAcceptedAt(0));
  CHECK_TRUE(isWithinGate(solution, readings));
}

TEST(Judge, WithoutADegreeOfFreedomNothingIsExplained) {
  solution.hypothesis.gauges = allGauges(12) & 0b1111;
  CHECK_FALSE(isAcceptedAt(0));
  solution.hypothesis.gauges |= 0b10000;
  CHECK_TRUE(isAcceptedAt(0));
}

TEST(Judge, OnAFingerAsBuiltTwiceTheModelsErrorLeavesNoDoubt) {
  const auto isPlainAt = [&](Wide energy, bool asBuilt) {
    solution.residualEnergy = energy;
    return asBuilt ? isPlainAsBuilt(constants, solution, readings) : isPlain(constants, solution, readings);
  };
  // 12 degrees of freedom: chi-squared of 7 / 4 * 12 + 8.
  readings.variances.noise_q4 = 30 << 4;
  CHECK_TRUE(isPlainAt(29 * 100, false));
  CHECK_FALSE(isPlainAt(29 * 100 + 1, false));
  CHECK_TRUE(isPlainAt(29 * (30 + 2 * 70), true));
  CHECK_FALSE(isPlainAt(29 * (30 + 2 * 70) + 1, true));
  readings.variances.noise_q4 = readings.variances.reading_q4;
  CHECK_TRUE(isPlainAt(29 * 100, true));
  CHECK_FALSE(isPlainAt(29 * 100 + 1, true));
}

// So that noise does not begin search after search where chi-squared is at the limit.
TEST(Judge, WhatWasLookedIntoStaysPlainUpToThreeTimesTheModelsError) {
  const auto isPlainAt = [&](Wide energy, bool was) {
    solution.residualEnergy = energy;
    return isPlainAsBuilt(constants, solution, readings, was);
  };
  readings.variances.noise_q4 = 70 << 4;
  CHECK_TRUE(isPlainAt(29 * (70 + 2 * 30), false));
  CHECK_FALSE(isPlainAt(29 * (70 + 2 * 30) + 1, false));
  CHECK_TRUE(isPlainAt(29 * (70 + 3 * 30), true));
  CHECK_FALSE(isPlainAt(29 * (70 + 3 * 30) + 1, true));
  readings.variances.noise_q4 = readings.variances.reading_q4;
  CHECK_TRUE(isPlainAt(29 * 100, true));
  CHECK_FALSE(isPlainAt(29 * 100 + 1, true));
}
TEST(Judge, WhatIsPlainAsBuiltIsAccepted) {
  readings.variances.noise_q4 = 0;
  for (const int gauges : {8, 12, 16, 24, 32}) {
    solution.hypothesis.gauges = allGauges(gauges);
    for (Wide energy = 0; energy < 20'000; energy += 100) {
      solution.residualEnergy = energy;
      for (const bool was : {false, true})
        if (isPlainAsBuilt(constants, solution, readings, was))
          CHECK_TRUE(isAccepted(constants, solution, readings));
    }
  }
}

TEST(Judge, AnswersAreToldApartBeyondNoiseThatAveragesOutAndAModelErrorThatDoesNot) {
  const Variances variances{1600 << 4, 600 << 4, 9000 << 4};
  LONGS_EQUAL(14 * 1600, ambiguity(variances));
  LONGS_EQUAL(14 * (1000 + 300), ambiguity(variances, 2));
  LONGS_EQUAL(14 * (1000 + 150), ambiguity(variances, 4));
  LONGS_EQUAL(14 * 25, ambiguity({100 << 4, 100 << 4, 100 << 4}, 4));
}

// 95 deviations, where the contact is felt most: half its amplitude.
TEST(Judge, AWeakContactStaysOneUntilItIsATwentiethFirmer) {
  const Variances noise{500 << 4, 100 << 4, 900 << 4};  // a deviation of 10
  const auto isWeakAt = [&](Number amplitude, bool was) {
    solution.contact[0].normal = amplitude;
    return isWeak(solution, noise, was);
  };
  CHECK_TRUE(isWeakAt(1896, false));
  CHECK_FALSE(isWeakAt(1898, false));
  CHECK_TRUE(isWeakAt(1998, true));
  CHECK_FALSE(isWeakAt(2000, true));
}

TEST(Judge, APairIsWeakIfOneOfTheTwoIs) {
  const Variances noise{500 << 4, 100 << 4, 900 << 4};
  solution.hypothesis.contacts = 2;
  solution.contact[0].normal = 8000;
  for (const int weaker : {1, 0}) {
    solution.contact[index(weaker)].normal = 1896;
    solution.contact[index(1 - weaker)].normal = 8000;
    CHECK_TRUE(isWeak(solution, noise, false));
    solution.contact[index(weaker)].normal = 1898;
    CHECK_FALSE(isWeak(solution, noise, false));
  }
}

TEST(Judge, AnInadmissibleAnswerCountsAsLessLikely) {
  solution.residualEnergy = 1000;
  LONGS_EQUAL(1000, likelihoodEnergy(constants, solution, readings));
  solution.contact[0].tangential = 30'000;
  LONGS_EQUAL(1000 + 28 * 100, likelihoodEnergy(constants, solution, readings));
}

TEST(Judge, FirmTouchesHaveMuchSignal) {
  for (const Variances& variances :
       {Variances{200 << 4, 200 << 4, 200 << 4}, Variances{150 << 4, 100 << 4, 1700 << 4}}) {
    readings.variances = variances;
    CHECK_TRUE(
        isFirmWith(15'492, 0));  // 1,200,000 variances of a quarter of the largest reading's model error
    CHECK_TRUE(isFirmWith(-15'492, 0));
    CHECK_FALSE(isFirmWith(15'490, 0));
  }
}

TEST(Judge, WideTouchesAreNotFirmUnlessTheirWidthIsKnown) {
  readings.variances = {16, 16, 16};
  CHECK_TRUE(isFirmWith(20'000, 360'000));
  CHECK_FALSE(isFirmWith(20'000, 361'000));
  solution.hypothesis.widthIsFree = false;
  CHECK_TRUE(isFirmWith(20'000, 361'000));
}

TEST(Judge, ATouchThatNotAllGaugesReadIsNotFirm) {
  readings.variances = {16, 16, 16};
  CHECK_TRUE(isFirmWith(20'000, 0));
  solution.hypothesis.gauges &= ~GaugeSet{1 << 9};
  CHECK_FALSE(isFirmWith(20'000, 0));
}
