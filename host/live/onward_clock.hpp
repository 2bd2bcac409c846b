#pragma once
// Times of a clock that somebody may set back, as those of one that never goes back.

#include <algorithm>
#include <cstdint>
#include <limits>

namespace strainfinger::live {

/// Give it the times as they come [us, of any origin]. Where they go back by more than frames do that come in
/// another order than they were stamped in, they go on from the last: what is worked out of two of them (how
/// long a finger has been silent, what came in a second) would be wrong for as long as the step otherwise. By
/// so much it is ahead of the clock that was set back, until that is set forward again. A step ahead it takes
/// part in: it can't be told from a time in which nothing came.
class OnwardClock {
 public:
  /// Not before what it said last.
  std::int64_t at(std::int64_t time_us) {
    if (time_us >= last_us_)
      offset_us_ = 0;
    else if (last_us_ - time_us - offset_us_ > kDisorder_us)
      offset_us_ = last_us_ - time_us;
    return last_us_ = std::max(last_us_, time_us + offset_us_);
  }

 private:
  static constexpr std::int64_t kDisorder_us = 500'000;
  std::int64_t last_us_ = std::numeric_limits<std::int64_t>::min();
  std::int64_t offset_us_ = 0;  ///< to be added to what it is given
};

}  // namespace strainfinger::live
