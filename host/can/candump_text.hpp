#pragma once
// candump's text, written and read. The forms are those of can-utils (lib.h, candump --help): 2020.11, the
// one in Debian 12, and what versions up to 2025 added (nanoseconds, raw length codes).

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>

#include "common/can_frame.hpp"

namespace strainfinger::can {

/// One frame as `candump -L` (or -l) writes it, without the newline: "(1609779922.655421) can0
/// 185#E80322011EFF01A3". `time_us` is not negative.
std::string formatLogLine(std::int64_t time_us, std::string_view interface, const CanFrame& frame);

enum class LineKind : std::uint8_t {
  kNothing,  ///< blank, or the explanation candump -e puts below an error frame
  kData,
  kRemote,   ///< remote request: `length` is what it asks for, there is no data
  kError,    ///< error frame: the controller's report, not something on the bus
  kDropped,  ///< candump -d: so many frames never reached candump
};

enum class LineForm : std::uint8_t { kNone, kLog, kScreen };  ///< kLog: -l and -L, kScreen: without these

enum class TimeForm : std::uint8_t {
  kNone,
  kAbsolute,  ///< since 1970: -L, -l, -ta
  kDate,      ///< local time: -tA
  kRelative,  ///< since the first frame or the one before: -tz, -td; the text doesn't say which
};

enum class Direction : std::uint8_t { kUnknown, kReceived, kSent };  ///< -x

/// A frame of any kind a log can hold.
struct LoggedFrame {
  std::uint32_t id = 0;      ///< without flag bits, except error frames: their error class bits
  bool extended = false;     ///< 29-bit identifier
  bool fd = false;           ///< CAN FD
  std::uint8_t fdFlags = 0;  ///< as logged: 1 bit rate switch, 2 error state indicator, 4 FD format
  std::uint8_t length = 0;   ///< 0 .. 8, FD 0 .. 64
  std::array<std::uint8_t, 64> data{};
};

/// formatLogLine() of a frame that CanFrame can't hold: 29-bit identifiers, remote requests, CAN FD.
std::string formatLogLine(std::int64_t time_us, std::string_view interface, const LoggedFrame& frame,
                          bool isRemote);

/// What a line says.
struct LogLine {
  LineKind kind = LineKind::kNothing;
  LineForm form = LineForm::kNone;
  TimeForm timeForm = TimeForm::kNone;
  Direction direction = Direction::kUnknown;
  std::optional<std::int64_t> time_ns;
  std::string interface;
  LoggedFrame frame;
  std::uint32_t dropped = 0;  ///< frames, kDropped only
};

/// Why a line cannot be read; columns count from 1, in bytes.
struct LogError {
  std::size_t column = 1;
  std::string reason;
};

/// Reads one line, with or without its line end, in any text form of candump: log files; the screen form with
/// any of -t a|A|d|z, -x, -a, -e, -d, -c (colours), -i (binary digits), -8, -N. UTF-8's byte order mark may
/// stand before it. Byte-swapped dumps (-S) are read where they have two bytes or more: one byte
/// looks the same in both orders.
std::variant<LogLine, LogError> parseLogLine(std::string_view line);

/// A classic data frame of an 11-bit identifier, the only ones fingers send, as a line has it.
struct TextFrame {
  std::optional<std::int64_t> time_ns;
  std::string_view interface;  ///< within the line
  CanFrame frame;
};

/// The same as parseLogLine() and classicFrame() give, but only of lines just as formatLogLine() writes them,
/// and in a fifth of the time: most lines of most logs. Nothing for any other line, whether it is good or
/// not.
std::optional<TextFrame> parsePlainLine(std::string_view line);

/// The line's frame if it is a classic data frame with an 11-bit identifier: the only ones fingers send.
std::optional<CanFrame> classicFrame(const LogLine& line);

/// "log", "log with direction", "screen, absolute time", ...: which form a line has, for people.
std::string describeForm(const LogLine& line);

}  // namespace strainfinger::can
