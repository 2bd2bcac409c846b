#include "host/can/log_times.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace strainfinger::can {
namespace {

/// Frames of several interfaces may be logged a little out of order; clocks that are set jump by more.
constexpr std::int64_t kOutOfOrder_ns = 1'000'000'000;
/// Where more than one frame in so many is earlier than the one before it, times are differences.
constexpr std::uint64_t kMostOutOfOrder = 4;

}  // namespace

/// Each interface has a clock of its own.
LogTimes::Clock& LogTimes::clockOf(std::string_view interface, std::int64_t time_ns) {
  if (last_ == nullptr || last_->first != interface)
    last_ = &*clocks_.try_emplace(std::string(interface), Clock{time_ns, time_ns}).first;
  return last_->second;
}

void LogTimes::watch(std::string_view interface, std::int64_t time_ns, const LineReader& lines) {
  Clock& clock = clockOf(interface, time_ns);
  ++times_;
  if (time_ns < std::exchange(clock.last_ns, time_ns) && timesBack_++ == 0) name_ = lines.name();
  const std::int64_t latest_ns = order_ == Order::kOfAll ? latest_ns_.value_or(time_ns) : clock.latest_ns;
  if (timesGoBack_.empty() && time_ns < latest_ns - kOutOfOrder_ns)
    timesGoBack_ = fmt::format(
        "{}: the times go back by {:.3g} s here: the clock was set, logs of several runs were joined, or "
        "they are differences (candump -td)",
        lines.place(), 1e-9 * static_cast<double>(latest_ns - time_ns));
  clock.latest_ns = std::max(clock.latest_ns, time_ns);
  latest_ns_ = std::max(latest_ns, time_ns);
}

std::string LogTimes::warning() const {
  if (!timesGoBack_.empty()) return timesGoBack_;
  if (timesBack_ <= times_ / kMostOutOfOrder || timesBack_ <= 1) return "";
  return fmt::format(
      "{}: {} of {} frames have an earlier time than the one before: they are differences, it seems (candump "
      "-td), which tell no times: log with `candump -L`, or `candump -ta`",
      name_, timesBack_, times_);
}

}  // namespace strainfinger::can
