#include "host/can/remedies.hpp"

#include <fmt/format.h>

namespace strainfinger::can {

std::string_view remedyFor(FingerFault fault) {
  switch (fault) {
    case FingerFault::kTables:
      return "make them with `strainfinger tables -o FILE -c` this finger's config, and flash them "
             "(firmware/bring_up.md)";
    case FingerFault::kGauges:
      return "`strainfinger info` names those out of use: check their wires and amplifiers, then "
             "`strainfinger tare` gives each another chance";
    case FingerFault::kConverter:
      return "check the converter's supply, reference and wiring, then switch the finger off and on";
    case FingerFault::kCan:
      return "check the bus: wiring, 120 ohm at both ends, one bit rate, its load";
    case FingerFault::kConfiguration:
      return "set it again: `strainfinger config --contact-rate-hz HZ --keep`, `strainfinger config "
             "--set-node "
             "NODE`";
    case FingerFault::kWatchdogReset:
      return "`strainfinger info` has what it died of and where; switching it off and on clears this";
    case FingerFault::kSamples:
      return "a few do no harm; `strainfinger info` counts them (lost_sets): where they go on, the board is "
             "too slow "
             "for its sampling rate";
    case FingerFault::kClock:
      return "check the board's crystal: with the other clock it may not be heard on the bus when it warms "
             "up";
    case FingerFault::kNoisy:
      return "keep mains and motor cables away, check shield and ground; where it stays so, tell it: "
             "gauges.noise_strain in the finger's config, and make its tables anew";
  }
  return "";
}

std::string_view remedyFor(FingerFlag flag) {
  switch (flag) {
    case FingerFlag::kContact:
    case FingerFlag::kSimulated:
      return "";
    case FingerFlag::kSaturated:
      return "press less, or have less gain before the converter and a larger gauges.full_scale_strain";
    case FingerFlag::kDegraded:
      return "`strainfinger info` names gauges that are out of use; one that an answer left out for the "
             "moment counts again when it fits";
    case FingerFlag::kUncertain:
      return "wait while a search goes on (mostly 0.2 s or less); where it stays, take the answer for "
             "one of two (alternative in CONTACT), or as no single contact (chi in PATCH)";
    case FingerFlag::kSeveralContacts:
      return "read CONTACT2 and FORCE2 as well; with one in PATCH's contacts the two are too near to be told "
             "apart";
    case FingerFlag::kStaleZero:
      return "let go of it; if nothing touches it, `strainfinger tare`";
    case FingerFlag::kUncalibrated:
      return "`strainfinger calibrate`, then flash the tables of what it writes";
  }
  return "";
}

std::string_view remedyFor(FingerState state) {
  switch (state) {
    case FingerState::kRun:
      return "";
    case FingerState::kBoot:
      return "wait a second";
    case FingerState::kZeroing:
      return "do not touch it for 64 sample sets";
    case FingerState::kFault:
      return "see its faults; it obeys no request until they are mended";
  }
  return "";
}

std::string_view remedyFor(ResetCause cause) {
  switch (cause) {
    case ResetCause::kUnknown:
    case ResetCause::kPowerOn:
    case ResetCause::kPin:
    case ResetCause::kSoftware:
      return "";
    case ResetCause::kWatchdog:
      return "see what it died of: crash, crash_address";
    case ResetCause::kBrownOut:
      return "measure the supply at the board, under load";
  }
  return "";
}

std::string_view remedyFor(Crash crash) {
  switch (crash) {
    case Crash::kNone:
      return "";
    case Crash::kHardFault:
    case Crash::kAssertion:
    case Crash::kStackOverflow:
    case Crash::kHang:
      return "`arm-none-eabi-addr2line -e` the firmware's .elf, with crash_address, says where: please "
             "report "
             "it";
    case Crash::kStarved:
      return "check the converter's supply, reference and wiring";
  }
  return "";
}

std::string_view remedyFor(Count count) {
  switch (count) {
    case Count::kErases:
      return "at 40,000 its memory is worn out: change settings less often";
    case Count::kCorrected:
    case Count::kUnreadable:
      return "its memory wears out: replace the board before it forgets its settings";
    case Count::kLostSets:
      return remedyFor(FingerFault::kSamples);
    case Count::kResynchronised:
      return remedyFor(FingerFault::kConverter);
  }
  return "";
}

std::string foreignText(std::uint8_t protocol) {
  return fmt::format("speaks protocol {}, this program {}: use the strainfinger of its firmware", protocol,
                     kProtocolVersion);
}

std::string remedyFor(CommandStatus status, std::string_view bus) {
  switch (status) {
    case CommandStatus::kDone:
    case CommandStatus::kDoneTouched:
      return "";
    case CommandStatus::kTouched:
      return "let go of it; if nothing touches it, its old zero is off: --force does it anyway";
    case CommandStatus::kBusy:
      return fmt::format("try again in a second; `strainfinger monitor --can {}` shows what it does", bus);
    case CommandStatus::kWait:
      return "try again then";
    case CommandStatus::kNotKept:
      return "it goes on as before; an emulated or simulated finger has no memory to keep it in";
    case CommandStatus::kTooFast:
      return "ask for less, or use a bus with a higher bit rate";
    case CommandStatus::kUnknownCommand:
    case CommandStatus::kBadArgument:
      break;
  }
  return "use the strainfinger of its firmware";
}

}  // namespace strainfinger::can
