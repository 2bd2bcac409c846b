#include "host/health/examine.hpp"

#include <CppUTest/TestHarness.h>

#include <chrono>
#include <string>

#include "tests/host/live/views.hpp"

using namespace strainfinger;
using namespace strainfinger::health;
using live::FingerView;

TEST_GROUP(Examine) {
  const can::BusHints hints{.whenBlocked = "blocked", .whenSilent = "is it on the bus?"};

  static FingerView wellFinger() {
    FingerView finger = live::touchedFinger();
    finger.touch->flags = {FingerFlag::kContact, FingerFlag::kSimulated};
    finger.heartbeat.tx_error_steps = finger.heartbeat.rx_error_steps = 0;
    finger.heartbeat.table_crc = 0xA7;
    finger.info = InfoFrame{.reset_cause = ResetCause::kPowerOn, .version_minor = 1};
    finger.lost = 0;
    return finger;
  }
  static Findings of(const FingerView& finger, std::optional<std::uint32_t> crc32 = std::nullopt) {
    return examineFinger("can0", finger, crc32);
  }
  static CanLink goodLink() {
    return {.name = "can0",
            .isUp = true,
            .state = "ERROR-ACTIVE",
            .bitrate = 1'000'000,
            .samplePoint = 0.75,
            .restart_ms = 100,
            .txErrors = 0,
            .rxErrors = 0};
  }

  /// There is one finding: so bad, with this text and this remedy.
  static void checkOnly(Severity severity, const char* what, const char* remedy, const Findings& findings) {
    LONGS_EQUAL(1, findings.size());
    STRCMP_EQUAL(nameOf(severity), nameOf(findings.front().severity));
    STRCMP_CONTAINS(what, findings.front().what.c_str());
    STRCMP_CONTAINS(remedy, findings.front().remedy.c_str());
  }
  static void checkStatus(ExitCode status, const Findings& findings) {
    LONGS_EQUAL(static_cast<int>(status), static_cast<int>(findings.front().status));
  }
};

TEST(Examine, AGoodInterfaceIsDescribed) {
  checkOnly(Severity::kGood, "up, ERROR-ACTIVE, 1000000 bit/s, sample point 75.0 %", "",
            examineLink(goodLink(), 1'000'000));
  checkOnly(Severity::kGood, "virtual", "", examineLink({.name = "vcan0", .isUp = true}, 1'000'000));
}

TEST(Examine, AnotherBitRateThanTheConfigsIsAnErrorWithItsCommand) {
  checkOnly(Severity::kError, "1000000 bit/s; the config's can.bitrate is 500000",
            "sudo ip link set can0 down && sudo ip link set can0 up type can bitrate 500000 restart-ms 100",
            examineLink(goodLink(), 500'000));
}

TEST(Examine, AnInterfaceThatIsDownIsNoInterface) {
  CanLink link = goodLink();
  link.isUp = false;
  link.state = "STOPPED";
  checkOnly(Severity::kError, "down", "up type can bitrate 1000000", examineLink(link, 1'000'000));
  checkStatus(ExitCode::kNoInterface, examineLink(link, 1'000'000));
  checkOnly(Severity::kError, "down", "`sudo ip link set vcan0 up`",
            examineLink({.name = "vcan0"}, 1'000'000));
}

TEST(Examine, AControllerInTroubleIsTold) {
  CanLink link = goodLink();
  link.state = "ERROR-WARNING";
  link.txErrors = 101;
  checkOnly(Severity::kWarning, "sent 101, received 0", "120 ohm", examineLink(link, 1'000'000));
  link.state = "ERROR-PASSIVE";
  checkOnly(Severity::kError, "not acknowledged", "120 ohm", examineLink(link, 1'000'000));
  link.state = "BUS-OFF";
  checkOnly(Severity::kError, "bus-off", "it comes back by itself", examineLink(link, 1'000'000));
  link.restart_ms = 0;
  STRCMP_CONTAINS("sudo ip link set can0 type can restart",
                  examineLink(link, 1'000'000).front().remedy.c_str());
}

TEST(Examine, CountersThatAreNotKnownAreNotMadeUp) {
  CanLink link = goodLink();
  link.state = "ERROR-PASSIVE";
  link.txErrors.reset();
  CHECK_TRUE(examineLink(link, 1'000'000).front().what.find("counters") == std::string::npos);
}

TEST(Examine, WithoutAConfigAnyBitRateWillDo) {
  CanLink link = goodLink();
  link.bitrate = 500'000;
  checkOnly(Severity::kGood, "500000 bit/s", "", examineLink(link, std::nullopt));
}

TEST(Examine, AnAdapterThatDoesNotGoWithTheFingerIsAWarning) {
  CanLink link = goodLink();
  link.samplePoint = 0.5;
  checkOnly(Severity::kWarning, "sampled at 50.0 %", "sample-point 0.8", examineLink(link, 1'000'000));
  link.samplePoint = 0.875;
  checkOnly(Severity::kGood, "87.5 %", "", examineLink(link, 1'000'000));
  link.isListenOnly = true;
  checkOnly(Severity::kWarning, "acknowledges nothing", "listen-only off", examineLink(link, 1'000'000));
}

TEST(Examine, AnInterfaceThatGoesDownMeanwhileIsNotTheFingersFault) {
  const live::BusView bus = live::busWith({wellFinger()});
  for (const hal::CanState state : {hal::CanState::kDown, hal::CanState::kBusOff}) {
    const Findings findings = examineBus(bus, state, hints, std::chrono::milliseconds(2000));
    checkOnly(Severity::kError, "meanwhile", "blocked", findings);
    checkStatus(ExitCode::kNoInterface, findings);
  }
}

TEST(Examine, AControllerThatStaysOffTheBusIsAWarning) {
  CanLink link = goodLink();
  link.restart_ms = 0;
  checkOnly(Severity::kWarning, "restart-ms 0", "restart-ms 100", examineLink(link, 1'000'000));
}

TEST(Examine, ABusWithoutFingersHasNoNode) {
  using std::chrono::milliseconds;
  live::BusView bus = live::busWith({});
  checkOnly(Severity::kError, "no finger heard in 2.0 s, though others send", "is it on the bus?",
            examineBus(bus, hal::CanState::kActive, hints, milliseconds(2000)));
  bus.framesPerSecond = 0;
  checkOnly(Severity::kError, "no finger heard in 0.5 s, and nothing else", "is it on the bus?",
            examineBus(bus, hal::CanState::kActive, hints, milliseconds(500)));
  checkStatus(ExitCode::kNoNode, examineBus(bus, hal::CanState::kActive, hints, milliseconds(500)));
}

TEST(Examine, AFullBusAndASlowMachineAreWarnings) {
  using std::chrono::milliseconds;
  live::BusView bus = live::busWith({wellFinger()});
  checkOnly(Severity::kGood, "fingers: 1, frames a second: 1512, 16.8 % of the bit rate", "",
            examineBus(bus, hal::CanState::kActive, hints, milliseconds(2000)));
  bus.load = 0.82;
  checkOnly(Severity::kGood, "82.0 %", "",
            examineBus(bus, hal::CanState::kActive, hints, milliseconds(2000)));
  bus.load = 0.83;
  checkOnly(Severity::kWarning, "83 %", "--contact-rate-hz",
            examineBus(bus, hal::CanState::kActive, hints, milliseconds(2000)));
  bus.load = 0.1;
  bus.missed = 3;
  checkOnly(Severity::kWarning, "too slow for 3 frames", "",
            examineBus(bus, hal::CanState::kActive, hints, milliseconds(2000)));
}

TEST(Examine, AFingerThatIsWellIsDescribed) {
  checkOnly(Severity::kGood,
            "run, up 1:02:03, tables ..A7, firmware 0.1, 25 degC, touched (500 contacts a second)", "",
            of(wellFinger()));
  FingerView untouched = wellFinger();
  untouched.touch->flags = {};
  checkOnly(Severity::kGood, "untouched", "", of(untouched));
  STRCMP_EQUAL("can0 node 1", of(wellFinger()).front().where.c_str());
}

TEST(Examine, AnotherProtocolIsAllThatIsSaid) {
  FingerView finger = wellFinger();
  finger.heartbeat.protocol = 3;
  finger.hasTwin = true;
  checkOnly(Severity::kError, "speaks protocol 3", "", of(finger));
  checkStatus(ExitCode::kMismatch, of(finger));
}

TEST(Examine, TwoFingersOfOneNumberAreAnError) {
  FingerView finger = wellFinger();
  finger.hasTwin = true;
  finger.lost = 100;  // which means nothing then
  checkOnly(Severity::kError, "two fingers have this node number", "config --can can0 -n 1 --set-node",
            of(finger));
}

TEST(Examine, ASilentFingerIsNoNode) {
  FingerView finger = wellFinger();
  finger.silence_us = 900'000;
  checkOnly(Severity::kError, "silent for 0.9 s", "powered", of(finger));
  checkStatus(ExitCode::kNoNode, of(finger));
}

TEST(Examine, FaultsWithWhichNoTouchIsToldAreErrors) {
  for (const ValueName& fault : kFingerFaultNames) {
    FingerView finger = wellFinger();
    finger.heartbeat.faults = {FingerFault{fault.value}};
    const bool isEnding =
        std::string_view("tables gauges converter").find(fault.name) != std::string_view::npos;
    checkOnly(isEnding ? Severity::kError : Severity::kWarning, "fault ", "", of(finger));
    CHECK_FALSE(of(finger).front().remedy.empty());
  }
}

TEST(Examine, AFaultOfANewerFirmwareIsAWarning) {
  FingerView finger = wellFinger();
  finger.heartbeat.faults = FingerFaults::fromRaw(1U << 15);
  checkOnly(Severity::kWarning, "fault 15: unknown to this program", "", of(finger));
}

TEST(Examine, AStateThatNoFaultExplainsIsAWarning) {
  FingerView finger = wellFinger();
  finger.heartbeat.state = FingerState::kZeroing;
  checkOnly(Severity::kWarning, "state zeroing", "do not touch it", of(finger));
}

TEST(Examine, ErrorCountersOfTheFingersControllerAreIso11898s) {
  FingerView finger = wellFinger();
  finger.heartbeat.tx_error_steps = 5;
  checkOnly(Severity::kGood, "run", "", of(finger));
  finger.heartbeat.tx_error_steps = 6;
  checkOnly(Severity::kWarning, "many errors", "120 ohm", of(finger));
  finger.heartbeat.rx_error_steps = 8;
  checkOnly(Severity::kError, "error-passive", "120 ohm", of(finger));
  finger.heartbeat.tx_error_steps = finger.heartbeat.rx_error_steps = kErrorStepsNotKnown;
  checkOnly(Severity::kGood, "run", "", of(finger));
}

TEST(Examine, OtherTablesThanTheConfigsAreAMismatch) {
  checkOnly(Severity::kGood, "run", "", of(wellFinger(), 0x123456A7));
  checkOnly(Severity::kError, "ends with A7, not A8", "push --can can0 -n 1 -c",
            of(wellFinger(), 0x123456A8));
  checkStatus(ExitCode::kMismatch, of(wellFinger(), 0x123456A8));
}

TEST(Examine, TablesThatAreNoneAreNotComparedWithAny) {
  FingerView finger = wellFinger();
  finger.heartbeat.faults = {FingerFault::kTables};
  finger.heartbeat.table_crc = 0;
  checkOnly(Severity::kError, "fault tables", "push --can can0 -n 1 -c", of(finger, 0x123456A8));
}

TEST(Examine, WhatTheRunBeforeDiedOfIsAWarning) {
  FingerView finger = wellFinger();
  finger.info->crash = Crash::kHang;
  finger.info->restarts = 3;
  finger.info->crash_address = 0x2AB6;
  checkOnly(Severity::kWarning,
            "did not feed the watchdog in time, at 0x2AB6; crashes since power came on: 3", "addr2line",
            of(finger));
  finger.info->crash_address = 0;
  CHECK_TRUE(of(finger).front().what.find("at 0x") == std::string::npos);
  finger.info->crash = Crash::kNone;
  finger.info->reset_cause = ResetCause::kBrownOut;
  checkOnly(Severity::kWarning, "last reset brown out", "supply", of(finger));
}

TEST(Examine, GaugesLostFramesAndRestartsAreWarnings) {
  FingerView finger = wellFinger();
  finger.gauges->out_of_use = 0b10100000;
  checkOnly(Severity::kWarning, "gauges out of use: 5, 7", "tare", of(finger));
  finger = wellFinger();
  finger.lost = 2;
  checkOnly(Severity::kWarning, "2 of 3002 frames", "BUS_LOAD", of(finger));
  finger = wellFinger();
  finger.restarts = 1;
  checkOnly(Severity::kWarning, "it restarted, or two fingers have this node number",
            "doctor --can can0 --duration 10", of(finger));
}

TEST(Examine, ZerosThatDriftFastAreAWarning) {
  FingerView finger = wellFinger();
  finger.gauges = GaugesFrame{.zero_age_s = 3, .zero_rate_nano_per_s = 2000};
  checkOnly(Severity::kWarning, "its zeros drift by 2 microstrain a second", "warm", of(finger));
  for (const std::uint16_t calm : {std::uint16_t{999}, kNotKnown<std::uint16_t>}) {
    finger.gauges->zero_rate_nano_per_s = calm;
    CHECK_TRUE(of(finger).front().severity == Severity::kGood);
  }
}

TEST(Examine, AFingerThatSendsRawIsTold) {
  FingerView finger = wellFinger();
  finger.rawLoad = 0.0666;
  checkOnly(Severity::kWarning, "it sends its gauges' readings (RAW), 6.7 % of the bit rate",
            "`strainfinger strains --can can0 -n 1 --rows 1` ends that", of(finger));
}

TEST(Examine, FlagsOfATouchAreTold) {
  for (const ValueName& flag : kFingerFlagNames) {
    FingerView finger = wellFinger();
    finger.touch->flags = {FingerFlag{flag.value}};
    const bool isNotable =
        std::string_view("contact several_contacts simulated").find(flag.name) == std::string_view::npos;
    checkOnly(isNotable ? Severity::kWarning : Severity::kGood, isNotable ? flag.comment : "run", "",
              of(finger));
  }
}

TEST(Examine, WhoCannotAnswerIsNotAsked) {
  CHECK_TRUE(canAnswer(wellFinger()));
  FingerView finger = wellFinger();
  finger.heartbeat.state = FingerState::kFault;
  CHECK_FALSE(canAnswer(finger));
  finger = wellFinger();
  finger.heartbeat.protocol = 1;
  CHECK_FALSE(canAnswer(finger));
  finger = wellFinger();
  finger.hasTwin = true;
  CHECK_FALSE(canAnswer(finger));
  finger = wellFinger();
  finger.silence_us = 1'000'000;
  CHECK_FALSE(canAnswer(finger));
}

TEST(Examine, RemediesAreForTheFingerThatIsExamined) {
  FingerView finger = wellFinger();
  finger.node = 2;
  finger.gauges->out_of_use = 1;
  STRCMP_CONTAINS("`strainfinger tare --can can0 -n 2` gives", of(finger).front().remedy.c_str());
  const Counted lost[]{{Count::kLostSets, CountAnswer::kTold, 1}};
  STRCMP_CONTAINS("`strainfinger info --can can0 -n 2` counts",
                  examineCounts("can0", 2, lost, hints).front().remedy.c_str());
}

TEST(Examine, CountsThatDoHarmAreTold) {
  const auto of = [&](Count count, CountAnswer answer, std::uint32_t value = 0) {
    const Counted counts[]{{Count::kErases, CountAnswer::kTold, 3}, {count, answer, value}};
    return examineCounts("can0", 1, counts, hints);
  };
  STRCMP_EQUAL("can0 node 1", of(Count::kErases, CountAnswer::kTold).front().where.c_str());
  checkOnly(Severity::kGood, "answers requests", "", of(Count::kErases, CountAnswer::kTold, 35'999));
  checkOnly(Severity::kWarning, "36000 counted erases", "40,000",
            of(Count::kErases, CountAnswer::kTold, 36'000));
  checkOnly(Severity::kWarning, "1 counted corrected", "flash wears out",
            of(Count::kCorrected, CountAnswer::kTold, 1));
  checkOnly(Severity::kWarning, "6262 counted lost sets", "sample more slowly",
            of(Count::kLostSets, CountAnswer::kTold, 6262));
}

TEST(Examine, CountsThatAreNotToldSayWhy) {
  const auto of = [&](CountAnswer answer) {
    const Counted counts[]{{Count::kErases, CountAnswer::kTold, 3}, {Count::kCorrected, answer}};
    return examineCounts("can0", 1, counts, hints);
  };
  checkOnly(Severity::kGood, "answers requests", "", of(CountAnswer::kNotCounted));
  checkOnly(Severity::kWarning, "1 of its counts could not be told: another program asks it", "one at a time",
            of(CountAnswer::kOthersAsk));
  checkOnly(Severity::kError, "answers no request", "firmware", of(CountAnswer::kSilence));
  checkStatus(ExitCode::kNoNode, of(CountAnswer::kSilence));
  checkOnly(Severity::kError, "takes no request", "blocked", of(CountAnswer::kNotSent));
  checkStatus(ExitCode::kNoInterface, of(CountAnswer::kNotSent));
}
