#pragma once
// How often memory may be erased, so that no sequence of requests wears it out.

#include <algorithm>
#include <cstdint>

#include "common/frames.hpp"

namespace strainfinger::firmware {

/// A few erases at once, then one a minute. A page of flash lasts 10,000 erases (DS12589): a bus that asks
/// for one whenever it may takes 1,440 a day; those for settings are spread over all their pages. Seconds
/// count from the start.
class EraseBudget {
 public:
  static constexpr std::uint32_t kBurst = 4;
  static constexpr std::uint32_t kPeriod_s = 60;

  /// `left`: erases that are allowed at once, at most kBurst.
  constexpr explicit EraseBudget(std::uint32_t left = kBurst) : paidUntil_s_((kBurst - left) * kPeriod_s) {}

  /// Of a start for this reason: what resets a board over the bus, or again and again, is no way round it.
  static constexpr EraseBudget after(ResetCause cause) {
    const bool isByHand = cause == ResetCause::kPowerOn || cause == ResetCause::kPin;
    return EraseBudget(isByHand || cause == ResetCause::kBrownOut ? kBurst : 0);
  }

  /// Until the next erase is allowed; 0: now.
  constexpr std::uint32_t wait_s(std::uint32_t now_s) const {
    const std::uint32_t latest_s = now_s + (kBurst - 1) * kPeriod_s;
    return paidUntil_s_ > latest_s ? paidUntil_s_ - latest_s : 0;
  }

  constexpr void spend(std::uint32_t now_s) { paidUntil_s_ = std::max(paidUntil_s_, now_s) + kPeriod_s; }

 private:
  std::uint32_t paidUntil_s_;  ///< when the erases so far are paid for, at one a period
};

}  // namespace strainfinger::firmware
