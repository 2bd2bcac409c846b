#pragma once
// A ring of gauges and its converter, touched by a scenario: the backend of hal::GaugeAdc for this machine.

#include <cstdint>
#include <vector>

#include "hal/gauge_adc.hpp"
#include "host/config/finger_config.hpp"
#include "host/simulation/converter.hpp"
#include "host/simulation/gauge_fault.hpp"
#include "host/simulation/gauge_strains.hpp"
#include "host/simulation/noise.hpp"
#include "host/simulation/scenario.hpp"
#include "host/simulation/simulated_clock.hpp"

namespace strainfinger::simulation {

/// What makes one ring different from the next. The spreads are standard deviations over its gauges.
struct RingOptions {
  std::uint64_t seed = 1;
  double zeroSpread_strain = 0;
  std::vector<GaugeFault> faults = {};
};

/// Converts a sample set every kSamplePeriod_us of the clock, the first one a period after the clock's start.
/// Set k is a function of the options, the config, the scenario and k alone, whatever was read before.
/// `clock` must outlive it.
class SimulatedGauges {
 public:
  static constexpr std::uint64_t kSamplePeriod_us = 1000;
  static constexpr std::uint64_t kBuffers = 2;  ///< sets that wait to be read, as in a double-buffered DMA

  /// Throws Failure(kUsage) when a fault is of a gauge that the ring doesn't have.
  SimulatedGauges(const config::FingerConfig& config, Scenario scenario, const SimulatedClock& clock,
                  const RingOptions& options = {});

  bool read(hal::SampleSet& set) noexcept;
  std::uint32_t overruns() const noexcept { return static_cast<std::uint32_t>(overruns_ + missed()); }
  std::uint32_t resynchronisations() const noexcept { return 0; }

  /// When the last set read was converted, and what touched the ring then.
  double sampleTime_s() const;
  std::vector<Touch> truth() const { return scenario_.at(sampleTime_s()); }

  const GaugeStrains& strains() const { return strains_; }

 private:
  std::uint64_t waiting() const noexcept;
  std::uint64_t missed() const noexcept;  ///< sets waiting that have no buffer any more
  hal::SampleSet convert() const;
  std::uint16_t codeOf(std::uint64_t sample, std::uint32_t gauge, double strain, double noisier) const;
  std::uint16_t failed(const GaugeFault& fault, double strain) const;
  double timeOf_s(std::uint64_t sample) const;

  Scenario scenario_;
  const SimulatedClock& clock_;
  GaugeStrains strains_;
  Converter converter_;
  Noise noise_;
  double noise_strain_;
  std::vector<GaugeFault> faults_;
  Strains zero_strain_{};
  Strains gain_{};
  std::uint64_t sample_ = 0;    ///< the last one read or dropped
  std::uint64_t overruns_ = 0;  ///< up to the last read
};

static_assert(hal::GaugeAdc<SimulatedGauges>);

}  // namespace strainfinger::simulation
