#include "firmware/core/noise_meter.hpp"

#include "firmware/core/detect.hpp"

namespace strainfinger::firmware {
namespace {

/// What configured noise and the gate's rounding leave on average [gate energy]. Of any tables below 2^64.
std::uint64_t configuredEnergy(const TableConstants& constants) {
  constexpr int kMostUp = 25, kMostDown = 63;
  const int up = constants.noise_variance_exponent - 2 * constants.gate_shift;
  const std::uint64_t twice = std::uint64_t{constants.noise_variance} << 1;
  const std::uint64_t variance_q1 =
      up >= 0 ? twice << std::min(up, kMostUp) : twice >> std::min(-up, kMostDown);
  return std::max<std::uint64_t>(constants.gauge_count * (variance_q1 + 1) / 2, 1);
}

constexpr std::uint32_t kConfigured_q8 = 1 << 8;  ///< what configured noise makes of a comparison

}  // namespace

void NoiseMeter::compare(const TableConstants& constants, std::span<const std::int32_t> strains_q32,
                         GaugeSet gauges) {
  std::array<std::int32_t, kMaxGauges> change;
  for (std::size_t i = 0; i < strains_q32.size(); ++i)
    change[i] = contains(gauges, static_cast<int>(i)) ? (strains_q32[i] - before_q32_[i]) / 2 : 0;
  const std::uint32_t energy = gateEnergy(constants, std::span(change).first(strains_q32.size()));
  // Halved changes of configured noise have half the energy of the noise itself.
  const std::uint64_t ratio_q8 = (std::uint64_t{energy} << 9) / configuredEnergy(constants);
  const auto now_q8 = static_cast<std::uint32_t>(std::min<std::uint64_t>(ratio_q8, kLoudest_q8));
  const auto [less_q8, more_q8] = std::minmax(recent_q8_[0], recent_q8_[1]);
  const std::uint32_t median_q8 = std::clamp(recent_q8_[2], less_q8, more_q8);
  const std::uint32_t counted_q8 = std::min(now_q8, kMostGrowth * std::max(median_q8, kConfigured_q8));
  recent_q8_ = {now_q8, recent_q8_[0], recent_q8_[1]};
  const std::int32_t change_q8 = static_cast<std::int32_t>(counted_q8) - static_cast<std::int32_t>(mean_q8_);
  mean_q8_ += static_cast<std::uint32_t>(change_q8 >> kMemory);
}

}  // namespace strainfinger::firmware
