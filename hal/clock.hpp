#pragma once
// Time, as the firmware sees it.

#include <concepts>
#include <cstdint>

namespace strainfinger::hal {

inline constexpr std::uint32_t kSecond_us = 1'000'000;

/// Contract of a clock: `now_us()` counts microseconds from some start, never goes back, and wraps from
/// 2^32 - 1 to 0. Differences of two readings, as std::uint32_t, are therefore right up to 71 minutes.
// clang-format off
template <typename T>
concept Clock = requires(const T clock) {
  { clock.now_us() }
  noexcept->std::same_as<std::uint32_t>;
};
// clang-format on

}  // namespace strainfinger::hal
