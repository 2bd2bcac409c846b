#include "host/can/time_window.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <string>

#include "host/base/date_text.hpp"
#include "host/base/parse_number.hpp"
#include "host/base/utc_text.hpp"

namespace strainfinger::can {
namespace {

constexpr bool isDigit(char c) { return c >= '0' && c <= '9'; }
constexpr std::int64_t kLast_s = 9'200'000'000;  // in 2261: fits 64 bits of nanoseconds

/// Digits to the last: as a double, seconds since 1970 have not enough for nanoseconds.
std::optional<std::int64_t> readFraction_ns(std::string_view text) {
  if (text.empty()) return 0;
  constexpr std::size_t kPlaces = 9;
  const bool isFraction = text.front() == '.' && text.size() > 1 && text.size() <= 1 + kPlaces;
  std::string digits(text.substr(1));
  digits.resize(kPlaces, '0');
  return isFraction && std::ranges::all_of(digits, isDigit) ? parseNumber<std::int64_t>(digits)
                                                            : std::nullopt;
}

std::optional<std::int64_t> readSeconds_ns(std::string_view text) {
  if (text.empty() || !isDigit(text.front())) return std::nullopt;
  const auto seconds = takeNumber<std::int64_t>(text);
  const auto fraction_ns = readFraction_ns(text);
  if (!seconds || *seconds > kLast_s || !fraction_ns) return std::nullopt;
  return *seconds * 1'000'000'000 + *fraction_ns;
}

/// The zone that stands behind a time of day, taken off the text: by how much it is ahead of UTC; nothing
/// where there is none.
std::optional<std::int64_t> takeZone_s(std::string_view& text) {
  if (text.ends_with('Z')) {
    text.remove_suffix(1);
    return 0;
  }
  constexpr std::size_t kLength = 6;  // "+02:00"
  const std::string_view zone = text.substr(text.size() - std::min(text.size(), kLength));
  const bool isZone = zone.size() == kLength && (zone[0] == '+' || zone[0] == '-') && zone[1] >= '0' &&
                      zone[1] < '2' && isDigit(zone[2]) && zone[3] == ':' && zone[4] >= '0' &&
                      zone[4] < '6' && isDigit(zone[5]);
  if (!isZone) return std::nullopt;
  text.remove_suffix(kLength);
  const std::int64_t ahead_s = 3600 * *parseNumber<std::int64_t>(zone.substr(1, 2)) +
                               60 * *parseNumber<std::int64_t>(zone.substr(4, 2));
  return zone[0] == '+' ? ahead_s : -ahead_s;
}

std::optional<std::int64_t> readDate_ns(std::string_view text) {
  const auto ahead_s = takeZone_s(text);
  constexpr std::string_view kMidnight = "T00:00:00";
  constexpr std::size_t kDay = 10, kMinutes = 16, kSeconds = 19;
  std::string date(text.substr(0, kSeconds));
  if (date.size() == kDay || date.size() == kMinutes) date += kMidnight.substr(date.size() - kDay);
  const auto fraction_ns = readFraction_ns(text.size() > kSeconds ? text.substr(kSeconds) : "");
  const auto read = readDate(date, 'T');
  const auto seconds = read ? secondsOf(*read, ahead_s ? TimeZone::kUtc : TimeZone::kLocal) : std::nullopt;
  if (!fraction_ns || !seconds || *seconds - ahead_s.value_or(0) < 0) return std::nullopt;
  return (*seconds - ahead_s.value_or(0)) * 1'000'000'000 + *fraction_ns;
}

}  // namespace

std::optional<LogMoment> readMoment(std::string_view text) {
  const bool sinceFirst = text.starts_with('+');
  if (sinceFirst) text.remove_prefix(1);
  auto time_ns = readSeconds_ns(text);
  if (!time_ns && !sinceFirst) time_ns = readDate_ns(text);
  if (!time_ns) return std::nullopt;
  return LogMoment{*time_ns, sinceFirst};
}

std::string timeText(std::int64_t time_ns) {
  constexpr std::int64_t kFirstDate_ns = 1'000'000'000'000'000'000;  // September 2001, ten digits of seconds
  return time_ns >= kFirstDate_ns ? utcText(time_ns)
                                  : fmt::format("{:.10g} s", 1e-9 * static_cast<double>(time_ns));
}

bool TimeWindow::has(std::int64_t time_ns) {
  if (!first_ns_) first_ns_ = time_ns;
  const auto timeLike = [&](const LogMoment& moment) {
    return moment.sinceFirst ? time_ns - *first_ns_ : time_ns;
  };
  return (!from || timeLike(*from) >= from->time_ns) && (!to || timeLike(*to) <= to->time_ns);
}

}  // namespace strainfinger::can
