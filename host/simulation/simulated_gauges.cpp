#include "host/simulation/simulated_gauges.hpp"

#include <algorithm>

namespace strainfinger::simulation {

SimulatedGauges::SimulatedGauges(const config::FingerConfig& config, Scenario scenario,
                                 const SimulatedClock& clock, const RingOptions& options)
    : scenario_(std::move(scenario)),
      clock_(clock),
      strains_(config),
      converter_(config.gauges),
      noise_(options.seed),
      noise_strain_(analogNoise_strain(config.gauges)) {
  const Noise ring(~options.seed);
  for (std::uint32_t gauge = 0; gauge < kMaxGauges; ++gauge) {
    zero_strain_[gauge] = options.zeroSpread_strain * ring.at(0, gauge);
    gain_[gauge] = 1 + options.gainSpread * ring.at(1, gauge);
  }
}

bool SimulatedGauges::read(hal::SampleSet& set) noexcept {
  if (waiting() == 0) return false;
  const std::uint64_t dropped = missed();
  overruns_ += dropped;
  sample_ += dropped + 1;
  set = convert();
  return true;
}

std::uint64_t SimulatedGauges::waiting() const noexcept {
  return clock_.elapsed_us() / kSamplePeriod_us - sample_;
}

std::uint64_t SimulatedGauges::missed() const noexcept { return std::max(waiting(), kBuffers) - kBuffers; }

hal::SampleSet SimulatedGauges::convert() const {
  const Strains strains = strains_.under(truth());
  hal::SampleSet codes{};
  for (std::uint32_t gauge = 0; gauge < static_cast<std::uint32_t>(strains_.count()); ++gauge) {
    const double noise = noise_strain_ * noise_.at(sample_, gauge);
    codes[gauge] = converter_.codeOf(gain_[gauge] * strains[gauge] + zero_strain_[gauge] + noise);
  }
  return codes;
}

double SimulatedGauges::sampleTime_s() const {
  return static_cast<double>(sample_ * kSamplePeriod_us) * 1e-6;
}

}  // namespace strainfinger::simulation
