#include "host/can/remedies.hpp"

#include <fmt/format.h>

#include "host/base/text_parts.hpp"

namespace strainfinger::can {

std::string_view remedyFor(FingerFault fault) {
  switch (fault) {
    case FingerFault::kTables:
      return "`strainfinger push --can BUS -n N -c FINGER.toml`, with this finger's config, sends it its "
             "tables; the board refuses tables for more gauges (gauges.count) than it reads";
    case FingerFault::kGauges:
      return "`strainfinger info --can BUS -n N` names those out of use: check their wires and amplifiers, "
             "then `strainfinger tare --can BUS -n N` gives each another chance";
    case FingerFault::kConverter:
      return "check the converter's supply, reference and wiring, then switch the finger off and on";
    case FingerFault::kCan:
      return "check the bus: wiring, 120 ohm at both ends, one bit rate, its load, and that another node "
             "was there to acknowledge; the fault goes at the next start";
    case FingerFault::kConfiguration:
      return "set it again: `strainfinger config --can BUS -n N --contact-rate-hz HZ --keep`, `strainfinger "
             "config --can BUS -n N --set-node NODE`; the fault goes at the next start";
    case FingerFault::kWatchdogReset:
      return "`strainfinger info --can BUS -n N` has what it died of; switching it off and on clears this";
    case FingerFault::kSamples:
      return "a few do no harm, as while settings are kept; `strainfinger info --can BUS -n N` counts them "
             "(lost_sets): where they go on, sample more slowly (firmware/board/stm32g431/options.md) or, if "
             "the finger is simulated, do less on this machine (`chrt -f 50 strainfinger run ..`); the fault "
             "goes at the next start";
    case FingerFault::kClock:
      return "check the board's crystal: with the other clock it may not be heard on the bus when it warms "
             "up";
    case FingerFault::kNoisy:
      return "keep mains and motor cables away, check shield and ground, and the wires of gauges out of use; "
             "if the noise stays, enter it as gauges.noise_strain in the finger's config and send its tables "
             "again: `strainfinger push --can BUS -n N -c FINGER.toml`";
  }
  return "";
}

std::string_view remedyFor(FingerFlag flag) {
  switch (flag) {
    case FingerFlag::kContact:
    case FingerFlag::kSimulated:
      return "";
    case FingerFlag::kSaturated:
      return "press less; or have less gain before the converter, a larger gauges.full_scale_strain, and "
             "`strainfinger push --can BUS -n N -c` the config that says so";
    case FingerFlag::kDegraded:
      return "`strainfinger info --can BUS -n N` names gauges that are out of use; one that an answer left "
             "out for the moment counts again when it fits";
    case FingerFlag::kUncertain:
      return "wait while a search goes on (mostly 0.2 s or less), or press more firmly: very light touches "
             "stay uncertain. Alternative in CONTACT may name another angle; chi in PATCH well above 1 "
             "says that no contact explains the readings; with the fault gauges every touch is uncertain";
    case FingerFlag::kSeveralContacts:
      return "read CONTACT2 and FORCE2 as well; with one in PATCH's contacts the two are too near to be "
             "told apart";
    case FingerFlag::kStaleZero:
      return "let go of it; if nothing touches it, `strainfinger tare --can BUS -n N --force`";
    case FingerFlag::kUncalibrated:
      return "`strainfinger calibrate`, then `strainfinger push --can BUS -n N -c` the config that it writes";
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
      return "see its faults; until they are mended it only takes tables and restarts";
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
      return "see what it died of: crash";
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
      return "please report it; where crash_address is not 0, `arm-none-eabi-addr2line -e` the firmware's "
             ".elf has the line of it, given in hexadecimal as `doctor` shows it (on an STM32 add "
             "0x08000000)";
    case Crash::kStarved:
      return "check the converter's supply, reference and wiring";
  }
  return "";
}

std::string_view remedyFor(Count count) {
  switch (count) {
    case Count::kErases:
      static_assert(kWornOut_erases == 40'000);
      return "at 40,000 its memory, of four pages, is worn out: change settings less often";
    case Count::kCorrected:
      return "one or two do no harm; where they go on, the board's flash wears out";
    case Count::kUnreadable:
      return "a power cut may have ended a change of settings or tables: make it again; if it comes back, "
             "the board's flash is worn out";
    case Count::kLostSets:
      return remedyFor(FingerFault::kSamples);
    case Count::kResynchronised:
      return "a few do no harm; where they go on, sample more slowly "
             "(firmware/board/stm32g431/options.md)";
  }
  return "";
}

std::string_view remedyFor(CommandStatus status) {
  switch (status) {
    case CommandStatus::kDone:
    case CommandStatus::kDoneTouched:
      return "";
    case CommandStatus::kTouched:
      return "let go of the finger and repeat; if nothing touches it, its old zero is off: "
             "`strainfinger tare --can BUS -n N --force` takes a new one, and other commands have --force, "
             "too";
    case CommandStatus::kBusy:
      return "try again in a second; `strainfinger monitor --can BUS` shows what it does; in state fault it "
             "needs tables first: `strainfinger push --can BUS -n N -c FINGER.toml`";
    case CommandStatus::kWait:
      return "try again in as many seconds as value says";
    case CommandStatus::kNotKept:
      return "a simulated finger (`run`) keeps only tables, and only until it ends; an emulated board keeps "
             "nothing; on a real board the memory is worn out: replace the board";
    case CommandStatus::kTooFast:
      return "ask for less, or use a bus with a higher bit rate";
    case CommandStatus::kOutOfTurn:
      return "it has started anew meanwhile, or another program sends it tables, too; `strainfinger push "
             "--can BUS -n N -c FINGER.toml` begins with their first word";
    case CommandStatus::kUnknownCommand:
    case CommandStatus::kBadArgument:
      break;
  }
  return "use the strainfinger of its firmware";
}

std::string foreignText(std::uint8_t protocol) {
  return fmt::format("speaks protocol {}, this program {}: use the strainfinger of its firmware", protocol,
                     kProtocolVersion);
}

std::string onBus(std::string_view remedy, std::string_view bus) {
  return replacedAll(std::string(remedy), "--can BUS", fmt::format("--can {}", bus));
}

std::string forNode(std::string_view remedy, std::string_view bus, std::uint8_t node) {
  return replacedAll(onBus(remedy, bus), "-n N", fmt::format("-n {}", node));
}

}  // namespace strainfinger::can
