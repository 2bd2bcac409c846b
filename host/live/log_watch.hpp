#pragma once
// A log of one or more buses, watched as if it were live.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "host/can/candump_text.hpp"
#include "host/live/fleet.hpp"
#include "host/live/onward_clock.hpp"

namespace strainfinger::live {

class LogWatch {
 public:
  /// Both are for the Fleets of all its buses.
  explicit LogWatch(const config::FingerConfig& config,
                    std::optional<std::uint32_t> tables_crc32 = std::nullopt)
      : config_(config), tables_crc32_(tables_crc32) {}

  /// Takes a line of any of candump's text forms. A frame without a time comes when the one before it came.
  /// Where times go back, as of a clock that was set, they go on from the last: OnwardClock.
  std::optional<can::LogError> take(std::string_view line);

  /// Of the last frame [us], by that clock; nothing before the first.
  std::optional<std::int64_t> time_us() const { return time_us_; }

  /// The buses by name, as they are then.
  std::vector<BusView> views(std::int64_t now_us);

 private:
  config::FingerConfig config_;
  std::optional<std::uint32_t> tables_crc32_;
  OnwardClock clock_;
  std::optional<std::int64_t> time_us_;
  std::map<std::string, Fleet> buses_;
};

}  // namespace strainfinger::live
