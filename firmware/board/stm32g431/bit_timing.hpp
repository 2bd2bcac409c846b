#pragma once
// CAN bit timing, computed when compiling: how a bit is cut into quanta of the controller's clock.
//
//   |sync|------- segment1 -------|- segment2 -|      sample point between the segments
//     1

#include <algorithm>
#include <array>
#include <cstdint>
#include <optional>

namespace strainfinger::stm32g431 {

/// One bit takes 1 + segment1 + segment2 quanta of `prescaler` clocks each.
struct BitTiming {
  std::uint16_t prescaler = 0;
  std::uint16_t segment1 = 0;  ///< propagation and phase segment 1
  std::uint16_t segment2 = 0;
  std::uint16_t jump = 0;  ///< quanta by which a bit is stretched or shortened to follow the others
  bool operator==(const BitTiming&) const = default;

  constexpr std::uint32_t quanta() const { return 1U + segment1 + segment2; }
  constexpr std::uint32_t samplePoint_permille() const { return 1000 * (1U + segment1) / quanta(); }
};

/// Largest values that fit the registers.
struct TimingLimits {
  std::uint16_t prescaler, segment1, segment2, jump;
};
inline constexpr TimingLimits kNominalLimits{512, 256, 128, 128};  ///< NBTP, RM0440 section 44.4.7
inline constexpr TimingLimits kDataLimits{32, 32, 16, 16};         ///< DBTP, RM0440 section 44.4.3

/// How far the true bit rate is from the wanted one.
constexpr std::uint32_t rateError_ppm(const BitTiming& timing, std::uint32_t clock_hz,
                                      std::uint32_t bitRate) {
  const std::uint64_t wanted = std::uint64_t{bitRate} * timing.prescaler * timing.quanta();
  const std::uint64_t difference = wanted > clock_hz ? wanted - clock_hz : clock_hz - wanted;
  return static_cast<std::uint32_t>(1'000'000 * difference / wanted);
}

/// How far each node's clock may be off so that nodes still understand each other: the smaller of the two
/// bounds of ISO 11898-1 (resynchronisation over 10 bits; 13 bits to the end of an error flag).
constexpr std::uint32_t clockTolerance_ppm(const BitTiming& timing) {
  const std::uint64_t quanta = timing.quanta();
  const std::uint64_t phase = std::min(timing.segment1, timing.segment2);
  const std::uint64_t byJump = 1'000'000ULL * timing.jump / (20 * quanta);
  const std::uint64_t byPhase = 1'000'000ULL * phase / (2 * (13 * quanta - timing.segment2));
  return static_cast<std::uint32_t>(std::min(byJump, byPhase));
}

inline constexpr std::uint32_t kSmallestSamplePoint_permille = 800;
inline constexpr std::uint32_t kLargestSamplePoint_permille = 875;

/// The timing nearest to the bit rate, of those the one with the most quanta, sampled as soon after 80 % as
/// it can be: that leaves most room for clocks that differ. None: no timing of this rate has its sample point
/// in 80 .. 87.5 %.
constexpr std::optional<BitTiming> bitTiming(std::uint32_t clock_hz, std::uint32_t bitRate,
                                             const TimingLimits& limits = kNominalLimits) {
  std::optional<BitTiming> best;
  for (std::uint32_t prescaler = 1; prescaler <= limits.prescaler; ++prescaler) {
    const std::uint32_t perQuantum = prescaler * bitRate;
    const std::uint32_t quanta = (clock_hz + perQuantum / 2) / perQuantum;
    const std::uint32_t segment2 = quanta / 5;
    if (segment2 < 1 || segment2 > limits.segment2 || quanta - 1 - segment2 > limits.segment1) continue;
    const BitTiming timing{static_cast<std::uint16_t>(prescaler),
                           static_cast<std::uint16_t>(quanta - 1 - segment2),
                           static_cast<std::uint16_t>(segment2),
                           static_cast<std::uint16_t>(std::min<std::uint32_t>(segment2, limits.jump))};
    if (timing.samplePoint_permille() > kLargestSamplePoint_permille) continue;
    if (!best || rateError_ppm(timing, clock_hz, bitRate) < rateError_ppm(*best, clock_hz, bitRate))
      best = timing;
  }
  return best;
}

/// Whether nodes with this timing, each from a clock that may be off by `clock_ppm`, understand each other.
constexpr bool isInTolerance(const std::optional<BitTiming>& timing, std::uint32_t clock_hz,
                             std::uint32_t bitRate, std::uint32_t clock_ppm) {
  return timing && timing->samplePoint_permille() >= kSmallestSamplePoint_permille &&
         timing->samplePoint_permille() <= kLargestSamplePoint_permille &&
         rateError_ppm(*timing, clock_hz, bitRate) + clock_ppm <= clockTolerance_ppm(*timing);
}

/// A timing that is known to be in tolerance: anything else doesn't compile.
template <std::uint32_t kClock_hz, std::uint32_t kBitRate, std::uint32_t kClock_ppm,
          TimingLimits kLimits = kNominalLimits>
consteval BitTiming checkedBitTiming() {
  constexpr std::optional<BitTiming> timing = bitTiming(kClock_hz, kBitRate, kLimits);
  static_assert(isInTolerance(timing, kClock_hz, kBitRate, kClock_ppm),
                "no timing of this bit rate from this clock is in tolerance");
  return *timing;
}

}  // namespace strainfinger::stm32g431
