#pragma once
// A part of a log, by its times.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace strainfinger::can {

/// A moment in a log.
struct LogMoment {
  std::int64_t time_ns = 0;
  bool sinceFirst = false;  ///< frame of the log; else as the log has it
};

/// "1764385920.5": as the log has it; "+12.5": seconds after its first frame; "2026-11-29T03:12:00": in this
/// machine's time zone (TZ), with a Z behind it in UTC, with +02:00 in that zone; seconds, or the time of
/// day, may be left out. Nothing for other texts, and for times that no log can have: before 1970, after
/// 2262.
std::optional<LogMoment> readMoment(std::string_view text);

/// "2026-11-29T03:12:00Z"; of a time that is no date (candump -tz), "12.5 s".
std::string timeText(std::int64_t time_ns);

class TimeWindow {
 public:
  std::optional<LogMoment> from, to;  ///< both inclusive; nothing: all before or after

  bool isWhole() const { return !from && !to; }
  /// It ends before it begins.
  bool isEmpty() const {
    return from && to && from->sinceFirst == to->sinceFirst && from->time_ns > to->time_ns;
  }

  /// Whether a frame of that time is in it. The first frame that it is asked for is the log's first.
  bool has(std::int64_t time_ns);

  /// Of the log's first frame; nothing before that.
  std::optional<std::int64_t> first_ns() const { return first_ns_; }

 private:
  std::optional<std::int64_t> first_ns_;
};

}  // namespace strainfinger::can
