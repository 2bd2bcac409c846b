// What a finger does when it is told to; FingerTest.cpp has what it does by itself.
#include <algorithm>
#include <initializer_list>
#include <random>

#include "firmware/app/finger.hpp"
#include "host/simulation/converter.hpp"
#include "tests/doubles/fake_can_port.hpp"
#include "tests/doubles/fake_clock.hpp"
#include "tests/doubles/fake_gauge_adc.hpp"
#include "tests/doubles/fake_non_volatile.hpp"
#include "tests/doubles/spy_watchdog.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;
using namespace strainfinger::doubles;

TEST_GROUP(FingerRequests) {
  static constexpr std::uint8_t kNode = 5;
  static constexpr Press kUntouched{0, 0, 0};
  static constexpr Press kTouch{3.2, 20, 4};
  const ModelRing ring{ModelRing::asDrawn()};
  const simulation::Converter converter{config::Gauges{}};
  FakeGaugeAdc adc;
  FakeCanPort can;
  FakeClock clock{1'000'000};
  SpyWatchdog watchdog;
  FakeNonVolatile store;
  Finger<FakeGaugeAdc, FakeCanPort, FakeClock, SpyWatchdog, FakeNonVolatile> finger{
      ring.tables(), {.node = kNode, .takesTables = true}, adc, can, clock, watchdog, store};

  void setup() override {
    run(ZeroAverage::kSamples);
    CHECK_TRUE(finger.state() == FingerState::kRun);
  }

  /// A sample set a millisecond.
  void run(int samples, const Press& press = kUntouched) {
    hal::SampleSet set{};
    const auto strains = ring.strains(press);
    std::transform(strains.begin(), strains.end(), set.begin(),
                   [&](double strain) { return converter.codeOf(strain); });
    for (int i = 0; i < samples; ++i) {
      clock.advance(1000);
      adc.convert(set);
      finger.step();
    }
  }
  /// A touch that is news with every set.
  void runMoving(int samples) {
    for (int i = 0; i < samples; ++i) run(1, {2 + i % 50 / 10.0, 20, 0});
  }
  void deliver(std::initializer_list<std::uint8_t> bytes, std::uint16_t id = 0x605) {
    CanFrame frame{.id = id, .length = static_cast<std::uint8_t>(bytes.size())};
    std::copy(bytes.begin(), bytes.end(), frame.data.begin());
    can.deliver(frame);
  }
  void step() {
    clock.advance(1);
    finger.step();
  }
  void ask(const RequestFrame& request) {
    can.deliver(encode(request, kNode));
    step();
  }

  std::vector<ResponseFrame> responses() {
    std::vector<ResponseFrame> found;
    for (const CanFrame& frame : can.sent)
      if (const auto response = readSingleFrame<ResponseFrame>(frame, kNode)) found.push_back(*response);
    can.sent.clear();
    return found;
  }
  void checkAnswer(Command command, CommandStatus status) {
    const auto found = responses();
    LONGS_EQUAL(1, found.size());
    CHECK_TRUE(found[0] == responseTo(command, status));
  }
  void checkAnswered(const RequestFrame& request, CommandStatus status) {
    responses();
    ask(request);
    checkAnswer(request.command, status);
  }
  template <typename Frame>
  std::vector<Frame> sent() {
    std::vector<Frame> frames;
    for (const CanFrame& frame : can.sent)
      if (const auto values = decode<Frame>(frame)) frames.push_back(*values);
    return frames;
  }
  std::size_t contactsOf(int samples) {
    can.sent.clear();
    runMoving(samples);
    return sent<ContactFrame>().size();
  }
};

TEST(FingerRequests, ATareIsAnsweredWhenItsSetsAreIn) {
  ask(tareRequest(false));
  CHECK_TRUE(finger.state() == FingerState::kZeroing);
  run(63);
  CHECK_TRUE(finger.state() == FingerState::kZeroing);
  LONGS_EQUAL(0, responses().size());
  run(1);
  CHECK_TRUE(finger.state() == FingerState::kRun);
  checkAnswer(Command::kTare, CommandStatus::kDone);
  run(1000);
  LONGS_EQUAL(0, responses().size());
}

TEST(FingerRequests, AForcedTareMakesTheTouchTheZero) {
  run(10, kTouch);
  ask(tareRequest(true));
  run(64, kTouch);
  checkAnswer(Command::kTare, CommandStatus::kDoneTouched);
  run(1, kTouch);
  LONGS_EQUAL(1, sent<ContactFrame>().size());  // the end of the touch
  CHECK_FALSE(sent<ContactFrame>()[0].flags.has(FingerFlag::kContact));
  run(200, kTouch);
  LONGS_EQUAL(1, sent<ContactFrame>().size());
  run(1);
  CHECK_TRUE(sent<ContactFrame>().back().flags.has(FingerFlag::kContact));
}

TEST(FingerRequests, ATareIsRefusedWhileTouched) {
  run(10, kTouch);
  checkAnswered(tareRequest(false), CommandStatus::kTouched);
  CHECK_TRUE(finger.state() == FingerState::kRun);
  const std::uint32_t fits = finger.counters().fits;
  run(100, kTouch);
  LONGS_EQUAL(fits + 100, finger.counters().fits);
}

TEST(FingerRequests, ATareDuringWhichATouchBeginsIsRefusedAndTheZeroStays) {
  for (const int before : {0, 10, 30, 50}) {
    run(1100);
    responses();
    ask(tareRequest(false));
    run(before);
    for (int set = before; set < 64; ++set) run(1, {3.2, 1.5 * (set - before), 0});
    checkAnswer(Command::kTare, CommandStatus::kTouched);
    run(100, kTouch);
    CHECK_TRUE(sent<ContactFrame>().back().flags.has(FingerFlag::kContact));
    run(100);
    CHECK_FALSE(sent<ContactFrame>().back().flags.has(FingerFlag::kContact));
  }
}

// What BUS_REQUESTS.md says of slow ones.
TEST(FingerRequests, ATareDuringWhichATouchGrowsByANewtonPerMetreIn32SetsIsRefused) {
  ask(tareRequest(false));
  for (int set = 0; set < 64; ++set) run(1, {3.2, set / 32.0, 0});
  checkAnswer(Command::kTare, CommandStatus::kTouched);
}

TEST(FingerRequests, AForcedTareUntouchedIsAnOrdinaryOne) {
  ask(tareRequest(true));
  run(64);
  checkAnswer(Command::kTare, CommandStatus::kDone);
}

TEST(FingerRequests, AForcedTareDuringWhichATouchBeginsIsDoneAndSaysSo) {
  run(1100);
  ask(tareRequest(true));
  run(30);
  run(34, kTouch);
  checkAnswer(Command::kTare, CommandStatus::kDoneTouched);
}

TEST(FingerRequests, ASecondTareWhileTheZeroIsTakenIsRefused) {
  ask(tareRequest(false));
  run(10);
  checkAnswered(tareRequest(false), CommandStatus::kBusy);
  run(54);
  checkAnswer(Command::kTare, CommandStatus::kDone);
}

TEST(FingerRequests, ATareWithoutSamplesIsRefused) {
  clock.advance(100'000);
  checkAnswered(tareRequest(false), CommandStatus::kBusy);
  CHECK_TRUE(finger.state() == FingerState::kRun);
}

TEST(FingerRequests, ATareWhoseSamplesComeLateIsDoneButNotAnswered) {
  ask(tareRequest(false));
  run(30);
  clock.advance(500'000);
  finger.step();
  run(34);
  CHECK_TRUE(finger.state() == FingerState::kRun);
  LONGS_EQUAL(0, responses().size());
}

TEST(FingerRequests, AnotherRequestGivesATareNoMoreTime) {
  ask(tareRequest(false));
  run(30);
  clock.advance(300'000);
  checkAnswered(contactRateRequest(100), CommandStatus::kDone);
  clock.advance(200'000);
  finger.step();
  run(34);
  CHECK_TRUE(finger.state() == FingerState::kRun);
  LONGS_EQUAL(0, responses().size());
}

TEST(FingerRequests, ATareWhoseSamplesComeLateIsRefusedAsWellWhereATouchBegan) {
  ask(tareRequest(false));
  run(30);
  clock.advance(500'000);
  finger.step();
  run(34, kTouch);
  CHECK_TRUE(finger.state() == FingerState::kRun);
  LONGS_EQUAL(0, responses().size());
  run(100, kTouch);
  CHECK_TRUE(sent<ContactFrame>().back().flags.has(FingerFlag::kContact));
  run(100);  // half of the touch would be the zero
  CHECK_FALSE(sent<ContactFrame>().back().flags.has(FingerFlag::kContact));
}

TEST(FingerRequests, AHeartbeatTellsOfTheZero) {
  ask(tareRequest(false));
  can.sent.clear();
  for (int i = 0; i < 50; ++i) {
    clock.advance(1000);
    run(1);
  }
  CHECK_TRUE(sent<HeartbeatFrame>().back().state == FingerState::kZeroing);
}

TEST(FingerRequests, TheContactRateHoldsFromTheNextContactOn) {
  LONGS_EQUAL(500, contactsOf(1000));
  checkAnswered(contactRateRequest(1000), CommandStatus::kDone);
  LONGS_EQUAL(1000, contactsOf(1000));
  checkAnswered(contactRateRequest(100), CommandStatus::kDone);
  LONGS_EQUAL(100, contactsOf(1000));
  checkAnswered(contactRateRequest(20), CommandStatus::kDone);
  LONGS_EQUAL(20, contactsOf(1000));
}

TEST(FingerRequests, WhatCannotBeDoneChangesNothing) {
  checkAnswered(contactRateRequest(19), CommandStatus::kBadArgument);
  checkAnswered(contactRateRequest(1001), CommandStatus::kBadArgument);
  checkAnswered({.length = 2, .command = Command::kContactRate, .argument = 100},
                CommandStatus::kBadArgument);
  checkAnswered({.length = 2, .command = Command::kTare, .argument = 2}, CommandStatus::kBadArgument);
  checkAnswered({.length = 1, .command = static_cast<Command>(127)}, CommandStatus::kUnknownCommand);
  CHECK_TRUE(finger.state() == FingerState::kRun);
  LONGS_EQUAL(500, contactsOf(1000));
}

TEST(FingerRequests, KeepsItsRateAndItsNextNode) {
  checkAnswered(contactRateRequest(100), CommandStatus::kDone);
  CHECK_FALSE(SettingsStore(store).found().settings.has_value());
  checkAnswered(keepRequest(), CommandStatus::kDone);
  CHECK_TRUE(*SettingsStore(store).found().settings == (StoredSettings{kNode, 100}));
  checkAnswered(contactRateRequest(1000), CommandStatus::kDone);  // not kept
  checkAnswered(nodeRequest(63), CommandStatus::kDone);           // still answered as node 5
  CHECK_TRUE(*SettingsStore(store).found().settings == (StoredSettings{63, 100}));
  checkAnswered(keepRequest(), CommandStatus::kDone);
  CHECK_TRUE(*SettingsStore(store).found().settings == (StoredSettings{63, 1000}));
}

TEST(FingerRequests, WhatCannotBeKeptIsSaidAndTheOldStays) {
  checkAnswered(nodeRequest(7), CommandStatus::kDone);
  store.cutPowerAfter(0);
  checkAnswered(nodeRequest(8), CommandStatus::kNotKept);
  store.restorePower();
  LONGS_EQUAL(7, SettingsStore(store).found().settings->node);
  checkAnswered(nodeRequest(0), CommandStatus::kBadArgument);
  checkAnswered(nodeRequest(64), CommandStatus::kBadArgument);
}

TEST(FingerRequests, AfterAFewChangesTheNextIsToldWhenToCome) {
  for (std::uint8_t node = 10; node < 14; ++node) checkAnswered(nodeRequest(node), CommandStatus::kDone);
  ask(nodeRequest(14));
  const auto found = responses();
  LONGS_EQUAL(1, found.size());
  CHECK_TRUE(found[0] == responseTo(Command::kNode, CommandStatus::kWait, 60));
  checkAnswered(nodeRequest(13), CommandStatus::kDone);  // it is kept already
  for (int second = 0; second < 61; ++second) {
    clock.advance(1'000'000);
    finger.step();
  }
  checkAnswered(nodeRequest(14), CommandStatus::kDone);
}

TEST(FingerRequests, NoMemoryIsErasedWhileTouchedUnlessThatIsMeant) {
  run(10, kTouch);
  checkAnswered(nodeRequest(7), CommandStatus::kTouched);
  checkAnswered(keepRequest(), CommandStatus::kTouched);
  LONGS_EQUAL(0, store.steps());
  checkAnswered(nodeRequest(7, true), CommandStatus::kDone);
  checkAnswered(nodeRequest(7), CommandStatus::kDone);  // nothing to erase
  checkAnswered(contactRateRequest(100), CommandStatus::kDone);
  checkAnswered(keepRequest(true), CommandStatus::kDone);
  CHECK_TRUE(*SettingsStore(store).found().settings == (StoredSettings{7, 100}));
}

TEST(FingerRequests, TheZeroIsTakenAtMostOnceASecond) {
  ask(tareRequest(false));
  run(64);
  checkAnswer(Command::kTare, CommandStatus::kDone);
  run(900);
  responses();
  ask(tareRequest(false));
  CHECK_TRUE(responses().at(0) == responseTo(Command::kTare, CommandStatus::kWait, 1));
  CHECK_TRUE(finger.state() == FingerState::kRun);
  run(100);
  responses();
  ask(tareRequest(false));
  CHECK_TRUE(finger.state() == FingerState::kZeroing);
}

TEST(FingerRequests, TellsItsCounts) {
  const auto countOf = [this](Count count) {
    responses();
    ask(countRequest(count));
    const auto found = responses();
    LONGS_EQUAL(1, found.size());
    CHECK_TRUE(found[0].command == Command::kCount && found[0].status == CommandStatus::kDone);
    return found[0].value;
  };
  LONGS_EQUAL(0, countOf(Count::kErases));
  checkAnswered(nodeRequest(7), CommandStatus::kDone);
  checkAnswered(nodeRequest(8), CommandStatus::kDone);
  LONGS_EQUAL(2, countOf(Count::kErases));
  store.found({.corrected = 3, .unreadable = 4});
  LONGS_EQUAL(3, countOf(Count::kCorrected));
  LONGS_EQUAL(4, countOf(Count::kUnreadable));
  LONGS_EQUAL(0, countOf(Count::kResynchronised));
  adc.convert({});
  adc.convert({});
  adc.resynchronise();
  LONGS_EQUAL(2, countOf(Count::kLostSets));
  LONGS_EQUAL(1, countOf(Count::kResynchronised));
}

// An hour of requests of every kind, 50 a second in no order.
TEST(FingerRequests, NoSequenceOfRequestsErasesMoreThanTheBudgetAllows) {
  std::mt19937 random(18);
  const auto any = [&random](int first, int last) {
    return std::uniform_int_distribution<>(first, last)(random);
  };
  const auto request = [&]() -> RequestFrame {
    switch (any(0, 4)) {
      case 0:
        return nodeRequest(static_cast<std::uint8_t>(any(1, 63)), any(0, 1) != 0);
      case 1:
        return keepRequest(any(0, 1) != 0);
      case 2:
        return contactRateRequest(static_cast<std::uint16_t>(any(20, 1000)));
      case 3:
        return tareRequest(true);
      default:
        return countRequest(Count::kErases);
    }
  };
  for (int i = 0; i < 60 * 60 * 50; ++i) {
    clock.advance(20'000);
    can.deliver(encode(request(), kNode));
    finger.step();
    can.sent.clear();
  }
  const int erases = store.erases(0) + store.erases(1);
  CHECK_TRUE(erases >= 60 && erases <= 4 + 60);
  LONGS_EQUAL(erases, SettingsStore(store).erases());
}

TEST(FingerRequests, OthersFramesAreNotItsBusiness) {
  can.sent.clear();
  for (const int id : {0x600, 0x604, 0x606, 0x585, 0x705, 0x205})
    deliver({1, 1}, static_cast<std::uint16_t>(id));
  deliver({0x10, 1});     // the first of a longer message
  deliver({2, 1});        // cut short
  deliver({2, 0x81, 0});  // a response
  for (int i = 0; i < 20; ++i) step();
  LONGS_EQUAL(0, can.sent.size());
  CHECK_FALSE(can.receive().has_value());
  CHECK_TRUE(finger.state() == FingerState::kRun);
}

TEST(FingerRequests, OneRequestATurnInOrder) {
  can.sent.clear();
  for (const int rate_hz : {10, 20, 30})
    can.deliver(encode(contactRateRequest(static_cast<std::uint16_t>(rate_hz)), kNode));
  step();
  LONGS_EQUAL(1, can.sent.size());
  step();
  step();
  const auto found = responses();
  LONGS_EQUAL(3, found.size());
  CHECK_TRUE(found[0].status == CommandStatus::kBadArgument);
  CHECK_TRUE(found[2].status == CommandStatus::kDone);
}

TEST(FingerRequests, ABusyPortGetsTheAnswerLaterAndTheNextRequestWaits) {
  can.busy = true;
  ask(contactRateRequest(100));
  can.deliver(encode(contactRateRequest(19), kNode));
  for (int i = 0; i < 5; ++i) step();
  can.busy = false;
  can.sent.clear();
  step();
  checkAnswer(Command::kContactRate, CommandStatus::kDone);
  step();
  checkAnswer(Command::kContactRate, CommandStatus::kBadArgument);
}

TEST(FingerRequests, AnOldAnswerIsNeverSent) {
  can.busy = true;
  ask(contactRateRequest(100));
  clock.advance(499'998);
  step();
  clock.advance(1);
  can.busy = false;
  finger.step();
  LONGS_EQUAL(0, responses().size());
  LONGS_EQUAL(100, contactsOf(1000));
}

TEST(FingerRequests, RawIsSentAtTheRateAskedForUntilItIsEnded) {
  const auto sets = [this] {
    int count = 0;
    for (const CanFrame& frame : can.sent)
      if (const auto page = decode<RawFrame>(frame))
        count += page->page == 0 && page->kind == RawKind::kReadings;
    return count;
  };
  run(10);
  LONGS_EQUAL(0, sets());
  ask(rawRequest(250));
  checkAnswer(Command::kRaw, CommandStatus::kDone);
  run(100);
  LONGS_EQUAL(25, sets());
  can.sent.clear();
  ask(rawRequest(0));
  checkAnswer(Command::kRaw, CommandStatus::kDone);
  run(100);
  LONGS_EQUAL(0, sets());
}

TEST(FingerRequests, RawTellsWhichSetsGoIntoTheZero) {
  ask(rawRequest(1000));
  ask(tareRequest(false));
  run(100);
  int zeroing = 0;
  for (const CanFrame& frame : can.sent)
    if (const auto page = decode<RawFrame>(frame))
      zeroing += page->page == 0 && page->kind == RawKind::kZeroing;
  LONGS_EQUAL(ZeroAverage::kSamples, zeroing);
}

TEST(FingerRequests, RawBeyondItsShareOfTheBusIsRefusedWithTheFastestRate) {
  Finger<FakeGaugeAdc, FakeCanPort, FakeClock, SpyWatchdog, FakeNonVolatile> slow{
      ring.tables(), {.node = kNode, .bitrate = 125'000}, adc, can, clock, watchdog, store};
  can.sent.clear();
  const auto askSlow = [&](std::uint16_t rate_hz) {
    can.deliver(encode(rawRequest(rate_hz), kNode));
    slow.step();
    return responses().at(0);
  };
  CHECK_TRUE(askSlow(1000) ==
             responseTo(Command::kRaw, CommandStatus::kTooFast, 125));  // 67 % / (6 * 111 bits)
  CHECK_TRUE(askSlow(126) == responseTo(Command::kRaw, CommandStatus::kTooFast, 125));
  CHECK_TRUE(askSlow(125) == responseTo(Command::kRaw, CommandStatus::kDone));
}

TEST(FingerRequests, ItLeavesForOtherTablesWhenItHasAnswered) {
  CHECK_TRUE(finger.leaving() == Leaving::kStays);
  can.busy = true;
  ask(loadRequest());
  CHECK_TRUE(finger.leaving() == Leaving::kStays);
  can.busy = false;
  step();
  checkAnswer(Command::kLoad, CommandStatus::kDone);
  CHECK_TRUE(finger.leaving() == Leaving::kLoads);
}

TEST(FingerRequests, ATouchedFingerDoesNotLeaveUnlessARestartIsMeant) {
  run(10, kTouch);
  checkAnswered(loadRequest(), CommandStatus::kTouched);
  checkAnswered(restartRequest(), CommandStatus::kTouched);
  CHECK_TRUE(finger.leaving() == Leaving::kStays);
  checkAnswered(restartRequest(true), CommandStatus::kDone);
  CHECK_TRUE(finger.leaving() == Leaving::kRestarts);
}

// One with wrong tables may feel a touch for ever.
TEST(FingerRequests, ATouchedFingerLoadsOtherTablesWhereThatIsMeant) {
  run(10, kTouch);
  checkAnswered(loadRequest(true), CommandStatus::kDone);
  CHECK_TRUE(finger.leaving() == Leaving::kLoads);
}

TEST(FingerRequests, WhileItsAnswerWaitsNoTouchBegins) {
  can.busy = true;
  ask(loadRequest());
  can.busy = false;
  responses();
  run(1, kTouch);
  LONGS_EQUAL(0, sent<ContactFrame>().size());
}

TEST(FingerRequests, WhoWaitsForATareIsAnsweredFirst) {
  run(1100);
  responses();
  ask(tareRequest(false));
  run(10);
  checkAnswered(loadRequest(), CommandStatus::kBusy);
  run(64);
  checkAnswer(Command::kTare, CommandStatus::kDone);
  checkAnswered(loadRequest(), CommandStatus::kDone);
}

TEST(FingerRequests, LoadingIsPaidFromTheBudgetOfErases) {
  checkAnswered(loadRequest(), CommandStatus::kDone);
  EraseBudget paid;
  paid.spend(finger.uptime_s());
  LONGS_EQUAL(paid.wait_s(0), finger.eraseBudget().wait_s(0));
  paid.spend(finger.uptime_s());
  paid.spend(finger.uptime_s());
  paid.spend(finger.uptime_s());
  LONGS_EQUAL(60, paid.wait_s(finger.uptime_s()));
}

// Listeners would take the touch for one that goes on.
TEST(FingerRequests, ItDoesNotLeaveWhileTheEndOfATouchIsNotOut) {
  run(10, kTouch);
  responses();
  can.room = 1;  // for CONTACT
  run(1);
  LONGS_EQUAL(1, sent<ContactFrame>().size());
  ask(loadRequest());
  can.room = SIZE_MAX;
  step();
  checkAnswer(Command::kLoad, CommandStatus::kBusy);
  checkAnswered(loadRequest(), CommandStatus::kDone);
}

TEST(FingerRequests, ItDoesNotLeaveBeforeTheEndOfATouchIsDue) {
  ask(contactRateRequest(kSlowestContactRate_hz));
  run(60, kTouch);
  run(1);
  CHECK_FALSE(finger.lastObservation().touched);
  checkAnswered(loadRequest(), CommandStatus::kBusy);
  checkAnswered(restartRequest(), CommandStatus::kBusy);
  run(50);
  CHECK_FALSE(sent<ContactFrame>().back().flags.has(FingerFlag::kContact));
  checkAnswered(loadRequest(), CommandStatus::kDone);
}

TEST(FingerRequests, ItLeavesWithATouchWhoseEndIsNotSaidWhereThatIsMeant) {
  ask(contactRateRequest(kSlowestContactRate_hz));
  run(60, kTouch);
  run(1);
  checkAnswered(loadRequest(true), CommandStatus::kDone);
  CHECK_TRUE(finger.leaving() == Leaving::kLoads);
}

TEST(FingerRequests, WordsAreForAFingerThatWasToldToLoad) {
  checkAnswered(wordRequest(0, 1), CommandStatus::kOutOfTurn);
}

TEST(FingerRequests, WithoutMemoryForTablesItStaysAndSaysSo) {
  Finger<FakeGaugeAdc, FakeCanPort, FakeClock, SpyWatchdog, FakeNonVolatile> without{
      ring.tables(), {.node = kNode}, adc, can, clock, watchdog, store};
  can.deliver(encode(loadRequest(), kNode));
  without.step();
  checkAnswer(Command::kLoad, CommandStatus::kNotKept);
  CHECK_TRUE(without.leaving() == Leaving::kStays);
}

// Else restarts, asked for or forced, would be a way round the budget of erases.
TEST(FingerRequests, AfterARestartNothingIsErasedForAMinuteUnlessItWasByHand) {
  using hal::ResetCause;
  for (const ResetCause cause : {ResetCause::kSoftware, ResetCause::kWatchdog, ResetCause::kUnknown})
    LONGS_EQUAL(60, EraseBudget::after(cause).wait_s(0));
  for (const ResetCause cause : {ResetCause::kPowerOn, ResetCause::kPin, ResetCause::kBrownOut})
    LONGS_EQUAL(0, EraseBudget::after(cause).wait_s(0));
  SpyWatchdog after(ResetCause::kSoftware);
  Finger<FakeGaugeAdc, FakeCanPort, FakeClock, SpyWatchdog, FakeNonVolatile> restarted{
      ring.tables(), {.node = kNode, .takesTables = true}, adc, can, clock, after, store};
  const auto answer = [&](const RequestFrame& request) {
    responses();
    can.deliver(encode(request, kNode));
    restarted.step();
    return responses().front();
  };
  CHECK_TRUE(answer(nodeRequest(8)) == responseTo(Command::kNode, CommandStatus::kWait, 60));
  CHECK_TRUE(answer(loadRequest()) == responseTo(Command::kLoad, CommandStatus::kWait, 60));
  for (int second = 0; second < 60; ++second) {
    clock.advance(1'000'000);
    restarted.step();
  }
  CHECK_TRUE(answer(nodeRequest(8)) == responseTo(Command::kNode, CommandStatus::kDone));
  CHECK_TRUE(answer(loadRequest()) == responseTo(Command::kLoad, CommandStatus::kWait, 60));
}
