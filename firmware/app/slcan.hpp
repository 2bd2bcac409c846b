#pragma once
// SLCAN: CAN frames as lines of text on a serial line, as LAWICEL's CAN232 manual (version 1.03) and Linux's
// slcan driver (drivers/net/can/slcan, 6.1) speak it. Classic frames of 11-bit identifiers only.
//
//   t1234DEADBEEF\r    frame 0x123 with 4 bytes                         either way
//   O\r C\r S8\r       open, close, bit rate                            host to device; answer \r
//   V\r N\r F\r        version, serial number, flags                    host to device; answers V1013\r
//   N0001\r F00\r      serial number, flags                           device to host
//   sp130004\r         state passive (a w p b: as hal::CanState),      device to host
//                      130 receive and 4 transmit errors
//   \a                 not understood                                   device to host

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

#include "hal/can_port.hpp"

namespace strainfinger::firmware {

/// A piece of text of at most the longest line: "t" + 3 + 1 + 16 + "\r".
class SlcanText {
 public:
  static constexpr std::size_t kLongest = 22;

  /// Beyond kLongest, characters are dropped.
  constexpr void add(char character) {
    if (size_ < kLongest) characters_[size_++] = character;
  }
  void addNumber(std::uint32_t value, int digits, std::uint32_t base);
  std::string_view view() const { return {characters_.data(), size_}; }
  std::size_t size() const { return size_; }
  void clear() { size_ = 0; }

 private:
  std::array<char, kLongest> characters_{};
  std::uint8_t size_ = 0;
};

/// A frame's line. Domain: isValid(frame).
SlcanText slcanFrame(const CanFrame& frame);

/// The line that tells the host of the bus's state; nothing for kDown, which has none. Counters that are not
/// known are sent as 0.
SlcanText slcanState(const hal::CanStatus& status);

/// What a line from the host wants.
struct SlcanCommand {
  enum class Kind : std::uint8_t {
    kNothing,
    kUnknown,
    kOpen,
    kClose,
    kBitRate,
    kVersion,
    kSerial,
    kFlags,
    kFrame
  };
  Kind kind = Kind::kUnknown;
  CanFrame frame{};  ///< of kFrame
};

/// Understands one line, without its \r. Extended and remote frames are unknown commands here.
SlcanCommand slcanCommand(std::string_view line);

/// What the host gets for its command.
std::string_view slcanAnswer(SlcanCommand::Kind kind);

/// Puts lines together from characters.
class SlcanReader {
 public:
  /// The line that this character ends, without its \r, valid until the next call. One that is longer than
  /// any comes out shortened, and so unknown.
  std::optional<std::string_view> take(char character);

 private:
  SlcanText line_;
  bool complete_ = false;
};

}  // namespace strainfinger::firmware
