#include "host/can/candump_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <string_view>
#include <utility>

#include "host/base/byte_order_mark.hpp"
#include "host/base/date_text.hpp"
#include "host/can/line_cursor.hpp"

namespace strainfinger::can {
namespace {

// Flag bits of the kernel's identifiers (linux/can.h): the text has them too.
constexpr std::uint32_t kErrorFlag = 0x20000000;
constexpr std::uint32_t kExtendedMask = 0x1FFFFFFF;
constexpr std::size_t kClassicBytes = 8;
constexpr std::size_t kFdBytes = 64;
constexpr std::int64_t kLastSecond = 9'223'372'035;  // fits 64 bits of nanoseconds, whatever the fraction

constexpr bool isPrintable(char c) { return c >= ' ' && c <= '~'; }

/// Reads a line from left to right. Every step returns false after it has noted what is wrong at at_.
class LineParser : private LineCursor {
 public:
  using LineCursor::LineCursor;

  std::variant<LogLine, LogError> parse() {
    if (!parseLine()) return LogError{at_ + 1, reason_};
    return std::move(result_);
  }

 private:
  bool parseLine() {
    skip(kByteOrderMark);  // of files one behind the other, in between too
    if (peek() == '\t') return true;
    skipBlanks();
    if (atEnd()) return true;
    if (skip("DROPCOUNT: dropped ")) return parseDropCount();
    return parseTime() && parseInterface() && parseFrame();
  }

  bool parseDropCount() {
    result_.kind = LineKind::kDropped;
    std::int64_t count = 0;
    const std::size_t length = digits(count, 1, 18);
    if (length == 0) return fail("the number of dropped frames is missing");
    if (count > std::numeric_limits<std::uint32_t>::max())
      return failBack(length, "no such number of dropped frames: the largest is 4294967295");
    result_.dropped = static_cast<std::uint32_t>(count);
    const std::size_t open = line_.find('\'', at_);
    const std::size_t close = open == line_.npos ? open : line_.find('\'', open + 1);
    if (close == line_.npos) return fail("the interface, between quotation marks, is missing");
    at_ = open + 1;
    return takeInterface(line_.substr(at_, close - at_));
  }

  bool parseTime() {
    if (peek() != '(') return true;
    ++at_;
    const bool date = peek(4) == '-' && peek(10) == ' ';
    const std::size_t start = at_;
    std::int64_t seconds = 0;
    if (!(date ? parseDate(seconds) : parseSeconds(seconds))) return false;
    if (seconds < 0 || seconds > kLastSecond) return failBack(at_ - start, "no such time: 1970 to 2262");
    std::int64_t fraction = 0;
    if (!skip(".")) return fail("expected '.' and 6 or 9 digits of a second");
    const std::size_t count = digits(fraction, 6, 9);
    if (count != 6 && count != 9) return failBack(count, "expected 6 or 9 digits of a second");
    if (!skip(")")) return fail("expected ')' after the time");
    result_.time_ns = seconds * 1'000'000'000 + (count == 6 ? fraction * 1000 : fraction);
    skipBlanks();
    return true;
  }

  bool parseSeconds(std::int64_t& seconds) {
    const std::size_t count = digits(seconds, 1, 10);
    if (count == 0) return fail("expected a time: seconds, or date and time of day");
    result_.timeForm = count == 10 ? TimeForm::kAbsolute : TimeForm::kRelative;
    return true;
  }

  bool parseDate(std::int64_t& seconds) {
    const std::string text(line_.substr(at_, 19));
    const auto date = readDate(text, ' ');
    if (!date) return fail("expected a date and a time of day");
    const auto since1970_s = secondsOf(*date, TimeZone::kLocal);
    if (!since1970_s) return fail("no such date: that month is shorter");
    seconds = *since1970_s;
    result_.timeForm = TimeForm::kDate;
    at_ += text.size();
    return true;
  }

  bool parseInterface() {
    if (token().empty()) return fail("expected the name of an interface");
    if (!takeInterface(token())) return false;
    const bool isFrame = atEnd() && result_.interface.find('#') != std::string::npos;
    if (isFrame)
      return failBack(result_.interface.size(), "expected an interface before the frame: can0 185#E803");
    skipBlanks();
    return true;
  }

  /// The name that stands here. It is printed, and a terminal obeys what is not printable.
  bool takeInterface(std::string_view name) {
    const auto printable =
        static_cast<std::size_t>(std::ranges::find_if_not(name, isPrintable) - name.begin());
    at_ += printable;
    if (printable < name.size()) return fail("an interface's name has printable ASCII characters only");
    result_.interface = name;
    return true;
  }

  bool parseFrame() {
    if (token().find('#') != std::string_view::npos) return parseLogFrame();
    result_.form = LineForm::kScreen;
    return parseDirectionColumns() && parseScreenFrame();
  }

  bool parseDirectionColumns() {
    const bool sent = token() == "TX";
    if (!sent && token() != "RX") return true;
    result_.direction = sent ? Direction::kSent : Direction::kReceived;
    at_ += 2;
    for (const char flag : {'B', 'E'}) {
      skipBlanks();
      if (token() != "-" && token() != std::string_view(&flag, 1)) return fail("expected the columns of -x");
      if (peek() == flag) result_.frame.fdFlags |= flag == 'B' ? 1 : 2;
      ++at_;
    }
    skipBlanks();
    return true;
  }

  bool parseId() {
    std::size_t count = 0;
    std::uint32_t id = 0;
    for (; count < 9 && hexValue(peek(count)) >= 0; ++count)
      id = id << 4 | static_cast<std::uint32_t>(hexValue(peek(count)));
    if (count != 3 && count != 8) return fail("expected an identifier of 3 or 8 hexadecimal digits");
    const bool error = count == 8 && (id & kErrorFlag) != 0;
    if (count == 3 ? id > kMaxCanId : (id & ~(kExtendedMask | kErrorFlag)) != 0)
      return fail("no such identifier: the largest are 7FF and 1FFFFFFF");
    at_ += count;
    result_.kind = error ? LineKind::kError : LineKind::kData;
    result_.frame.extended = count == 8 && !error;
    result_.frame.id = id & kExtendedMask;
    return true;
  }

  bool parseLogFrame() {
    result_.form = LineForm::kLog;
    if (!parseId()) return false;
    if (!skip("#")) return fail("expected '#' after the identifier");
    if (peek() == 'R' || peek() == 'r') return parseLogRemote() && parseLogEnd();
    if (skip("#")) {
      if (hexValue(peek()) < 0) return fail("expected the flags of a CAN FD frame, one hexadecimal digit");
      result_.frame.fd = true;
      result_.frame.fdFlags = static_cast<std::uint8_t>(hexValue(peek()));
      ++at_;
    }
    return parseLogData() && parseLogEnd();
  }

  bool parseLogRemote() {
    if (result_.kind == LineKind::kError) return fail("an error frame is no remote request");
    result_.kind = LineKind::kRemote;
    ++at_;
    if (peek() >= '0' && peek() <= '8') result_.frame.length = static_cast<std::uint8_t>(line_[at_++] - '0');
    return true;
  }

  bool parseLogData() {
    while (hexValue(peek(peek() == '.' ? 1 : 0)) >= 0) {
      if (peek() == '.') ++at_;
      if (!parseByte(2, 16)) return false;
    }
    return true;
  }

  bool parseLogEnd() {
    if (peek() == '_') {  // -8: the length code of a full frame, 9 .. F
      if (hexValue(peek(1)) <= 8 || result_.frame.length != kClassicBytes || result_.frame.fd)
        return fail("a length code of 9 to F belongs to 8 bytes");
      at_ += 2;
    }
    if (!atEnd() && !isBlank(peek())) return fail("expected data, two hexadecimal digits a byte");
    skipBlanks();
    if (token() == "R" || token() == "T") {
      result_.direction = peek() == 'T' ? Direction::kSent : Direction::kReceived;
      ++at_;
      skipBlanks();
    }
    return atEnd() || fail("unexpected text after the frame");
  }

  bool parseScreenFrame() {
    if (!parseId()) return false;
    skipBlanks();
    std::size_t length = 0;
    if (!parseScreenLength(length)) return false;
    skipBlanks();
    if (skip("remote request")) return parseScreenRemote(length);
    bool isReversed = false;  // -S, which marks the gaps
    while (result_.frame.length < length) {
      const bool isMarked = result_.frame.length > 0 && skip("`");
      if (result_.frame.length == 1) isReversed = isMarked;
      if (result_.frame.length > 1 && isMarked != isReversed)
        return fail("expected the same mark between all bytes");
      skipBlanks();
      const std::string_view byte = token().substr(0, token().find('`'));
      const bool binary = byte.size() == 8 && byte.find_first_not_of("01") == std::string_view::npos;
      if (!(binary ? parseByte(8, 2) : parseByte(2, 16))) return false;
      if (!token().empty() && peek() != '`') return fail("expected a blank after the byte");
    }
    if (isReversed)
      std::reverse(result_.frame.data.begin(), result_.frame.data.begin() + result_.frame.length);
    return parseScreenEnd();
  }

  bool parseScreenRemote(std::size_t length) {
    if (result_.kind == LineKind::kError || result_.frame.fd)
      return fail("such a frame is no remote request");
    result_.kind = LineKind::kRemote;
    result_.frame.length = static_cast<std::uint8_t>(length);
    skipBlanks();
    return atEnd() || fail("unexpected text after the frame");
  }

  /// "[8]" classic, "[08]" CAN FD, "{F}" a classic frame of 8 bytes with a length code above 8 (-8).
  bool parseScreenLength(std::size_t& length) {
    if (peek() == '{' && hexValue(peek(1)) > 8 && peek(2) == '}') {
      length = kClassicBytes;
      at_ += 3;
      return true;
    }
    if (!skip("[")) return fail("expected the length, as in [8]");
    std::int64_t value = 0;
    const std::size_t count = digits(value, 1, 4);
    if (count == 4) return failBack(count, "a CAN XL frame; only classic CAN and CAN FD can be read");
    result_.frame.fd = count == 2;
    length = static_cast<std::size_t>(value);
    if (count == 0 || count > 2 || length > capacity())
      return failBack(count, "expected a length: [0] to [8], FD [00] to [64]");
    return skip("]") || fail("expected ']' after the length");
  }

  /// What may follow the data: "ERRORFRAME", or the data as text (-a).
  bool parseScreenEnd() {
    skipBlanks();
    if (result_.kind == LineKind::kError) skip("ERRORFRAME");
    if (const char mark = peek(); mark == '\'' || mark == '`') {
      const std::size_t length = result_.frame.length + std::size_t{2};
      if (peek(length - 1) != mark) return fail("expected the data as text between quotation marks");
      at_ += length;
    }
    skipBlanks();
    return atEnd() || fail("unexpected text after the data");
  }

  /// One byte of `count` digits to the base 16 or 2.
  bool parseByte(std::size_t count, int base) {
    if (result_.frame.length >= capacity()) return fail("more data than a frame holds");
    int value = 0;
    for (std::size_t i = 0; i < count; ++i) {
      const int digit = hexValue(peek(i));
      if (digit < 0 || digit >= base) return fail("expected a byte, two hexadecimal digits");
      value = value * base + digit;
    }
    result_.frame.data[result_.frame.length++] = static_cast<std::uint8_t>(value);
    at_ += count;
    return true;
  }

  std::size_t capacity() const { return result_.frame.fd ? kFdBytes : kClassicBytes; }

  bool fail(std::string reason) {
    reason_ = std::move(reason);
    return false;
  }

  /// The same, `back` characters before at_.
  bool failBack(std::size_t back, std::string reason) {
    at_ -= back;
    return fail(std::move(reason));
  }

  LogLine result_;
  std::string reason_;
};

/// The number that a text of nothing but digits to the base 10 or 16 stands for, or -1.
template <int kBase>
std::int64_t wholeNumber(std::string_view text) {
  std::int64_t value = 0;
  for (const char c : text) {
    const int digit = hexValue(c);
    if (digit < 0 || digit >= kBase) return -1;
    value = value * kBase + digit;
  }
  return value;
}

/// "(1609779922.655421) " at the start of the line [us], or -1.
std::int64_t plainTime_us(std::string_view line) {
  if (line[0] != '(' || line[11] != '.' || line[18] != ')' || line[19] != ' ') return -1;
  const std::int64_t seconds = wholeNumber<10>(line.substr(1, 10));
  const std::int64_t fraction_us = wholeNumber<10>(line.substr(12, 6));
  return seconds < 0 || fraction_us < 0 || seconds > kLastSecond ? -1 : seconds * 1'000'000 + fraction_us;
}

/// "185#E803", or nothing.
std::optional<CanFrame> plainFrame(std::string_view text) {
  const std::size_t length = text.size() < 4 ? 0 : (text.size() - 4) / 2;
  if (text.size() != 4 + 2 * length || length > kClassicBytes || text[3] != '#') return std::nullopt;
  const std::int64_t id = wholeNumber<16>(text.substr(0, 3));
  if (id < 0 || id > kMaxCanId) return std::nullopt;
  CanFrame frame{static_cast<std::uint16_t>(id), static_cast<std::uint8_t>(length), {}};
  int wrong = 0;
  for (std::size_t i = 0; i < length; ++i) {
    const int byte = hexValue(text[4 + 2 * i]) * 16 | hexValue(text[5 + 2 * i]);
    frame.data[i] = static_cast<std::uint8_t>(byte);
    wrong |= byte;  // a negative digit makes it negative
  }
  if (wrong < 0) return std::nullopt;
  return frame;
}

}  // namespace

std::string formatLogLine(std::int64_t time_us, std::string_view interface, const CanFrame& frame) {
  std::string line =
      fmt::format("({:010}.{:06}) {} {:03X}#", time_us / 1'000'000, time_us % 1'000'000, interface, frame.id);
  for (std::size_t i = 0; i < frame.length; ++i)
    fmt::format_to(std::back_inserter(line), "{:02X}", frame.data[i]);
  return line;
}

std::string formatLogLine(std::int64_t time_us, std::string_view interface, const LoggedFrame& frame,
                          bool isRemote) {
  std::string line = fmt::format("({:010}.{:06}) {} {:0{}X}#", time_us / 1'000'000, time_us % 1'000'000,
                                 interface, frame.id, frame.extended ? 8 : 3);
  if (isRemote) return line + (frame.length > 0 ? fmt::format("R{:X}", frame.length) : "R");
  if (frame.fd) line += fmt::format("#{:X}", frame.fdFlags);
  for (std::size_t i = 0; i < frame.length; ++i)
    fmt::format_to(std::back_inserter(line), "{:02X}", frame.data[i]);
  return line;
}

std::variant<LogLine, LogError> parseLogLine(std::string_view line) { return LineParser(line).parse(); }

std::optional<TextFrame> parsePlainLine(std::string_view line) {
  constexpr std::size_t kInterface = 20;
  if (line.size() <= kInterface) return std::nullopt;
  const std::int64_t time_us = plainTime_us(line);
  std::size_t end = kInterface;
  while (end < line.size() && line[end] != ' ' && isPrintable(line[end])) ++end;
  if (time_us < 0 || end == kInterface || end == line.size() || line[end] != ' ') return std::nullopt;
  const std::optional<CanFrame> frame = plainFrame(line.substr(end + 1));
  if (!frame) return std::nullopt;
  return TextFrame{time_us * 1000, line.substr(kInterface, end - kInterface), *frame};
}

std::optional<CanFrame> classicFrame(const LogLine& line) {
  const LoggedFrame& logged = line.frame;
  if (line.kind != LineKind::kData || logged.extended || logged.fd) return std::nullopt;
  CanFrame frame{static_cast<std::uint16_t>(logged.id), logged.length, {}};
  std::copy_n(logged.data.begin(), logged.length, frame.data.begin());
  return frame;
}

std::string describeForm(const LogLine& line) {
  constexpr std::array kForms{"nothing", "log", "screen"};
  constexpr std::array kTimes{"no time", "absolute time", "date", "relative time"};
  std::string text = fmt::format("{}, {}", kForms.at(static_cast<std::size_t>(line.form)),
                                 kTimes.at(static_cast<std::size_t>(line.timeForm)));
  return text.append(line.direction == Direction::kUnknown ? "" : ", direction");
}

}  // namespace strainfinger::can
