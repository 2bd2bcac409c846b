#include "host/can/time_window.hpp"

#include <algorithm>
#include <string>

#include "host/base/date_text.hpp"
#include "host/base/parse_number.hpp"

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

std::optional<std::int64_t> readDate_ns(std::string_view text) {
  const TimeZone zone = text.ends_with('Z') ? TimeZone::kUtc : TimeZone::kLocal;
  if (zone == TimeZone::kUtc) text.remove_suffix(1);
  constexpr std::size_t kWholeSeconds = 19;
  const std::string_view day = text.substr(0, kWholeSeconds);
  const auto fraction_ns = readFraction_ns(text.substr(day.size()));
  const auto date = readDate(std::string(day), 'T');
  const auto seconds = date ? secondsOf(*date, zone) : std::nullopt;
  if (!fraction_ns || !seconds || *seconds < 0) return std::nullopt;
  return *seconds * 1'000'000'000 + *fraction_ns;
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

bool TimeWindow::has(std::int64_t time_ns) {
  if (!first_ns_) first_ns_ = time_ns;
  const auto timeLike = [&](const LogMoment& moment) {
    return moment.sinceFirst ? time_ns - *first_ns_ : time_ns;
  };
  return (!from || timeLike(*from) >= from->time_ns) && (!to || timeLike(*to) <= to->time_ns);
}

}  // namespace strainfinger::can
