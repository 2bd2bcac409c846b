#pragma once
// The frames a finger sends: their raw values and, below each, the table that says where these lie and what
// they mean. BUS*.md show the bytes. A member that is not set is "not known", never an old value.

#include <array>
#include <cstdint>
#include <tuple>

#include "common/bit_set.hpp"
#include "common/frame_layout.hpp"

namespace strainfinger {

/// Goes up when a frame changes its meaning; receivers of another version must not read the frames.
inline constexpr std::uint8_t kProtocolVersion = 2;

/// In contact CONTACT, FORCE and PATCH are sent this often at least; HEARTBEAT, INFO and GAUGES always.
inline constexpr std::uint16_t kContactPeriod_ms = 50;
inline constexpr std::uint16_t kHeartbeatPeriod_ms = 100;
inline constexpr std::uint16_t kInfoPeriod_ms = 1000;
inline constexpr std::uint16_t kGaugesPeriod_ms = 1000;

/// What a reader must know before using the numbers of a touch. Bit numbers; never reuse one.
enum class FingerFlag : std::uint8_t {
  kContact = 0,
  kSaturated = 1,
  kDegraded = 2,
  kUncertain = 3,
  kSeveralContacts = 4,
  kStaleZero = 5,
  kUncalibrated = 6,
  kSimulated = 7,
};
using FingerFlags = BitSet<FingerFlag>;

inline constexpr std::array kFingerFlagNames{
    named(FingerFlag::kContact, "contact", "Something touches the finger"),
    named(FingerFlag::kSaturated, "saturated", "A gauge is at the end of its range; its reading is not used"),
    named(FingerFlag::kDegraded, "degraded",
          "A gauge is out of use or left out, the sigmas are larger for it"),
    named(FingerFlag::kUncertain, "uncertain",
          "The answer may be wrong; where another contact fits nearly as well, see alternative"),
    named(FingerFlag::kSeveralContacts, "several_contacts",
          "More than one contact: see contacts in PATCH for how many are located"),
    named(FingerFlag::kStaleZero, "stale_zero", "The zero of the gauges is too old to be trusted"),
    named(FingerFlag::kUncalibrated, "uncalibrated",
          "No calibration: forces are those of the nominal finger"),
    named(FingerFlag::kSimulated, "simulated", "From simulated gauges, not from a finger"),
};

enum class FingerState : std::uint8_t { kBoot = 0, kZeroing = 1, kRun = 2, kFault = 3 };

inline constexpr std::array kFingerStateNames{
    named(FingerState::kBoot, "boot", "Starting up"),
    named(FingerState::kZeroing, "zeroing", "Taking the zero of the gauges: do not touch"),
    named(FingerState::kRun, "run", "Measuring"),
    named(FingerState::kFault, "fault", "Not measuring: see the faults"),
};

/// What is wrong with the finger itself. Bit numbers; never reuse one.
enum class FingerFault : std::uint8_t {
  kTables = 0,
  kGauges = 1,
  kConverter = 2,
  kCan = 3,
  kConfiguration = 4,
  kWatchdogReset = 5,
  kSamples = 6,
  kClock = 7,
  kNoisy = 8,
};
using FingerFaults = BitSet<FingerFault, std::uint16_t>;

inline constexpr std::array kFingerFaultNames{
    named(FingerFault::kTables, "tables", "The lookup tables are absent, damaged or of another finger"),
    named(FingerFault::kGauges, "gauges", "Too few gauges work"),
    named(FingerFault::kConverter, "converter", "The converter gives no new samples"),
    named(FingerFault::kCan, "can", "Frames were lost on their way to the bus, or from it"),
    named(FingerFault::kConfiguration, "configuration",
          "A change of the stored settings was lost, or all stored settings"),
    named(FingerFault::kWatchdogReset, "watchdog_reset", "The last reset was the watchdog's"),
    named(FingerFault::kSamples, "samples",
          "Sample sets were lost since the start: they came while the finger was busy"),
    named(FingerFault::kClock, "clock",
          "The board runs on its inaccurate internal clock, not the crystal: the bit rate may be off"),
    named(
        FingerFault::kNoisy, "noisy",
        "Untouched gauges are noisier than gauges.noise_strain: weak touches are missed, and a gauge that is "
        "noisy by itself is out of use"),
};

/// Why the finger started. Never reuse a number.
enum class ResetCause : std::uint8_t {
  kUnknown = 0,
  kPowerOn = 1,
  kPin = 2,
  kSoftware = 3,
  kWatchdog = 4,
  kBrownOut = 5
};

inline constexpr std::array kResetCauseNames{
    named(ResetCause::kUnknown, "unknown", "The board cannot tell"),
    named(ResetCause::kPowerOn, "power_on", "Power came on"),
    named(ResetCause::kPin, "pin", "The reset pin"),
    named(ResetCause::kSoftware, "software", "The firmware itself, after a crash or on request"),
    named(ResetCause::kWatchdog, "watchdog", "The firmware hung, or no samples went through it"),
    named(ResetCause::kBrownOut, "brown_out", "The supply voltage was too low"),
};

/// What the firmware died of. Never reuse a number.
enum class Crash : std::uint8_t {
  kNone = 0,
  kHardFault = 1,
  kAssertion = 2,
  kStackOverflow = 3,
  kHang = 4,
  kStarved = 5,
};

inline constexpr std::array kCrashNames{
    named(Crash::kNone, "none", "The last run did not crash"),
    named(Crash::kHardFault, "hard_fault", "The processor could not go on"),
    named(Crash::kAssertion, "assertion", "The firmware found itself in an impossible state"),
    named(Crash::kStackOverflow, "stack_overflow", "The firmware ran out of stack"),
    named(Crash::kHang, "hang", "The firmware hung: it did not feed the watchdog in time"),
    named(Crash::kStarved, "starved", "The converter gave no samples for too long"),
};

/// What a page of RAW is of. Never reuse a number.
enum class RawKind : std::uint8_t { kReadings = 0, kZeroing = 1, kZeros = 2 };

inline constexpr std::array kRawKindNames{
    named(RawKind::kReadings, "readings", "A sample set"),
    named(RawKind::kZeroing, "zeroing", "A sample set that goes into the zero"),
    named(RawKind::kZeros, "zeros", "What the gauges read untouched, as far as the finger knows"),
};

/// Where the finger is touched.
struct ContactFrame {
  std::uint16_t angle_cdeg = kNotKnown<std::uint16_t>;
  std::uint16_t sigma_angle_cdeg = kNotKnown<std::uint16_t>;
  std::int8_t alternative_deg = kNotKnown<std::int8_t>;
  FingerFlags flags{};
  std::uint8_t quality_percent = kNotKnown<std::uint8_t>;
  std::uint8_t sequence = 0;
  bool operator==(const ContactFrame&) const = default;
};

/// How hard it is touched.
struct ForceFrame {
  std::int16_t normal_mN = kNotKnown<std::int16_t>;
  std::int16_t tangential_mN = kNotKnown<std::int16_t>;
  std::uint8_t sigma_normal_half_mN = kNotKnown<std::uint8_t>;
  std::uint8_t sigma_tangential_half_mN = kNotKnown<std::uint8_t>;
  FingerFlags flags{};
  std::uint8_t sequence = 0;
  bool operator==(const ForceFrame&) const = default;
};

/// How wide the contact is, and how well contacts explain the strains.
struct PatchFrame {
  std::uint16_t width_um = kNotKnown<std::uint16_t>;
  std::uint16_t sigma_width_um = kNotKnown<std::uint16_t>;
  std::uint8_t chi_sixteenths = kNotKnown<std::uint8_t>;
  std::uint8_t contacts = 0;
  FingerFlags flags{};
  std::uint8_t sequence = 0;
  bool operator==(const PatchFrame&) const = default;
};

/// Where a second contact is, and how hard.
struct Contact2Frame : ContactFrame {};
struct Force2Frame : ForceFrame {};

/// CAN error counters are sent in steps: the limits of ISO 11898, warning at 96 and passive at 128, are whole
/// steps, so that the nearest step below tells exactly on which side of them a counter is.
inline constexpr std::uint8_t kErrorsPerStep = 16;
inline constexpr std::uint8_t kErrorStepsNotKnown = 15;  ///< of the four bits that the frame has for them

constexpr std::uint8_t errorSteps(std::uint8_t errors) {
  constexpr std::uint8_t kMost = kErrorStepsNotKnown - 1;
  const auto steps = static_cast<std::uint8_t>(errors / kErrorsPerStep);
  return steps < kMost ? steps : kMost;
}

/// What HEARTBEAT has of the CRC-32 of the tables: its low byte.
constexpr std::uint8_t tableCrcByte(std::uint32_t crc32) { return static_cast<std::uint8_t>(crc32); }

/// How the finger is.
struct HeartbeatFrame {
  FingerState state = FingerState::kBoot;
  std::uint8_t protocol = kProtocolVersion;
  FingerFaults faults{};
  std::uint16_t uptime_s = kNotKnown<std::uint16_t>;
  std::int8_t temperature_degC = kNotKnown<std::int8_t>;
  std::uint8_t tx_error_steps = kErrorStepsNotKnown;
  std::uint8_t rx_error_steps = kErrorStepsNotKnown;
  std::uint8_t table_crc = 0;  ///< tableCrcByte()
  bool operator==(const HeartbeatFrame&) const = default;
};

/// What the finger is and how its last run ended.
struct InfoFrame {
  ResetCause reset_cause = ResetCause::kUnknown;
  Crash crash = Crash::kNone;
  std::uint8_t restarts = 0;
  std::uint8_t version_major = 0;
  std::uint8_t version_minor = 0;
  std::uint32_t crash_address = 0;  ///< lowest 24 bits
  std::uint8_t board = 0;
  bool operator==(const InfoFrame&) const = default;
};

/// Which gauges work, and how far their zeros are to be trusted.
struct GaugesFrame {
  std::uint32_t out_of_use = 0;  ///< bit i: gauge i
  std::uint16_t zero_age_s = kNotKnown<std::uint16_t>;
  std::uint16_t zero_rate_nano_per_s = kNotKnown<std::uint16_t>;
  bool operator==(const GaugesFrame&) const = default;
};

/// Some gauges of a sample set.
struct RawFrame {
  std::uint8_t page = 0;
  RawKind kind = RawKind::kReadings;
  std::uint8_t sample = 0;
  std::uint16_t code_0 = 0;
  std::uint16_t code_1 = 0;
  std::uint16_t code_2 = 0;
  bool operator==(const RawFrame&) const = default;
};

template <>
inline constexpr FrameLayout kLayout<ContactFrame>{
    FrameSpec{.name = "CONTACT",
              .function = FunctionCode::kContact,
              .length = 8,
              .period_ms = kContactPeriod_ms,
              .onChange = true,
              .comment = "Where the finger is touched: on change, in contact at least 20 times a second"},
    Field{&ContactFrame::angle_cdeg,
          {.lsb = 0, .width = 16, .limit = 35999, .unknowable = true},
          {.name = "angle",
           .stepsPerUnit = 100,
           .unit = "deg",
           .comment = "Angle of the contact, counter-clockwise seen from the tip"}},
    Field{&ContactFrame::sigma_angle_cdeg,
          {.lsb = 16, .width = 16, .unknowable = true},
          {.name = "sigma_angle",
           .stepsPerUnit = 100,
           .unit = "deg",
           .openEnded = true,
           .comment = "Standard deviation of the angle"}},
    Field{&ContactFrame::alternative_deg,
          {.lsb = 32, .width = 8, .unknowable = true},
          {.name = "alternative",
           .unit = "deg",
           .openEnded = true,
           .comment = "Another angle that fits as well, relative to angle; not known: there is none, or "
                      "the sigmas cover it"}},
    Field{&ContactFrame::flags,
          {.lsb = 40, .width = 8},
          {.name = "flags",
           .comment = "What to know before using the numbers",
           .kind = FieldKind::kFlags,
           .names = kFingerFlagNames}},
    Field{&ContactFrame::quality_percent,
          {.lsb = 48, .width = 8, .limit = 100, .unknowable = true},
          {.name = "quality",
           .unit = "percent",
           .comment = "How well the contacts explain the strains: 100 is as well as the noise allows; 20 or "
                      "less where this contact is uncertain"}},
    Field{&ContactFrame::sequence,
          {.lsb = 56, .width = 8},
          {.name = "sequence",
           .comment = "Goes up by one with each CONTACT, 255 is followed by 0: gaps in CONTACT are lost "
                      "frames; a CONTACT2 has its CONTACT's"}},
};
static_assert(WireFrame<ContactFrame>);

template <>
inline constexpr auto kLayout<Contact2Frame> = kLayout<ContactFrame>.sentAs(
    {.name = "CONTACT2",
     .function = FunctionCode::kContact2,
     .length = 8,
     .period_ms = kContactPeriod_ms,
     .onChange = true,
     .comment = "Where a second contact is, while there is one: numbered like the CONTACT of the first"});
static_assert(WireFrame<Contact2Frame>);

template <>
inline constexpr FrameLayout kLayout<ForceFrame>{
    FrameSpec{.name = "FORCE",
              .function = FunctionCode::kForce,
              .length = 8,
              .period_ms = kContactPeriod_ms,
              .onChange = true,
              .comment = "How hard the finger is touched: after each CONTACT"},
    Field{&ForceFrame::normal_mN,
          {.lsb = 0, .width = 16, .unknowable = true},
          {.name = "normal",
           .stepsPerUnit = 1000,
           .unit = "N",
           .openEnded = true,
           .comment = "Normal force, positive when pressing on the finger"}},
    Field{&ForceFrame::tangential_mN,
          {.lsb = 16, .width = 16, .unknowable = true},
          {.name = "tangential",
           .stepsPerUnit = 1000,
           .unit = "N",
           .openEnded = true,
           .comment = "Tangential force, positive counter-clockwise seen from the tip"}},
    Field{&ForceFrame::sigma_normal_half_mN,
          {.lsb = 32, .width = 8, .unknowable = true},
          {.name = "sigma_normal",
           .stepsPerUnit = 2000,
           .unit = "N",
           .openEnded = true,
           .comment = "Standard deviation of the normal force"}},
    Field{&ForceFrame::sigma_tangential_half_mN,
          {.lsb = 40, .width = 8, .unknowable = true},
          {.name = "sigma_tangential",
           .stepsPerUnit = 2000,
           .unit = "N",
           .openEnded = true,
           .comment = "Standard deviation of the tangential force"}},
    Field{&ForceFrame::flags,
          {.lsb = 48, .width = 8},
          {.name = "flags",
           .comment = "The same as in its CONTACT or CONTACT2",
           .kind = FieldKind::kFlags,
           .names = kFingerFlagNames}},
    Field{&ForceFrame::sequence,
          {.lsb = 56, .width = 8},
          {.name = "sequence", .comment = "The number of its CONTACT"}},
};
static_assert(WireFrame<ForceFrame>);

template <>
inline constexpr auto kLayout<Force2Frame> =
    kLayout<ForceFrame>.sentAs({.name = "FORCE2",
                                .function = FunctionCode::kForce2,
                                .length = 8,
                                .period_ms = kContactPeriod_ms,
                                .onChange = true,
                                .comment = "How hard a second contact presses: after each CONTACT2"});
static_assert(WireFrame<Force2Frame>);

template <>
inline constexpr FrameLayout kLayout<PatchFrame>{
    FrameSpec{.name = "PATCH",
              .function = FunctionCode::kPatch,
              .length = 8,
              .period_ms = kContactPeriod_ms,
              .onChange = true,
              .comment = "How wide the contact is, and how well contacts explain the strains: after each "
                         "CONTACT and its FORCE"},
    Field{&PatchFrame::width_um,
          {.lsb = 0, .width = 16, .unknowable = true},
          {.name = "width",
           .stepsPerUnit = 1'000'000,
           .unit = "m",
           .openEnded = true,
           .comment = "Width of the uniform pressure with the same second moment; not known: not fitted"}},
    Field{&PatchFrame::sigma_width_um,
          {.lsb = 16, .width = 16, .unknowable = true},
          {.name = "sigma_width",
           .stepsPerUnit = 1'000'000,
           .unit = "m",
           .openEnded = true,
           .comment = "Standard deviation of the width"}},
    Field{&PatchFrame::chi_sixteenths,
          {.lsb = 32, .width = 8, .unknowable = true},
          {.name = "chi",
           .stepsPerUnit = 16,
           .openEnded = true,
           .comment = "Root of chi-squared per degree of freedom of what the fit leaves: 1 is noise alone"}},
    Field{
        &PatchFrame::contacts,
        {.lsb = 40, .width = 8},
        {.name = "contacts",
         .comment = "Contacts located: with 2, a CONTACT2 and a FORCE2 of the same number belong to these"}},
    Field{&PatchFrame::flags,
          {.lsb = 48, .width = 8},
          {.name = "flags",
           .comment = "The same as in its CONTACT",
           .kind = FieldKind::kFlags,
           .names = kFingerFlagNames}},
    Field{&PatchFrame::sequence,
          {.lsb = 56, .width = 8},
          {.name = "sequence", .comment = "The number of its CONTACT"}},
};
static_assert(WireFrame<PatchFrame>);

template <>
inline constexpr FrameLayout kLayout<HeartbeatFrame>{
    FrameSpec{.name = "HEARTBEAT",
              .function = FunctionCode::kHeartbeat,
              .length = 8,
              .period_ms = kHeartbeatPeriod_ms,
              .onChange = false,
              .comment = "How the finger is: always, ten times a second"},
    Field{&HeartbeatFrame::state,
          {.lsb = 0, .width = 4},
          {.name = "state",
           .comment = "What the finger is doing",
           .kind = FieldKind::kChoice,
           .names = kFingerStateNames}},
    Field{&HeartbeatFrame::protocol,
          {.lsb = 4, .width = 4},
          {.name = "protocol", .comment = "Version of these frames"}},
    Field{&HeartbeatFrame::faults,
          {.lsb = 8, .width = 16},
          {.name = "faults",
           .comment = "What is wrong with the finger",
           .kind = FieldKind::kFlags,
           .names = kFingerFaultNames}},
    Field{&HeartbeatFrame::uptime_s,
          {.lsb = 24, .width = 16, .unknowable = true},
          {.name = "uptime", .unit = "s", .openEnded = true, .comment = "Time since the last reset"}},
    Field{&HeartbeatFrame::temperature_degC,
          {.lsb = 40, .width = 8, .unknowable = true},
          {.name = "temperature", .unit = "degC", .comment = "Temperature of the board"}},
    Field{&HeartbeatFrame::tx_error_steps,
          {.lsb = 48, .width = 4, .unknowable = true},
          {.name = "tx_errors",
           .unitsPerStep = kErrorsPerStep,
           .openEnded = true,
           .comment = "Transmit error counter of the CAN controller (ISO 11898), rounded down"}},
    Field{&HeartbeatFrame::rx_error_steps,
          {.lsb = 52, .width = 4, .unknowable = true},
          {.name = "rx_errors",
           .unitsPerStep = kErrorsPerStep,
           .openEnded = true,
           .comment = "Receive error counter of the CAN controller (ISO 11898), rounded down"}},
    Field{&HeartbeatFrame::table_crc,
          {.lsb = 56, .width = 8},
          {.name = "table_crc", .comment = "Low byte of the CRC-32 of the tables"}},
};
static_assert(WireFrame<HeartbeatFrame>);

template <>
inline constexpr FrameLayout kLayout<InfoFrame>{
    FrameSpec{.name = "INFO",
              .function = FunctionCode::kInfo,
              .length = 8,
              .period_ms = kInfoPeriod_ms,
              .onChange = false,
              .comment = "What the finger is and how its last run ended: at start, then once a second"},
    Field{&InfoFrame::reset_cause,
          {.lsb = 0, .width = 4},
          {.name = "reset_cause",
           .comment = "Why the finger started",
           .kind = FieldKind::kChoice,
           .names = kResetCauseNames}},
    Field{&InfoFrame::crash,
          {.lsb = 4, .width = 4},
          {.name = "crash",
           .comment = "What the run before this one died of",
           .kind = FieldKind::kChoice,
           .names = kCrashNames}},
    Field{&InfoFrame::restarts,
          {.lsb = 8, .width = 8},
          {.name = "restarts", .openEnded = true, .comment = "Crashes since power came on"}},
    Field{&InfoFrame::version_major,
          {.lsb = 16, .width = 8},
          {.name = "version_major", .comment = "Version of the firmware, before the point"}},
    Field{&InfoFrame::version_minor,
          {.lsb = 24, .width = 8},
          {.name = "version_minor", .comment = "Version of the firmware, behind the point"}},
    Field{&InfoFrame::crash_address,
          {.lsb = 32, .width = 24},
          {.name = "crash_address",
           .comment = "Lowest 24 bits of the address of the instruction that crashed; 0: none"}},
    Field{&InfoFrame::board,
          {.lsb = 56, .width = 8},
          {.name = "board",
           .comment = "From the processor's unique number: tells boards apart; 0: it has none"}},
};
static_assert(WireFrame<InfoFrame>);

template <>
inline constexpr FrameLayout kLayout<GaugesFrame>{
    FrameSpec{.name = "GAUGES",
              .function = FunctionCode::kGauges,
              .length = 8,
              .period_ms = kGaugesPeriod_ms,
              .onChange = false,
              .comment = "Which gauges work: at once when that changes, else once a second"},
    Field{&GaugesFrame::out_of_use,
          {.lsb = 0, .width = 32},
          {.name = "out_of_use",
           .comment =
               "Gauges found not to work or to be noisy, which the estimates do without: bit i is gauge i",
           .kind = FieldKind::kFlags}},
    Field{&GaugesFrame::zero_age_s,
          {.lsb = 32, .width = 16, .unknowable = true},
          {.name = "zero_age",
           .unit = "s",
           .openEnded = true,
           .comment = "Time since all zeros were last seen untouched"}},
    Field{&GaugesFrame::zero_rate_nano_per_s,
          {.lsb = 48, .width = 16, .unknowable = true},
          {.name = "zero_rate",
           .stepsPerUnit = 1'000'000'000,
           .unit = "per_s",
           .openEnded = true,
           .comment = "Strain a second by which the fastest zero last followed its gauge's drift"}},
};
static_assert(WireFrame<GaugesFrame>);

template <>
inline constexpr FrameLayout kLayout<RawFrame>{
    FrameSpec{
        .name = "RAW",
        .function = FunctionCode::kRaw,
        .length = 8,
        .period_ms = 0,
        .onChange = false,
        .comment = "What the gauges read, three a page, on request: all pages of a set are of one sample"},
    Field{&RawFrame::page,
          {.lsb = 0, .width = 4},
          {.name = "page", .comment = "Its codes are those of gauges 3 page, 3 page + 1 and 3 page + 2"}},
    Field{&RawFrame::kind,
          {.lsb = 4, .width = 4},
          {.name = "kind",
           .comment = "What the codes are",
           .kind = FieldKind::kChoice,
           .names = kRawKindNames}},
    Field{&RawFrame::sample,
          {.lsb = 8, .width = 8},
          {.name = "sample",
           .comment = "Number of the sample set: goes up by one a sampling period, 255 is followed by 0"}},
    Field{&RawFrame::code_0, {.lsb = 16, .width = 16}, {.name = "code_0", .comment = "Code of gauge 3 page"}},
    Field{&RawFrame::code_1,
          {.lsb = 32, .width = 16},
          {.name = "code_1", .comment = "Code of gauge 3 page + 1; 0 beyond the last gauge"}},
    Field{&RawFrame::code_2,
          {.lsb = 48, .width = 16},
          {.name = "code_2", .comment = "Code of gauge 3 page + 2; 0 beyond the last gauge"}},
};
static_assert(WireFrame<RawFrame>);

/// Every frame a finger sends by itself.
using FingerFrames = std::tuple<ContactFrame, ForceFrame, PatchFrame, Contact2Frame, Force2Frame,
                                HeartbeatFrame, InfoFrame, GaugesFrame>;

}  // namespace strainfinger
