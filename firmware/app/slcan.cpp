#include "firmware/app/slcan.hpp"

#include <algorithm>

namespace strainfinger::firmware {
namespace {

constexpr std::uint32_t kDecimal = 10, kHexadecimal = 16;
constexpr std::size_t kFrameHead = 5;  ///< t, three digits, length

/// 0 .. 15, or 16 for what is no digit.
constexpr std::uint8_t hexDigit(char character) {
  if (character >= '0' && character <= '9') return static_cast<std::uint8_t>(character - '0');
  if (character >= 'A' && character <= 'F') return static_cast<std::uint8_t>(character - 'A' + 10);
  if (character >= 'a' && character <= 'f') return static_cast<std::uint8_t>(character - 'a' + 10);
  return kHexadecimal;
}

std::optional<std::uint16_t> hexNumber(std::string_view digits) {
  std::uint16_t value = 0;
  for (const char character : digits) {
    const std::uint8_t digit = hexDigit(character);
    if (digit == kHexadecimal) return std::nullopt;
    value = static_cast<std::uint16_t>(value * kHexadecimal + digit);
  }
  return value;
}

std::optional<CanFrame> frameOf(std::string_view line) {
  if (line.size() < kFrameHead) return std::nullopt;
  const auto id = hexNumber(line.substr(1, 3));
  const auto length = hexNumber(line.substr(4, 1));
  if (!id || !length) return std::nullopt;
  CanFrame frame{*id, static_cast<std::uint8_t>(*length), {}};
  if (!isValid(frame) || line.size() != kFrameHead + std::size_t{2} * frame.length) return std::nullopt;
  for (std::size_t i = 0; i < frame.length; ++i) {
    const auto byte = hexNumber(line.substr(kFrameHead + 2 * i, 2));
    if (!byte) return std::nullopt;
    frame.data[i] = static_cast<std::uint8_t>(*byte);
  }
  return frame;
}

char stateLetter(hal::CanState state) {
  switch (state) {
    case hal::CanState::kActive:
      return 'a';
    case hal::CanState::kWarning:
      return 'w';
    case hal::CanState::kPassive:
      return 'p';
    default:
      return 'b';
  }
}

}  // namespace

void SlcanText::addNumber(std::uint32_t value, int digits, std::uint32_t base) {
  std::uint32_t place = 1;
  for (int i = 1; i < digits; ++i) place *= base;
  for (; place != 0; place /= base) add("0123456789ABCDEF"[value / place % base]);
}

SlcanText slcanFrame(const CanFrame& frame) {
  SlcanText text;
  text.add('t');
  text.addNumber(frame.id, 3, kHexadecimal);
  text.addNumber(frame.length, 1, kHexadecimal);
  for (std::size_t i = 0; i < frame.length; ++i) text.addNumber(frame.data[i], 2, kHexadecimal);
  text.add('\r');
  return text;
}

SlcanText slcanState(const hal::CanStatus& status) {
  SlcanText text;
  if (status.state == hal::CanState::kDown) return text;
  text.add('s');
  text.add(stateLetter(status.state));
  text.addNumber(status.rxErrors.value_or(0), 3, kDecimal);
  text.addNumber(status.txErrors.value_or(0), 3, kDecimal);
  text.add('\r');
  return text;
}

SlcanCommand slcanCommand(std::string_view line) {
  using Kind = SlcanCommand::Kind;
  if (line.empty()) return {Kind::kNothing, {}};
  if (line[0] == 't') {
    const auto frame = frameOf(line);
    return frame ? SlcanCommand{Kind::kFrame, *frame} : SlcanCommand{};
  }
  if (line[0] == 'S' && line.size() == 2 && line[1] >= '0' && line[1] <= '8') return {Kind::kBitRate, {}};
  if (line.size() != 1) return {};
  switch (line[0]) {
    case 'O':
      return {Kind::kOpen, {}};
    case 'C':
      return {Kind::kClose, {}};
    case 'V':
      return {Kind::kVersion, {}};
    case 'N':
      return {Kind::kSerial, {}};
    case 'F':
      return {Kind::kFlags, {}};
    default:
      return {};
  }
}

std::string_view slcanAnswer(SlcanCommand::Kind kind) {
  using Kind = SlcanCommand::Kind;
  switch (kind) {
    case Kind::kUnknown:
      return "\a";
    case Kind::kVersion:
      return "V1013\r";
    case Kind::kSerial:
      return "N0001\r";
    case Kind::kFlags:
      return "F00\r";
    case Kind::kFrame:
      return "z\r";
    default:
      return "\r";
  }
}

std::optional<std::string_view> SlcanReader::take(char character) {
  if (complete_) line_.clear();
  complete_ = character == '\r';
  if (complete_) return line_.view();
  line_.add(character);
  return std::nullopt;
}

}  // namespace strainfinger::firmware
