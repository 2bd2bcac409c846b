#include "firmware/core/signal.hpp"

namespace strainfinger::firmware {

std::int16_t scaledStrain(std::int32_t strain_q32, int shift) {
  if (shift <= 0) return saturate<std::int16_t>(std::int64_t{strain_q32} * (std::int64_t{1} << -shift));
  const std::int32_t half = 1 << (shift - 1);
  return saturate<std::int16_t>((std::int64_t{strain_q32} + half) >> shift);
}

Signal windowSignal(std::span<const std::int32_t> strains_q32, int centre, int shift) {
  const int gauges = static_cast<int>(strains_q32.size());
  const auto at = [&](int offset) {
    return scaledStrain(strains_q32[static_cast<std::size_t>(wrapped(centre + offset, gauges))], shift);
  };
  Signal signal{};
  signal[0] = at(0);
  for (int distance = 1; distance <= kWindowReach; ++distance) {
    const auto k = static_cast<std::size_t>(distance);
    signal[k] = saturate<std::int16_t>(at(distance) + at(-distance));
    signal[k + kWindowReach] = saturate<std::int16_t>(at(distance) - at(-distance));
  }
  return signal;
}

Signal mirrored(const Signal& signal, int mirrorSign) {
  Signal result = signal;
  const std::size_t begin = mirrorSign > 0 ? kOdd : 0;
  const std::size_t end = mirrorSign > 0 ? kEnd : kOdd;
  for (std::size_t k = begin; k < end; ++k) result[k] = saturate<std::int16_t>(-std::int32_t{signal[k]});
  return result;
}

std::int32_t energyOf(const Signal& signal) {
  // Sum and difference of a pair each carry its energy twice over, together: 2 (a^2 + b^2).
  std::int64_t twice = 2 * std::int64_t{signal[0]} * signal[0];
  for (std::size_t k = 1; k < kEnd; ++k) twice += std::int64_t{signal[k]} * signal[k];
  return static_cast<std::int32_t>(twice >> 3);
}

}  // namespace strainfinger::firmware
