#include "host/simulation/converter.hpp"

#include <fmt/format.h>

#include <cmath>

#include "host/base/failure.hpp"

namespace strainfinger::simulation {
namespace {

constexpr int kCodeBits = 16;
constexpr double kMidScale = 0x8000;

}  // namespace

double Converter::step_strain() const { return 2 * std::ldexp(fullScale_strain_, -bits_); }

std::uint16_t Converter::codeOf(double strain) const {
  const double code = std::floor((strain + fullScale_strain_) / step_strain() + 0.5);
  const double top = std::ldexp(1.0, bits_) - 1;
  if (!(code > 0)) return 0;
  return static_cast<std::uint16_t>(static_cast<std::uint32_t>(std::fmin(code, top)) << (kCodeBits - bits_));
}

double Converter::strainOf(std::uint16_t code) const {
  return (code - kMidScale) / kMidScale * fullScale_strain_;
}

double analogNoise_strain(const config::Gauges& gauges) {
  const double quantisation = Converter(gauges).step_strain() / std::sqrt(12.0);
  const double variance = gauges.noise_strain * gauges.noise_strain - quantisation * quantisation;
  if (variance >= 0) return std::sqrt(variance);
  throw Failure(
      ExitCode::kUsage,
      fmt::format("gauges.noise_strain = {} is less than the quantisation alone, {:.3g}, that "
                  "gauges.adc_bits = {} over "
                  "+-gauges.full_scale_strain = {} leaves; use more bits, a smaller full scale or more noise",
                  gauges.noise_strain, quantisation, gauges.adc_bits, gauges.full_scale_strain));
}

}  // namespace strainfinger::simulation
