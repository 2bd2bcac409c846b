#pragma once
// How much there is of something a second.

#include <array>
#include <cstdint>
#include <numeric>

namespace strainfinger::live {

/// Adds up what comes over one second, in tenths: the second that ended with the last whole tenth. Times are
/// in microseconds, of any origin, and don't go back.
class RateMeter {
 public:
  void add(std::int64_t time_us, std::uint64_t amount = 1) {
    forget(time_us);
    tenths_[placeOf(tenth_)] += amount;
  }

  std::uint64_t perSecond(std::int64_t now_us) {
    forget(now_us);
    return std::accumulate(tenths_.begin(), tenths_.end(), std::uint64_t{0}) - tenths_[placeOf(tenth_)];
  }

 private:
  static constexpr std::int64_t kTenth_us = 100'000;

  std::size_t placeOf(std::int64_t tenth) const { return static_cast<std::size_t>(tenth) % tenths_.size(); }

  /// Empties the tenths between the last one and that of `time_us`, which is the last one then.
  void forget(std::int64_t time_us) {
    const std::int64_t tenth = time_us / kTenth_us;
    if (tenth - tenth_ > static_cast<std::int64_t>(tenths_.size())) {
      tenths_.fill(0);
      tenth_ = tenth;
    }
    while (tenth_ < tenth) tenths_[placeOf(++tenth_)] = 0;
  }

  std::array<std::uint64_t, 11> tenths_{};  ///< the ten of a second, and the present one
  std::int64_t tenth_ = 0;                  ///< the present one, counted from time 0
};

}  // namespace strainfinger::live
