#include <algorithm>
#include <memory>

#include "firmware/app/finger.hpp"

#include "host/simulation/converter.hpp"
#include "tests/doubles/fake_can_port.hpp"
#include "tests/doubles/fake_clock.hpp"
#include "tests/doubles/fake_gauge_adc.hpp"
#include "tests/doubles/spy_watchdog.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;
using namespace strainfinger::doubles;

namespace {

constexpr std::uint8_t kNode = 5;
constexpr std::uint32_t kSample_us = 1000;

}  // namespace

TEST_GROUP(Finger) {
  using Fingers = Finger<FakeGaugeAdc, FakeCanPort, FakeClock, SpyWatchdog>;
  const ModelRing ring{ModelRing::asDrawn()};
  const simulation::Converter converter{config::Gauges{}};
  FakeGaugeAdc adc;
  FakeCanPort can;
  FakeClock clock{1'000'000};
  SpyWatchdog watchdog;
  std::unique_ptr<Fingers> finger;

  void setup() override { start(); }
  void start(const FingerSettings& settings = {.node = kNode}) {
    finger = std::make_unique<Fingers>(ring.tables(), settings, adc, can, clock, watchdog);
  }

  hal::SampleSet codesOf(const Press& press) { return codesOfStrains(ring.strains(press)); }
  hal::SampleSet codesOfStrains(const std::vector<double>& strains) {
    hal::SampleSet set{};
    std::transform(strains.begin(), strains.end(), set.begin(),
                   [&](double strain) { return converter.codeOf(strain); });
    return set;
  }
  static constexpr Press kUntouched{0, 0, 0};
  static constexpr Press kTouch{3.2, 20, 4};

  /// A sample set a millisecond.
  void run(int samples, const Press& press = kUntouched) { runSets(samples, codesOf(press)); }
  void runSets(int samples, const hal::SampleSet& set) {
    for (int i = 0; i < samples; ++i) {
      clock.advance(kSample_us);
      adc.convert(set);
      finger->step();
    }
  }
  /// Turns of the loop without a sample set.
  void runSilent(int milliseconds) {
    for (int i = 0; i < milliseconds; ++i) {
      clock.advance(1000);
      finger->step();
    }
  }
  void runZeroed() {
    run(ZeroAverage::kSamples);
    can.sent.clear();
  }

  template <typename Frame>
  std::vector<Frame> sent() {
    std::vector<Frame> frames;
    for (const CanFrame& frame : can.sent)
      if (const auto values = decode<Frame>(frame)) frames.push_back(*values);
    return frames;
  }
  HeartbeatFrame lastHeartbeat() { return sent<HeartbeatFrame>().back(); }
};

TEST(Finger, SaysThatItBoots) {
  finger->step();
  LONGS_EQUAL(1, can.sent.size());
  LONGS_EQUAL(0x705, can.sent[0].id);
  CHECK(lastHeartbeat().state == FingerState::kBoot);
  LONGS_EQUAL(kProtocolVersion, lastHeartbeat().protocol);
  LONGS_EQUAL(ring.tables().crc32 & 0xFF, lastHeartbeat().table_crc);
}

TEST(Finger, TakesItsZeroFrom64Sets) {
  CHECK(finger->state() == FingerState::kBoot);
  run(1);
  CHECK(finger->state() == FingerState::kZeroing);
  run(62);
  CHECK(finger->state() == FingerState::kZeroing);
  run(1);
  CHECK(finger->state() == FingerState::kRun);
}

TEST(Finger, AZeroAwayFromMidScaleIsNoTouch) {
  run(64, kTouch);
  can.sent.clear();
  run(300, kTouch);
  LONGS_EQUAL(0, finger->counters().fits);
  LONGS_EQUAL(0, sent<ContactFrame>().size());
}

TEST(Finger, WhenSomethingIsSaidDependsOnTheSetsAndNotOnWhenTheyAreFetched) {
  const auto framesWith = [this](std::uint32_t lateness_us) {
    can.sent.clear();
    start({.node = kNode, .contactRate_hz = 400});
    runZeroed();
    for (int i = 0; i < 200; ++i) {
      const std::uint32_t late_us = i % 3 == 0 ? lateness_us : 0;
      clock.advance(kSample_us + late_us);
      adc.convert(codesOf({3.2 + 0.002 * i, 20, 4}));
      finger->step();
      clock.advance(0u - late_us);
    }
    return sent<ContactFrame>();
  };
  const auto punctual = framesWith(0);
  CHECK_TRUE(punctual.size() > 20);
  CHECK_TRUE(punctual == framesWith(700));
}

TEST(Finger, ASecondContactThatEndsIsSaidOnceMoreWithoutForce) {
  runZeroed();
  const hal::SampleSet both = codesOfStrains(ring.strains({{0.5, 25, 0}, {8.2, 20, 3}}));
  runSets(400, both);
  CHECK_FALSE(sent<Force2Frame>().empty());
  LONGS_EQUAL(2, sent<PatchFrame>().back().contacts);
  can.sent.clear();
  for (int i = 0; i < 400; ++i) run(1, {0.5 + 0.01 * (i % 2), 25, 0});
  const auto forces = sent<Force2Frame>();
  LONGS_EQUAL(1, std::ranges::count_if(forces, [](const Force2Frame& force) {
                return !force.flags.has(FingerFlag::kContact);
              }));
  LONGS_EQUAL(0, forces.back().normal_mN);
  LONGS_EQUAL(0, forces.back().tangential_mN);
  CHECK_FALSE(forces.back().flags.has(FingerFlag::kContact));
  CHECK_FALSE(sent<Contact2Frame>().back().flags.has(FingerFlag::kContact));
  LONGS_EQUAL(kNotKnown<std::uint16_t>, sent<Contact2Frame>().back().angle_cdeg);
  CHECK_TRUE(sent<ForceFrame>().back().flags.has(FingerFlag::kContact));
  runSets(400, both);
  can.sent.clear();
  run(200);
  LONGS_EQUAL(0, sent<ForceFrame>().back().normal_mN);
  CHECK_FALSE(sent<Force2Frame>().empty());
  LONGS_EQUAL(0, sent<Force2Frame>().back().normal_mN);
  LONGS_EQUAL(sent<ContactFrame>().back().sequence, sent<Force2Frame>().back().sequence);
}

TEST(Finger, AForceWhoseContactWasLostToBusOffIsDropped) {
  runZeroed();
  can.room = 1;  // the CONTACT alone
  run(1, kTouch);
  LONGS_EQUAL(1, sent<ContactFrame>().size());
  LONGS_EQUAL(0, sent<ForceFrame>().size());
  ++can.bus.busOffs;
  can.room = SIZE_MAX;
  finger->step();
  LONGS_EQUAL(0, sent<ForceFrame>().size());
  LONGS_EQUAL(1, finger->counters().touchesIncomplete);
}

TEST(Finger, TheEndOfATouchThatWasLostToBusOffIsSaidAgain) {
  runZeroed();
  run(100, kTouch);
  run(1);
  CHECK_FALSE(sent<ContactFrame>().back().flags.has(FingerFlag::kContact));
  run(100);
  can.sent.clear();
  ++can.bus.busOffs;
  run(300);
  LONGS_EQUAL(1, sent<ContactFrame>().size());
  CHECK_FALSE(sent<ContactFrame>().back().flags.has(FingerFlag::kContact));
  LONGS_EQUAL(1, sent<ForceFrame>().size());
}

// A crash, or a restart that was forced on a touched finger.
TEST(Finger, ATouchOfTheRunBeforeIsSaidToHaveEnded) {
  for (const auto cause :
       {hal::ResetCause::kSoftware, hal::ResetCause::kWatchdog, hal::ResetCause::kPowerOn}) {
    watchdog = SpyWatchdog(cause);
    start();
    runZeroed();
    run(300);
    const auto contacts = sent<ContactFrame>();
    LONGS_EQUAL(cause == hal::ResetCause::kPowerOn ? 0 : 1, contacts.size());
    LONGS_EQUAL(contacts.size(), sent<ForceFrame>().size());
    if (contacts.empty()) continue;
    CHECK_FALSE(contacts[0].flags.has(FingerFlag::kContact));
    LONGS_EQUAL(0, sent<ForceFrame>()[0].normal_mN);
    run(20, kTouch);
    LONGS_EQUAL(1, sent<ContactFrame>()[1].sequence);
  }
}

TEST(Finger, ABusOffBeforeAnyTouchIsNoEndOfOne) {
  runZeroed();
  ++can.bus.busOffs;
  run(300);
  LONGS_EQUAL(0, sent<ContactFrame>().size());
}

TEST(Finger, TheEndOfASecondContactIsSaidUntilThePortTakesIt) {
  runZeroed();
  runSets(400, codesOfStrains(ring.strains({{0.5, 25, 0}, {8.2, 20, 3}})));
  CHECK_FALSE(sent<Force2Frame>().empty());
  can.sent.clear();
  const Press one{0.5, 25, 0};
  for (int set = 0; set < 400; ++set) {
    if (set % 100 == 0) can.room = 1;  // for a CONTACT; what follows it gets too old
    run(1, {one.position_pitch + 0.01 * (set % 2), one.normal, one.tangential});
  }
  LONGS_EQUAL(0, sent<Contact2Frame>().size());
  can.room = SIZE_MAX;
  for (int set = 0; set < 200; ++set) run(1, {one.position_pitch + 0.01 * (set % 2), one.normal, 0});
  LONGS_EQUAL(1, sent<Contact2Frame>().size());
  CHECK_FALSE(sent<Contact2Frame>().back().flags.has(FingerFlag::kContact));
}

TEST(Finger, TheEndOfASecondContactThatWasLostToBusOffIsSaidAgain) {
  runZeroed();
  runSets(400, codesOfStrains(ring.strains({{0.5, 25, 0}, {8.2, 20, 3}})));
  for (int set = 0; set < 400; ++set) run(1, {0.5 + 0.01 * (set % 2), 25, 0});
  CHECK_FALSE(sent<Contact2Frame>().back().flags.has(FingerFlag::kContact));
  can.sent.clear();
  ++can.bus.busOffs;
  for (int set = 0; set < 300; ++set) run(1, {0.5 + 0.01 * (set % 2), 25, 0});
  LONGS_EQUAL(1, sent<Contact2Frame>().size());
  CHECK_FALSE(sent<Contact2Frame>().back().flags.has(FingerFlag::kContact));
}

TEST(Finger, ABusOffIsNoEndOfASecondContactThatThereNeverWas) {
  runZeroed();
  run(100, kTouch);
  ++can.bus.busOffs;
  run(300, kTouch);
  LONGS_EQUAL(0, sent<Contact2Frame>().size());
}

TEST(Finger, SendsNothingButHeartbeatsUntouched) {
  runZeroed();
  run(1000);
  LONGS_EQUAL(11, can.sent.size());
  LONGS_EQUAL(10, sent<HeartbeatFrame>().size());
  LONGS_EQUAL(1, sent<GaugesFrame>().size());
  LONGS_EQUAL(0, finger->counters().fits);
}

TEST(Finger, NamesAGaugeThatHasFailedWhenItKnowsAndThenOnceASecond) {
  runZeroed();
  hal::SampleSet set = codesOf(kTouch);
  set[3] = 0xFFF0;
  runSets(60, set);  // a search has to end first
  LONGS_EQUAL(1u << 3, sent<GaugesFrame>().at(0).out_of_use);
  CHECK(sent<ContactFrame>().back().flags.has(FingerFlag::kDegraded));
  runSets(2940, set);
  LONGS_EQUAL(3, sent<GaugesFrame>().size());
  CHECK_FALSE(lastHeartbeat().faults.has(FingerFault::kGauges));
}

TEST(Finger, TooFewGaugesAreAFault) {
  runZeroed();
  hal::SampleSet set = codesOf(kTouch);
  set[3] = set[7] = set[11] = 0;
  runSets(200, set);
  LONGS_EQUAL(1u << 3 | 1u << 7 | 1u << 11, sent<GaugesFrame>().back().out_of_use);
  CHECK(lastHeartbeat().faults.has(FingerFault::kGauges));
  CHECK(sent<ContactFrame>().back().flags.has(FingerFlag::kUncertain));
}

TEST(Finger, SaysHowOldItsZeroIs) {
  runZeroed();
  run(1000);
  LONGS_EQUAL(kNotKnown<std::uint16_t>, sent<GaugesFrame>().back().zero_rate_nano_per_s);
  run(3000);
  LONGS_EQUAL(0, sent<GaugesFrame>().back().zero_age_s);  // followed once an interval
  run(10'000, kTouch);
  DOUBLES_EQUAL(10, sent<GaugesFrame>().back().zero_age_s, 1);
}

TEST(Finger, SaysHowFastItsZeroMoves) {
  runZeroed();
  hal::SampleSet set = codesOf(kUntouched);
  set[2] = static_cast<std::uint16_t>(set[2] + 16);
  runSets(2000, set);
  // A code is more than the zero may move in an interval: the noise of a reading.
  constexpr double kInterval_s = ZeroTracker::kInterval * 1e-3;
  DOUBLES_EQUAL(ring.noise_strain() / kInterval_s * 1e9, sent<GaugesFrame>().back().zero_rate_nano_per_s, 15);
}

TEST(Finger, AGaugeThatIsAtItsRailThroughATareIsNeverSaidToWork) {
  hal::SampleSet set = codesOf(kUntouched);
  set[3] = 0xFFFF;
  runSets(ZeroAverage::kSamples + 1100, set);
  can.sent.clear();
  can.deliver(encode(tareRequest(false), kNode));
  runSets(ZeroAverage::kSamples + 1100, set);
  CHECK_TRUE(!sent<GaugesFrame>().empty());
  for (const GaugesFrame& frame : sent<GaugesFrame>()) LONGS_EQUAL(1 << 3, frame.out_of_use);
}

TEST(Finger, ANewZeroGivesGaugesAnotherTry) {
  runZeroed();
  hal::SampleSet set = codesOf(kTouch);
  set[3] = 0xFFF0;
  runSets(1500, set);
  CHECK(sent<GaugesFrame>().back().out_of_use != 0);
  can.deliver(encode(tareRequest(true), kNode));
  run(ZeroAverage::kSamples + 1100);
  LONGS_EQUAL(0, sent<GaugesFrame>().back().out_of_use);
}

TEST(Finger, BeatsTenTimesASecondInEveryState) {
  runSilent(1000);
  LONGS_EQUAL(10, sent<HeartbeatFrame>().size());  // the first one at once
  CHECK(lastHeartbeat().state == FingerState::kBoot);
  can.sent.clear();
  for (int i = 0; i < 40; ++i) {
    run(1);
    runSilent(24);
  }
  LONGS_EQUAL(10, sent<HeartbeatFrame>().size());
  CHECK(lastHeartbeat().state == FingerState::kZeroing);
  run(100);
  can.sent.clear();
  run(1000, kTouch);
  LONGS_EQUAL(10, sent<HeartbeatFrame>().size());
  CHECK(lastHeartbeat().state == FingerState::kRun);
}

TEST(Finger, ATouchIsAContactItsForceAndItsPatch) {
  runZeroed();
  run(1, kTouch);
  const auto contacts = sent<ContactFrame>();
  const auto forces = sent<ForceFrame>();
  LONGS_EQUAL(1, contacts.size());
  LONGS_EQUAL(1, forces.size());
  LONGS_EQUAL(0x185, can.sent[0].id);
  LONGS_EQUAL(0x285, can.sent[1].id);
  LONGS_EQUAL(0x385, can.sent[2].id);
  DOUBLES_EQUAL(72, contacts[0].angle_cdeg / 100.0, 0.3);  // the first step from a guess
  DOUBLES_EQUAL(400, forces[0].normal_mN, 12);
  DOUBLES_EQUAL(80, forces[0].tangential_mN, 12);
  LONGS_EQUAL(contacts[0].sequence, forces[0].sequence);
  LONGS_EQUAL(contacts[0].sequence, sent<PatchFrame>()[0].sequence);
  LONGS_EQUAL(1, sent<PatchFrame>()[0].contacts);
}

TEST(Finger, TheEndOfATouchIsSaidOnce) {
  runZeroed();
  run(10, kTouch);
  can.sent.clear();
  run(500);
  LONGS_EQUAL(1, sent<ContactFrame>().size());
  LONGS_EQUAL(1, sent<ForceFrame>().size());
  LONGS_EQUAL(1, sent<PatchFrame>().size());
  CHECK_FALSE(sent<ContactFrame>()[0].flags.has(FingerFlag::kContact));
  LONGS_EQUAL(kNotKnown<std::uint16_t>, sent<ContactFrame>()[0].angle_cdeg);
  LONGS_EQUAL(0, sent<ForceFrame>()[0].normal_mN);
  LONGS_EQUAL(0, sent<PatchFrame>()[0].contacts);
}

TEST(Finger, StandingFlagsAreInEveryFrame) {
  start({.node = kNode, .standingFlags = {FingerFlag::kSimulated, FingerFlag::kUncalibrated}});
  runZeroed();
  run(10, kTouch);
  run(10);
  for (const ContactFrame& contact : sent<ContactFrame>())
    CHECK(contact.flags.has(FingerFlag::kSimulated) && contact.flags.has(FingerFlag::kUncalibrated));
}

TEST(Finger, BothModesFindTheTouch) {
  for (const FitMode mode : {FitMode::kRefined, FitMode::kThreePoint}) {
    start({.node = kNode, .mode = mode});
    runZeroed();
    run(100, kTouch);
    DOUBLES_EQUAL(72, sent<ContactFrame>().back().angle_cdeg / 100.0, 0.1);
  }
}

TEST(Finger, ASilentConverterIsAFault) {
  runZeroed();
  runSilent(99);
  CHECK_FALSE(lastHeartbeat().faults.has(FingerFault::kConverter));
  runSilent(100);
  CHECK_TRUE(lastHeartbeat().faults.has(FingerFault::kConverter));
  run(101);
  CHECK_FALSE(lastHeartbeat().faults.has(FingerFault::kConverter));
}

TEST(Finger, AConverterThatNeverSpokeIsAFault) {
  runSilent(201);
  CHECK_TRUE(lastHeartbeat().faults.has(FingerFault::kConverter));
}

TEST(Finger, ASilentConverterStaysAFaultWhenTheClockWraps) {
  runZeroed();
  for (int i = 0; i < 90 * 60 * 10; ++i) {  // an hour and a half
    clock.advance(100'000);
    finger->step();
    if (i > 1) CHECK_TRUE(lastHeartbeat().faults.has(FingerFault::kConverter));
    can.sent.clear();
  }
}

TEST(Finger, OnlySampleSetsFeedTheWatchdog) {
  runSilent(500);
  LONGS_EQUAL(0, watchdog.feeds());
  run(100);
  LONGS_EQUAL(100, watchdog.feeds());
  run(50, kTouch);
  runSilent(500);
  LONGS_EQUAL(150, watchdog.feeds());
}

TEST(Finger, ABusThatTakesNothingDoesNotStarveTheWatchdog) {
  can.busy = true;
  run(100);
  run(100, kTouch);
  LONGS_EQUAL(200, watchdog.feeds());
}

TEST(Finger, SaysThatTheWatchdogResetIt) {
  watchdog = SpyWatchdog(hal::ResetCause::kWatchdog);
  start();
  finger->step();
  CHECK(lastHeartbeat().faults == FingerFaults{FingerFault::kWatchdogReset});
}

TEST(Finger, SaysThatFramesToItWereLost) {
  can.bus.missed = 1;
  runSilent(1);
  CHECK(lastHeartbeat().faults == FingerFaults{FingerFault::kCan});
}

TEST(Finger, SaysThatSampleSetsWereLost) {
  run(1);
  for (int i = 0; i < 3; ++i) adc.convert({});
  runSilent(100);
  CHECK(lastHeartbeat().faults == FingerFaults{FingerFault::kSamples});
}

TEST(Finger, PassesOnWhatThePortKnows) {
  finger->step();
  LONGS_EQUAL(kErrorStepsNotKnown, lastHeartbeat().tx_error_steps);
  LONGS_EQUAL(kErrorStepsNotKnown, lastHeartbeat().rx_error_steps);
  can.bus.txErrors = 96;
  can.bus.rxErrors = 33;
  can.bus.dropped = 1;
  runSilent(100);
  LONGS_EQUAL(96 / 16, lastHeartbeat().tx_error_steps);
  LONGS_EQUAL(2, lastHeartbeat().rx_error_steps);
  CHECK_TRUE(lastHeartbeat().faults.has(FingerFault::kCan));
}

TEST(Finger, CountsWhatItDid) {
  run(64);
  run(10);
  run(100, kTouch);
  LONGS_EQUAL(174, finger->counters().sampleSets);
  LONGS_EQUAL(100, finger->counters().fits);
  LONGS_EQUAL(sent<ForceFrame>().size(), finger->counters().touchesSent);
  LONGS_EQUAL(0, finger->counters().touchesBusy);
  LONGS_EQUAL(0, finger->counters().touchesIncomplete);
}

TEST(Finger, ABusyPortGetsTheNewestTouch) {
  runZeroed();
  can.busy = true;
  for (int i = 0; i < 50; ++i) run(1, {3 + i / 50.0, 20, 0});
  LONGS_EQUAL(50, finger->counters().touchesBusy);
  can.busy = false;
  run(1, {4, 20, 0});
  LONGS_EQUAL(1, sent<ContactFrame>().size());
  DOUBLES_EQUAL(90, sent<ContactFrame>()[0].angle_cdeg / 100.0, 0.1);
  LONGS_EQUAL(0, sent<ContactFrame>()[0].sequence);
}

TEST(Finger, AHeartbeatThatIsRefusedIsTriedAgain) {
  can.busy = true;
  runSilent(250);
  can.busy = false;
  runSilent(1);
  LONGS_EQUAL(1, sent<HeartbeatFrame>().size());
  runSilent(99);
  LONGS_EQUAL(1, sent<HeartbeatFrame>().size());
  runSilent(1);
  LONGS_EQUAL(2, sent<HeartbeatFrame>().size());
}

TEST(Finger, CountsItsUptimeAcrossTheClocksWrap) {
  clock.advance(0u - clock.now_us() - 1'500'000);
  start();
  runSilent(3100);
  LONGS_EQUAL(3, lastHeartbeat().uptime_s);
}

TEST(Finger, UptimeStopsShortOfNotKnown) {
  for (int i = 0; i < 70'000; ++i) {
    clock.advance(1'000'000);
    can.sent.clear();
    finger->step();
    LONGS_EQUAL(std::min(i + 1, 65'534), lastHeartbeat().uptime_s);
  }
}
