#pragma once
// The frames a finger sends: their raw values and, below each, the table that says where these lie and what
// they mean. BUS.md shows the bytes. A member that is not set is "not known", never an old value.

#include <array>
#include <cstdint>
#include <tuple>

#include "common/bit_set.hpp"
#include "common/frame_layout.hpp"

namespace strainfinger {

/// Goes up when a frame changes its meaning; receivers of another version must not read the frames.
inline constexpr std::uint8_t kProtocolVersion = 1;

/// In contact CONTACT and FORCE are sent this often at least; HEARTBEAT always.
inline constexpr std::uint16_t kContactPeriod_ms = 50;
inline constexpr std::uint16_t kHeartbeatPeriod_ms = 100;

/// What a reader must know before using the numbers of CONTACT and FORCE. Bit numbers; never reuse one.
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
    ValueName{0, "contact", "Something touches the finger"},
    ValueName{1, "saturated", "A gauge the estimate uses is at the end of its range"},
    ValueName{2, "degraded", "A gauge is out of use, the sigmas are larger for it"},
    ValueName{3, "uncertain", "Another contact fits nearly as well: see alternative"},
    ValueName{4, "several_contacts", "The strains are not those of one contact"},
    ValueName{5, "stale_zero", "The zero of the gauges is too old to be trusted"},
    ValueName{6, "uncalibrated", "No calibration: forces are those of the nominal finger"},
    ValueName{7, "simulated", "From simulated gauges, not from a finger"},
};

enum class FingerState : std::uint8_t { kBoot = 0, kZeroing = 1, kRun = 2, kFault = 3 };

inline constexpr std::array kFingerStateNames{
    ValueName{0, "boot", "Starting up"},
    ValueName{1, "zeroing", "Taking the zero of the gauges: do not touch"},
    ValueName{2, "run", "Measuring"},
    ValueName{3, "fault", "Not measuring: see the faults"},
};

/// What is wrong with the finger itself. Bit numbers; never reuse one.
enum class FingerFault : std::uint8_t {
  kTables = 0,
  kGauges = 1,
  kConverter = 2,
  kCan = 3,
  kConfiguration = 4,
  kWatchdogReset = 5,
};
using FingerFaults = BitSet<FingerFault>;

inline constexpr std::array kFingerFaultNames{
    ValueName{0, "tables", "The lookup tables are absent, damaged or of another finger"},
    ValueName{1, "gauges", "Too few gauges work"},
    ValueName{2, "converter", "The converter gives no new samples"},
    ValueName{3, "can", "Frames were lost on their way to the bus"},
    ValueName{4, "configuration", "The stored configuration cannot be used"},
    ValueName{5, "watchdog_reset", "The last reset was the watchdog's"},
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

/// How the finger is.
struct HeartbeatFrame {
  FingerState state = FingerState::kBoot;
  std::uint8_t protocol = kProtocolVersion;
  FingerFaults faults{};
  std::uint16_t uptime_s = kNotKnown<std::uint16_t>;
  std::int8_t temperature_degC = kNotKnown<std::int8_t>;
  std::uint8_t tx_errors = kNotKnown<std::uint8_t>;
  std::uint8_t rx_errors = kNotKnown<std::uint8_t>;
  std::uint8_t table_crc = 0;  ///< low byte of the CRC-32 of the tables
  bool operator==(const HeartbeatFrame&) const = default;
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
           .comment = "Another angle that fits as well, relative to angle; not known: there is none"}},
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
           .comment = "How well one contact explains the strains: 100 is as well as the noise allows"}},
    Field{&ContactFrame::sequence,
          {.lsb = 56, .width = 8},
          {.name = "sequence",
           .comment = "Goes up by one with each CONTACT, 255 is followed by 0: gaps are lost frames"}},
};
static_assert(WireFrame<ContactFrame>);

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
           .comment = "Normal force, positive when pressing on the finger"}},
    Field{&ForceFrame::tangential_mN,
          {.lsb = 16, .width = 16, .unknowable = true},
          {.name = "tangential",
           .stepsPerUnit = 1000,
           .unit = "N",
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
           .comment = "The same as in its CONTACT",
           .kind = FieldKind::kFlags,
           .names = kFingerFlagNames}},
    Field{&ForceFrame::sequence,
          {.lsb = 56, .width = 8},
          {.name = "sequence", .comment = "The number of its CONTACT"}},
};
static_assert(WireFrame<ForceFrame>);

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
          {.lsb = 8, .width = 8},
          {.name = "faults",
           .comment = "What is wrong with the finger",
           .kind = FieldKind::kFlags,
           .names = kFingerFaultNames}},
    Field{&HeartbeatFrame::uptime_s,
          {.lsb = 16, .width = 16, .unknowable = true},
          {.name = "uptime", .unit = "s", .openEnded = true, .comment = "Time since the last reset"}},
    Field{&HeartbeatFrame::temperature_degC,
          {.lsb = 32, .width = 8, .unknowable = true},
          {.name = "temperature", .unit = "degC", .comment = "Temperature of the board"}},
    Field{&HeartbeatFrame::tx_errors,
          {.lsb = 40, .width = 8, .unknowable = true},
          {.name = "tx_errors",
           .openEnded = true,
           .comment = "Transmit error counter of the CAN controller (ISO 11898)"}},
    Field{&HeartbeatFrame::rx_errors,
          {.lsb = 48, .width = 8, .unknowable = true},
          {.name = "rx_errors",
           .openEnded = true,
           .comment = "Receive error counter of the CAN controller (ISO 11898)"}},
    Field{&HeartbeatFrame::table_crc,
          {.lsb = 56, .width = 8},
          {.name = "table_crc", .comment = "Low byte of the CRC-32 of the tables"}},
};
static_assert(WireFrame<HeartbeatFrame>);

/// Every frame a finger sends.
using FingerFrames = std::tuple<ContactFrame, ForceFrame, HeartbeatFrame>;

}  // namespace strainfinger
