#pragma once
// How the gauges are sampled, and the proof that it fits the time there is.

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/board/stm32g431/clock_tree.hpp"

namespace strainfinger::stm32g431 {

/// Two converters, so many conversions each to a sample set.
inline constexpr std::uint32_t kPairs = 8;
inline constexpr std::uint32_t kGauges = 2 * kPairs;

/// The converters' clock. The datasheet's limit for two converters at once is 26 to 52 MHz, by its revision,
/// range and supply: this is within all of them.
inline constexpr std::uint32_t kAdc_hz = kCore_hz / 8;
static_assert(kAdc_hz <= 26'000'000);

/// Time for a channel's voltage to settle, in the numbers of SMPR (RM0440 section 21.4.12).
enum class SampleTime : std::uint8_t { k2_5 = 0, k6_5 = 1, k12_5 = 2, k24_5 = 3 };
inline constexpr std::array<std::uint32_t, 4> kSampleHalfCycles{5, 13, 25, 49};
inline constexpr std::uint32_t kConversionHalfCycles = 25;  ///< 12 bits

struct SamplingPlan {
  std::uint32_t rate_hz;
  std::uint32_t oversamplingLog2;  ///< each code is the sum of 2^this conversions, 4 .. 8, scaled to 16 bits
  SampleTime sampleTime;

  /// From the trigger until the last gauge is converted, latency of the trigger (3 cycles) included.
  constexpr std::uint32_t busy_ns() const {
    const std::uint32_t half =
        kSampleHalfCycles[static_cast<std::size_t>(sampleTime)] + kConversionHalfCycles;
    const std::uint64_t halfCycles = (std::uint64_t{kPairs} << oversamplingLog2) * half + 6;
    return static_cast<std::uint32_t>(halfCycles * 500'000'000 / kAdc_hz + 1);
  }
  constexpr std::uint32_t period_us() const { return 1'000'000 / rate_hz; }

  /// Fits its period with 2 % to spare, and never leaves the converters idle for 1 ms: the next result would
  /// be off (errata ES0431, "wrong ADC result if conversion done late").
  constexpr bool isPossible() const {
    const std::uint64_t period_ns = std::uint64_t{1000} * period_us();
    return 1'000'000 % rate_hz == 0 && oversamplingLog2 >= 4 && oversamplingLog2 <= 8 &&
           std::uint64_t{busy_ns()} * 100 <= period_ns * 98 && period_ns - busy_ns() < 1'000'000;
  }
};

/// The plan for a rate: the longest time to settle that fits; then the most conversions a code that take half
/// of the period, so that a set is young when it is there, or the fewest that fit. None: nothing fits.
constexpr std::optional<SamplingPlan> samplingAt(std::uint32_t rate_hz) {
  if (rate_hz == 0 || 1'000'000 % rate_hz != 0) return std::nullopt;
  for (const SampleTime time : {SampleTime::k24_5, SampleTime::k12_5, SampleTime::k6_5, SampleTime::k2_5}) {
    std::optional<SamplingPlan> fitting;
    for (std::uint32_t log2 = 8; log2 >= 4; --log2) {
      const SamplingPlan plan{rate_hz, log2, time};
      if (!plan.isPossible()) continue;
      fitting = plan;
      if (plan.busy_ns() <= plan.period_us() * 500) break;
    }
    if (fitting) return fitting;
  }
  return std::nullopt;
}

/// 446 us of 1000. 32 conversions a code, 1.2 us for the voltage to settle.
inline constexpr SamplingPlan kDefaultSampling = *samplingAt(1000);
static_assert(kDefaultSampling.busy_ns() == 445'883 && kDefaultSampling.sampleTime == SampleTime::k24_5);

/// 90 us of 100. 16 conversions a code, 0.12 us to settle: for gauges behind an amplifier at the pin.
inline constexpr SamplingPlan kFastSampling = *samplingAt(10'000);
static_assert(kFastSampling.busy_ns() == 90'495 && kFastSampling.sampleTime == SampleTime::k2_5);

}  // namespace strainfinger::stm32g431
