#include <algorithm>
#include <cmath>
#include <random>

#include "firmware/core/report.hpp"

#include "common/fixed_real.hpp"
#include "firmware/core/detect.hpp"
#include "firmware/core/estimate.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(TouchFrames) {
  TableConstants constants{};
  Contact contact;
  std::optional<Contact> second;
  FingerFlags flags{FingerFlag::kContact};
  std::mt19937 random{41};

  void setup() override {
    std::printf("seed 41 ");
    constants.force_per_load_q16 = 20 << 16;  // 20 mm: 20 mN for 1 N/m
  }
  TouchFrames frames() { return touchFrames(constants, contact, second, flags, 7); }
  LineLoadQ12 anyLoad(std::int32_t limit) {
    return LineLoadQ12::fromRaw(std::uniform_int_distribution<std::int32_t>(-limit, limit)(random));
  }
  /// Rounded to nearest, halves up, as the frames' integers are.
  static double rounded(double value) { return std::floor(value + 0.5); }
  static double atLeastOne(double value) { return std::max(rounded(value), 1.0); }  // an error is never 0
};

TEST(TouchFrames, AnglesAreRoundedToHundredthsOfADegree) {
  for (int i = 0; i < 10'000; ++i) {
    contact.angle = TurnQ32::fromRaw(static_cast<std::uint32_t>(random()));
    const double expected = std::fmod(rounded(toReal(contact.angle) * 36'000), 36'000);
    DOUBLES_EQUAL(expected, frames().contact.angle_cdeg, 0);
  }
}

TEST(TouchFrames, JustBelowAFullTurnIsZero) {
  contact.angle = TurnQ32::max();
  LONGS_EQUAL(0, frames().contact.angle_cdeg);
  contact.angle = fromReal<TurnQ32>(359.994 / 360);
  LONGS_EQUAL(35999, frames().contact.angle_cdeg);
}

TEST(TouchFrames, ForcesAreRoundedToMillinewtons) {
  for (int i = 0; i < 10'000; ++i) {
    contact.normal = anyLoad(1600 << 12);
    contact.tangential = anyLoad(1600 << 12);
    DOUBLES_EQUAL(rounded(toReal(contact.normal) * 20), frames().force.normal_mN, 0);
    DOUBLES_EQUAL(rounded(toReal(contact.tangential) * 20), frames().force.tangential_mN, 0);
  }
}

TEST(TouchFrames, ForcesSaturateShortOfNotKnown) {
  contact.normal = LineLoadQ12::max();
  contact.tangential = LineLoadQ12::min();
  LONGS_EQUAL(32767, frames().force.normal_mN);
  LONGS_EQUAL(-32767, frames().force.tangential_mN);
}

TEST(TouchFrames, SigmasOfForcesAreHalfMillinewtons) {
  for (int i = 0; i < 10'000; ++i) {
    contact.sigmaNormal = LineLoadQ12::fromRaw(static_cast<std::int32_t>(random() % (6 << 12)));
    contact.sigmaTangential = LineLoadQ12::fromRaw(static_cast<std::int32_t>(random() % (6 << 12)));
    DOUBLES_EQUAL(atLeastOne(toReal(contact.sigmaNormal) * 40), frames().force.sigma_normal_half_mN, 0);
    DOUBLES_EQUAL(atLeastOne(toReal(contact.sigmaTangential) * 40), frames().force.sigma_tangential_half_mN,
                  0);
  }
}

TEST(TouchFrames, SigmasSaturateShortOfNotKnown) {
  contact.sigmaNormal = contact.sigmaTangential = LineLoadQ12::max();
  contact.sigmaAngle = TurnQ32::fromRaw(0x8000'0000u);
  LONGS_EQUAL(254, frames().force.sigma_normal_half_mN);
  LONGS_EQUAL(254, frames().force.sigma_tangential_half_mN);
  LONGS_EQUAL(18'000, frames().contact.sigma_angle_cdeg);
}

TEST(TouchFrames, OnlyAmbiguousContactsHaveAnAlternative) {
  contact.alternative = fromReal<TurnQ32>(0.25);
  LONGS_EQUAL(kNotKnown<std::int8_t>, frames().contact.alternative_deg);
  contact.ambiguous = true;
  LONGS_EQUAL(90, frames().contact.alternative_deg);
}

TEST(TouchFrames, AlternativesAreRelativeTheShorterWayRoundAndSaturate) {
  contact.ambiguous = true;
  contact.angle = fromReal<TurnQ32>(0.99);
  for (int degrees = -179; degrees <= 179; ++degrees)
    for (const double beside : {-0.4, 0.0, 0.4}) {
      const double turns = 0.99 + (degrees + beside) / 360;
      contact.alternative = fromReal<TurnQ32>(turns - std::floor(turns));
      LONGS_EQUAL(std::clamp(degrees, -127, 127), frames().contact.alternative_deg);
    }
}

TEST(TouchFrames, AllFramesHaveTheSameFlagsAndSequence) {
  contact.quality = 83;
  second = contact;
  const TouchFrames all = frames();
  const auto labelled = [this](const auto& frame) { return frame.flags == flags && frame.sequence == 7; };
  CHECK_TRUE(labelled(all.contact) && labelled(all.force) && labelled(all.patch));
  CHECK_TRUE(labelled(all.second->contact) && labelled(all.second->force));
  LONGS_EQUAL(83, all.contact.quality_percent);
}

TEST(TouchFrames, AWidthThatIsNotFittedIsNotKnown) {
  LONGS_EQUAL(0xFFFF, frames().patch.width_um);
  LONGS_EQUAL(0xFFFF, frames().patch.sigma_width_um);
  LONGS_EQUAL(0xFF, frames().patch.chi_sixteenths);
  contact.chi_q4 = 17;  // a fit of a line: chi without a width
  LONGS_EQUAL(0xFFFF, frames().patch.width_um);
  LONGS_EQUAL(17, frames().patch.chi_sixteenths);
}

TEST(TouchFrames, AFittedWidthIsInMicrometres) {
  contact.width_um = 0;
  contact.sigmaWidth_um = 130;
  LONGS_EQUAL(0, frames().patch.width_um);
  LONGS_EQUAL(130, frames().patch.sigma_width_um);
  contact.width_um = 2040;
  contact.sigmaWidth_um = 0;
  LONGS_EQUAL(2040, frames().patch.width_um);
  LONGS_EQUAL(1, frames().patch.sigma_width_um);  // an error is never 0
}

TEST(TouchFrames, ThePatchSaturatesShortOfNotKnown) {
  for (const std::uint32_t beyond : {65'535u, 65'536u, 0xFFFF'FFFEu}) {
    contact.width_um = contact.sigmaWidth_um = beyond;
    LONGS_EQUAL(65'534, frames().patch.width_um);
    LONGS_EQUAL(65'534, frames().patch.sigma_width_um);
  }
  for (const int beyond : {255, 256, 65'534}) {
    contact.chi_q4 = static_cast<std::uint16_t>(beyond);
    LONGS_EQUAL(254, frames().patch.chi_sixteenths);
  }
}

TEST(TouchFrames, OneContactHasNoFramesOfASecond) {
  CHECK_FALSE(frames().second.has_value());
  LONGS_EQUAL(1, frames().patch.contacts);
}

TEST(TouchFrames, ASecondContactIsConvertedLikeTheFirst) {
  contact.angle = fromReal<TurnQ32>(0.25);
  second = Contact{};
  second->angle = fromReal<TurnQ32>(0.75);
  second->sigmaAngle = fromReal<TurnQ32>(0.001);
  second->normal = fromReal<LineLoadQ12>(30);
  second->tangential = fromReal<LineLoadQ12>(-4);
  second->quality = 71;
  const TouchFrames both = frames();
  contact = *second;
  second.reset();
  const TouchFrames alone = frames();
  LONGS_EQUAL(2, both.patch.contacts);
  LONGS_EQUAL(9000, both.contact.angle_cdeg);
  LONGS_EQUAL(27'000, both.second->contact.angle_cdeg);
  LONGS_EQUAL(600, both.second->force.normal_mN);
  LONGS_EQUAL(-80, both.second->force.tangential_mN);
  CHECK_TRUE(both.second->contact == alone.contact);
  CHECK_TRUE(both.second->force == alone.force);
}

TEST(TouchFrames, AReleaseIsNoForceInAPlaceThatIsNotKnown) {
  const FingerFlags simulated{FingerFlag::kSimulated};
  const TouchFrames released = releaseFrames(simulated, 9);
  CHECK_TRUE(released.contact == (ContactFrame{.flags = simulated, .sequence = 9}));
  CHECK_TRUE(released.force ==
             (ForceFrame{.normal_mN = 0, .tangential_mN = 0, .flags = simulated, .sequence = 9}));
  CHECK_TRUE(released.patch == (PatchFrame{.flags = simulated, .sequence = 9}));
  CHECK_FALSE(released.second.has_value());
}

TEST_GROUP(News) {
  TouchFrames last, frames;

  void setup() override {
    last.contact = {.angle_cdeg = 100, .sigma_angle_cdeg = 4, .quality_percent = 90};
    last.force = {
        .normal_mN = 500, .tangential_mN = -10, .sigma_normal_half_mN = 6, .sigma_tangential_half_mN = 8};
    last.patch = {.width_um = 2000, .sigma_width_um = 150, .contacts = 2};
    last.second = {{last.contact}, {last.force}};
    frames = last;
  }
  bool areNews() const { return isNews(frames, last, 1 << 8); }
};

TEST(News, NothingNewIsNone) { CHECK_FALSE(areNews()); }

TEST(News, AWidthIsNewsBeyondItsError) {
  frames.patch.width_um = 2150;
  CHECK_FALSE(areNews());
  frames.patch.width_um = 2151;
  CHECK_TRUE(areNews());
  frames.patch.width_um = 1849;
  CHECK_TRUE(areNews());
}

TEST(News, AWidthThatGetsKnownOrLostIsNews) {
  frames.patch.width_um = frames.patch.sigma_width_um = kNotKnown<std::uint16_t>;
  CHECK_TRUE(areNews());
  std::swap(frames, last);
  CHECK_TRUE(areNews());
  last = frames = TouchFrames{};
  CHECK_FALSE(areNews());
}

TEST(News, ASecondContactIsNewsWhenItComesAndGoes) {
  frames.second.reset();
  CHECK_TRUE(areNews());
  std::swap(frames, last);
  CHECK_TRUE(areNews());
}

TEST(News, ASecondContactIsNewsBeyondItsErrors) {
  frames.second->contact.angle_cdeg = 104;
  frames.second->force.normal_mN = 503;
  frames.second->force.tangential_mN = -14;
  frames.second->contact.quality_percent = 81;
  CHECK_FALSE(areNews());
  const TouchFrames within = frames;
  frames.second->contact.angle_cdeg = 105;
  CHECK_TRUE(areNews());
  frames = within;
  frames.second->force.normal_mN = 504;
  CHECK_TRUE(areNews());
  frames = within;
  frames.second->force.tangential_mN = -15;
  CHECK_TRUE(areNews());
  frames = within;
  frames.second->contact.quality_percent = 80;
  CHECK_TRUE(areNews());
}

TEST_GROUP(TouchReporter) {
  static constexpr std::uint32_t kPeriod_us = 2000;
  static constexpr std::uint32_t kFloor_us = 50'000;
  const ModelRing ring{ModelRing::asDrawn()};
  TouchReporter reporter{kPeriod_us, {FingerFlag::kSimulated}};
  std::uint32_t now_us = 10'000;
  Observation touch{.touched = true};
  const Observation nothing;
  Locator locator{FitMode::kRefined};
  Answer answer;

  void setup() override { press({{3.2, 20, 4, 1}}); }

  void press(std::initializer_list<Press> presses) {
    locateOnce(ring.tables(), ring.raw(ring.strains(presses)), ring.allGauges(), locator);
    answer = locator.answer();
  }
  std::optional<TouchFrames> frames(const Observation& observation) {
    return reporter.frames(ring.constants(), observation, answer, locator.linearisation(), now_us);
  }
  /// Sends what there is to say, if anything.
  std::optional<TouchFrames> say(const Observation& observation) {
    const auto result = frames(observation);
    if (result) reporter.sent(*result, now_us);
    return result;
  }
  /// The contact is so many of its own standard errors further round than it was found.
  void move(double sigmas) {
    answer.solution.contact = locator.answer().solution.contact;
    const Contact contact = estimate(ring.constants(), answer, unitErrors(locator.linearisation()), 0);
    answer.solution.contact[0].angle_q32 +=
        static_cast<std::uint32_t>(static_cast<std::int64_t>(sigmas * contact.sigmaAngle.raw()));
  }
  std::optional<TouchFrames> sayMoved(double sigmas) {
    move(sigmas);
    return say(touch);
  }
  /// Leaves so many times what the gate allows.
  void leave(double times) {
    const int allowed = threshold::kGatePerFreedom * freedoms(answer.solution.hypothesis) + threshold::kGate;
    answer.solution.residualEnergy =
        static_cast<Wide>(times * static_cast<double>(energyOf(answer.variances, allowed)));
  }
  void later(std::uint32_t by_us) { now_us += by_us; }
};

TEST(TouchReporter, SaysNothingUntouched) {
  for (int i = 0; i < 1000; ++i, later(1000)) CHECK_FALSE(frames(nothing).has_value());
}

TEST(TouchReporter, SaysATouchAtOnce) {
  const auto said = say(touch);
  CHECK_TRUE(said.has_value());
  CHECK(said->contact.flags == (FingerFlags{FingerFlag::kContact, FingerFlag::kSimulated}));
  DOUBLES_EQUAL(400, said->force.normal_mN, 1);
  DOUBLES_EQUAL(80, said->force.tangential_mN, 1);
  DOUBLES_EQUAL(7200, said->contact.angle_cdeg, 2);
  LONGS_EQUAL(0, said->contact.sequence);
}

TEST(TouchReporter, SaysTheErrorsOfEachTouchWhateverWasTouchedBefore) {
  for (const Press& other : {Press{3.7, 20, 4, 1}, Press{3.7, 20, 4, 3}, Press{11.1, 2, 0, 1}}) {
    say(touch);
    later(kFloor_us);
    press({other});
    const auto said = say(touch);
    later(kFloor_us);
    TouchReporter fresh(kPeriod_us, {FingerFlag::kSimulated});
    auto expected = fresh.frames(ring.constants(), touch, answer, locator.linearisation(), now_us);
    LONGS_EQUAL(expected->contact.sigma_angle_cdeg, said->contact.sigma_angle_cdeg);
    LONGS_EQUAL(expected->force.sigma_normal_half_mN, said->force.sigma_normal_half_mN);
    LONGS_EQUAL(expected->patch.sigma_width_um, said->patch.sigma_width_um);
  }
}

TEST(TouchReporter, SaysAnUnchangedTouchTwentyTimesASecond) {
  say(touch);
  int said = 0;
  for (int i = 0; i < 1000; ++i) {
    later(1000);
    if (say(touch)) ++said;
  }
  LONGS_EQUAL(20, said);
}

TEST(TouchReporter, SaysWhatCameBeforeItWasDueAlthoughNothingChangesAnyMore) {
  say(touch);
  later(1000);
  move(10);
  CHECK_FALSE(say(touch).has_value());
  const Observation unchanged{.touched = true, .unchanged = true};
  later(1000);
  const auto offered = frames(unchanged);
  CHECK_TRUE(offered.has_value());
  later(1000);
  CHECK_TRUE(say(unchanged).has_value());  // the port didn't take it
  later(2000);
  CHECK_FALSE(say(unchanged).has_value());
}

TEST(TouchReporter, SaysNothingBeforeTheFloorAndSomethingAtIt) {
  say(touch);
  later(kFloor_us - 1);
  CHECK_FALSE(say(touch).has_value());
  later(1);
  CHECK_TRUE(say(touch).has_value());
}

TEST(TouchReporter, SaysNothingThatNoiseMayHaveDone) {
  say(touch);
  later(kPeriod_us);
  CHECK_FALSE(sayMoved(0.7).has_value());
  CHECK_FALSE(sayMoved(-0.7).has_value());
}

TEST(TouchReporter, SaysWhatMovedByMoreThanItsError) {
  say(touch);
  later(kPeriod_us);
  CHECK_TRUE(sayMoved(2).has_value());
  later(kPeriod_us);
  CHECK_TRUE(sayMoved(-2).has_value());
}

TEST(TouchReporter, SaysForcesThatChanged) {
  say(touch);
  for (const Press& other : {Press{3.2, 21, 4, 1}, Press{3.2, 21, 5, 1}}) {
    later(kPeriod_us);
    press({other});
    CHECK_TRUE(say(touch).has_value());
  }
}

TEST(TouchReporter, SaysAWidthThatChanged) {
  say(touch);
  later(kPeriod_us);
  press({{3.2, 20, 4, 1.5}});
  CHECK_TRUE(say(touch).has_value());
}

TEST(TouchReporter, MovesAcrossZeroAreSmall) {
  press({{0.0002, 20, 0, 1}});
  const auto before = say(touch);
  later(kPeriod_us);
  press({{15.9998, 20, 0, 1}});
  CHECK(before->contact.angle_cdeg < 100);
  CHECK_FALSE(say(touch).has_value());
}

TEST(TouchReporter, SaysAChangeOfQualityOfTenPercent) {
  leave(1);
  say(touch);
  later(kPeriod_us);
  leave(1.09);  // 91 %
  CHECK_FALSE(say(touch).has_value());
  leave(1.12);  // 89 %
  CHECK_TRUE(say(touch).has_value());
}

TEST(TouchReporter, SaysAChangeOfFlags) {
  say(touch);
  later(kPeriod_us);
  answer.searching = true;
  const auto said = say(touch);
  CHECK_TRUE(said.has_value());
  CHECK_TRUE(said->contact.flags.has(FingerFlag::kUncertain));
}

TEST(TouchReporter, SaysBothContactsOfAPair) {
  press({{3.2, 20, 4, 1}, {9.7, 15, 0, 1}});
  const auto said = say(touch);
  CHECK_TRUE(said->second.has_value());
  LONGS_EQUAL(2, said->patch.contacts);
  const int first = said->contact.angle_cdeg, second = said->second->contact.angle_cdeg;
  DOUBLES_EQUAL(7200, std::min(first, second), 20);
  DOUBLES_EQUAL(21'825, std::max(first, second), 20);
}

TEST(TouchReporter, WhatTooFewGaugesReadIsUncertain) {
  touch.tooFewGauges = true;
  CHECK_TRUE(say(touch)->contact.flags.has(FingerFlag::kUncertain));
}

TEST(TouchReporter, AStaleZeroIsSaid) {
  touch.staleZero = true;
  CHECK_TRUE(say(touch)->contact.flags.has(FingerFlag::kStaleZero));
}

TEST(TouchReporter, KeepsToTheContactRate) {
  int said = 0;
  for (int i = 0; i < 1000; ++i, later(500)) {
    if (sayMoved(10.0 * i)) ++said;
  }
  LONGS_EQUAL(250, said);  // 500 Hz over half a second
}

TEST(TouchReporter, KeepsToTheContactRateWhenATouchComesAndGoes) {
  int said = 0;
  for (int i = 0; i < 1000; ++i, later(500))
    if (say(i % 2 == 0 ? touch : nothing)) ++said;
  CHECK(said <= 250);
}

TEST(TouchReporter, SaysOnceThatTheTouchEnded) {
  say(touch);
  later(kPeriod_us);
  const auto released = say(nothing);
  CHECK_TRUE(released.has_value());
  CHECK(released->contact.flags == FingerFlags{FingerFlag::kSimulated});
  LONGS_EQUAL(1, released->contact.sequence);
  for (int i = 0; i < 200; ++i, later(1000)) CHECK_FALSE(say(nothing).has_value());
}

TEST(TouchReporter, TheEndOfATouchHasNoOldValues) {
  say(touch);
  later(kPeriod_us);
  const auto released = say(nothing), expected = std::optional(releaseFrames({FingerFlag::kSimulated}, 1));
  CHECK_TRUE(released->contact == expected->contact);
  CHECK_TRUE(released->force == expected->force);
  CHECK_TRUE(released->patch == expected->patch);
}

TEST(TouchReporter, AReleaseThatIsNotSentIsOfferedAgain) {
  say(touch);
  later(kPeriod_us);
  CHECK_TRUE(frames(nothing).has_value());
  later(1000);
  CHECK_TRUE(say(nothing).has_value());
}

TEST(TouchReporter, ATouchThatIsNotSentIsReplacedByTheNext) {
  say(touch);
  later(kPeriod_us);
  move(10);
  const auto first = frames(touch);
  later(1000);
  move(20);
  const auto second = frames(touch);
  CHECK_TRUE(first.has_value() && second.has_value());
  CHECK(second->contact.angle_cdeg > first->contact.angle_cdeg);
  LONGS_EQUAL(first->contact.sequence, second->contact.sequence);
}

TEST(TouchReporter, SequenceNumbersGoUpByOneAndWrap) {
  for (int i = 0; i < 600; ++i, later(kFloor_us)) {
    const auto said = say(touch);
    LONGS_EQUAL(i % 256, said->contact.sequence);
    LONGS_EQUAL(i % 256, said->force.sequence);
  }
}

TEST(TouchReporter, ASaturatedGaugeIsSaidAndIsNoFault) {
  for (int gauge = 0; gauge < 16; ++gauge) {
    touch.saturated = touch.leftOut = 1u << gauge;
    TouchReporter fresh(kPeriod_us, {});
    const auto said = fresh.frames(ring.constants(), touch, answer, locator.linearisation(), now_us);
    CHECK_TRUE(said->contact.flags.has(FingerFlag::kSaturated));
    CHECK_FALSE(said->contact.flags.has(FingerFlag::kDegraded));
  }
}

TEST(TouchReporter, AnAnswerWithoutAGaugeIsDegraded) {
  touch.leftOut = 1u << 3;
  CHECK_TRUE(say(touch)->contact.flags.has(FingerFlag::kDegraded));
}

TEST(TouchReporter, AGaugeOutOfUseDegradesAndSaturatesNothing) {
  touch.saturated = touch.outOfUse = touch.leftOut = 1u << 3;
  const auto said = say(touch);
  CHECK_FALSE(said->contact.flags.has(FingerFlag::kSaturated));
  CHECK_TRUE(said->contact.flags.has(FingerFlag::kDegraded));
}

TEST(TouchReporter, StrainsThatAreNotOneContactsAreSaid) {
  touch.several = true;
  CHECK_TRUE(say(touch)->contact.flags.has(FingerFlag::kSeveralContacts));
}

TEST(TouchReporter, TheClocksWrapChangesNothing) {
  now_us = 0u - 25'000;
  say(touch);
  int said = 0;
  for (int i = 0; i < 100; ++i) {
    later(1000);
    if (say(touch)) ++said;
  }
  LONGS_EQUAL(2, said);  // every 50 ms
  now_us = 0u - 1000;
  sayMoved(10);
  later(kPeriod_us - 1);
  CHECK_FALSE(sayMoved(20).has_value());
  later(1);
  CHECK_TRUE(sayMoved(20).has_value());
}
