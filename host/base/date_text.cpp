#include "host/base/date_text.hpp"

namespace strainfinger {

std::optional<std::tm> readDate(const std::string& text, char separator) {
  const std::string form = std::string("%Y-%m-%d") + separator + "%H:%M:%S";
  constexpr std::size_t kLength = 19;  // strptime() also takes numbers with fewer digits
  std::tm date{};
  const char* const end = strptime(text.c_str(), form.c_str(), &date);
  if (text.size() != kLength || end != text.c_str() + kLength) return std::nullopt;
  return date;
}

std::optional<std::int64_t> secondsOf(std::tm date, TimeZone zone) {
  date.tm_isdst = -1;
  const int day = date.tm_mday;
  const std::int64_t seconds = zone == TimeZone::kUtc ? timegm(&date) : std::mktime(&date);
  if (date.tm_mday != day) return std::nullopt;  // of February 30, they make March 2
  return seconds;
}

}  // namespace strainfinger
