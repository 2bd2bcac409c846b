#pragma once
// What the host tells an emulated board of the world, on UART2. Read and written here, for both sides.
//
//   byte 0        what it is (RecordKind)
//   byte 1        number of bytes that follow, 0 .. 64
//   byte 2 ..     samples: one left-justified code a gauge, 16 bits, lowest byte first (hal/gauge_adc.hpp)
//                 harm:    what goes wrong (Harm)
//                 bus:     state (hal::CanState), transmit errors, receive errors
//                 end:     exit status of the emulator
//
// The board says kReady once it listens. A restart loses what was on its way, so after a record that makes it
// restart the host waits for the next one.
//
// Samples and silence are a conversion period each: time on an emulated board is their number, so that a run
// is the same every time, however fast machine and emulator are.

#include <array>
#include <cstdint>
#include <optional>
#include <span>

#include "common/quantities.hpp"

namespace strainfinger::mps2 {

/// A record's period of time.
inline constexpr std::uint32_t kRecordPeriod_us = 1000;

inline constexpr std::uint8_t kReady = 'R';

enum class RecordKind : std::uint8_t {
  kSamples = 'S',  ///< a period passes, a sample set is there
  kSilence = 'T',  ///< a period passes, the converter says nothing
  kHarm = 'X',     ///< the firmware goes wrong now
  kBus = 'B',      ///< the CAN bus is now like this
  kEnd = 'Q',      ///< the emulator ends
};

/// Ways for a firmware to go wrong.
enum class Harm : std::uint8_t {
  kHardFault = 1,      ///< writes where nothing is
  kAssertion = 2,      ///< finds itself in a state that cannot be
  kStackOverflow = 3,  ///< pushes beyond its stack
  kHang = 4,           ///< never comes back
};

struct WorldRecord {
  RecordKind kind = RecordKind::kSilence;
  std::uint8_t size = 0;
  std::array<std::uint8_t, 2 * kMaxGauges> payload{};

  constexpr void add(std::uint8_t byte) { payload[size++] = byte; }
  constexpr std::uint16_t code(std::size_t gauge) const {
    return static_cast<std::uint16_t>(payload[2 * gauge] | payload[2 * gauge + 1] << 8);
  }
};

/// The record of a sample set; domain: at most kMaxGauges codes.
constexpr WorldRecord samplesRecord(std::span<const std::uint16_t> codes) {
  WorldRecord record{RecordKind::kSamples};
  for (const std::uint16_t code : codes) {
    record.add(static_cast<std::uint8_t>(code & 0xFF));
    record.add(static_cast<std::uint8_t>(code >> 8));
  }
  return record;
}

/// Puts records together from bytes.
class RecordReader {
 public:
  /// True: this byte ends a record. One that claims to be longer than any is cut there.
  constexpr bool take(std::uint8_t byte) {
    if (position_ == 0) record_ = {static_cast<RecordKind>(byte)};
    if (position_ == 1) expected_ = byte;
    if (position_ >= 2) record_.add(byte);
    ++position_;
    if (position_ < 2 || (record_.size < expected_ && record_.size < record_.payload.size())) return false;
    position_ = 0;
    return true;
  }
  constexpr const WorldRecord& record() const { return record_; }

 private:
  WorldRecord record_;
  std::uint32_t position_ = 0;
  std::uint8_t expected_ = 0;
};

}  // namespace strainfinger::mps2
