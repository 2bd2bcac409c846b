#pragma once
// Dates of texts, as times since 1970.

#include <cstdint>
#include <ctime>
#include <optional>
#include <string>

namespace strainfinger {

enum class TimeZone : std::uint8_t { kLocal, kUtc };  ///< kLocal: this machine's, or what TZ names

/// What "2026-11-28 14:04:01" says, `separator` between day and time of day; nothing where it isn't just
/// that.
std::optional<std::tm> readDate(const std::string& text, char separator);

/// Since 1970; nothing where there is no such day.
std::optional<std::int64_t> secondsOf(std::tm date, TimeZone zone);

}  // namespace strainfinger
