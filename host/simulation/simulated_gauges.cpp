#include "host/simulation/simulated_gauges.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace strainfinger::simulation {

SimulatedGauges::SimulatedGauges(const config::FingerConfig& config, Scenario scenario,
                                 const SimulatedClock& clock, const RingOptions& options)
    : scenario_(std::move(scenario)),
      clock_(clock),
      strains_(config),
      converter_(config.gauges),
      noise_(options.seed),
      noise_strain_(analogNoise_strain(config.gauges)),
      faults_(options.faults) {
  requireGauges(faults_, config.gauges.count);
  const Noise ring(~options.seed);
  for (std::uint32_t gauge = 0; gauge < kMaxGauges; ++gauge) {
    zero_strain_[gauge] = options.zeroSpread_strain * ring.at(0, gauge);
    const int index = static_cast<int>(gauge);
    gain_[gauge] = index < strains_.count() ? strains_.gain(index) : 1;
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
  for (std::uint32_t gauge = 0; gauge < static_cast<std::uint32_t>(strains_.count()); ++gauge)
    codes[gauge] = codeOf(sample_, gauge, strains[gauge], 1);
  for (const GaugeFault& fault : faults_)
    if (sampleTime_s() >= fault.start_s) codes[fault.gauge] = failed(fault, strains[fault.gauge]);
  return codes;
}

std::uint16_t SimulatedGauges::codeOf(std::uint64_t sample, std::uint32_t gauge, double strain,
                                      double noisier) const {
  const double noise = noisier * noise_strain_ * noise_.at(sample, gauge);
  return converter_.codeOf(gain_[gauge] * strain + zero_strain_[gauge] + noise);
}

std::uint16_t SimulatedGauges::failed(const GaugeFault& fault, double strain) const {
  switch (fault.kind) {
    case GaugeFault::Kind::kDead:
      return codeOf(sample_, fault.gauge, 0, 1);
    case GaugeFault::Kind::kOpen:
      return converter_.codeOf(std::numeric_limits<double>::infinity());
    case GaugeFault::Kind::kShort:
      return converter_.codeOf(-std::numeric_limits<double>::infinity());
    case GaugeFault::Kind::kNoisy:
      return codeOf(sample_, fault.gauge, strain, GaugeFault::kNoisier);
    case GaugeFault::Kind::kStuck:
      break;
  }
  const auto since = static_cast<std::uint64_t>(std::ceil(fault.start_s / timeOf_s(1)));
  return codeOf(since, fault.gauge, strains_.under(scenario_.at(timeOf_s(since)))[fault.gauge], 1);
}

double SimulatedGauges::timeOf_s(std::uint64_t sample) const {
  return static_cast<double>(sample * kSamplePeriod_us) * 1e-6;
}

double SimulatedGauges::sampleTime_s() const { return timeOf_s(sample_); }

}  // namespace strainfinger::simulation
