#pragma once
// The analog-digital converter: strain to code and its noise budget.

#include <cstdint>

#include "host/config/finger_config.hpp"

namespace strainfinger::simulation {

/// A converter of 8 to 16 bits over +-full scale, codes as hal/gauge_adc.hpp wants them.
class Converter {
 public:
  explicit Converter(const config::Gauges& gauges)
      : fullScale_strain_(gauges.full_scale_strain),
        step_strain_(gauges.step_strain()),
        bits_(gauges.adc_bits) {}

  /// The nearest code, left-justified to 16 bits; beyond the ends, the rail. NaN gives the lower rail.
  std::uint16_t codeOf(double strain) const;
  /// The strain in the middle of a code's interval.
  double strainOf(std::uint16_t code) const;

 private:
  double fullScale_strain_;
  double step_strain_;
  int bits_;
};

/// The standard deviation of the noise before the converter that makes, with the step^2/12 of quantisation,
/// the noise_strain of a reading; 0 when quantisation alone is more, as in no config that was read.
double analogNoise_strain(const config::Gauges& gauges);

}  // namespace strainfinger::simulation
