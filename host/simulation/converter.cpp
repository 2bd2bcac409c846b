#include "host/simulation/converter.hpp"

#include <cmath>

namespace strainfinger::simulation {
namespace {

constexpr int kCodeBits = 16;
constexpr double kMidScale = 0x8000;

}  // namespace

std::uint16_t Converter::codeOf(double strain) const {
  const double code = std::floor((strain + fullScale_strain_) / step_strain_ + 0.5);
  const double top = std::ldexp(1.0, bits_) - 1;
  if (!(code > 0)) return 0;
  return static_cast<std::uint16_t>(static_cast<std::uint32_t>(std::fmin(code, top)) << (kCodeBits - bits_));
}

double Converter::strainOf(std::uint16_t code) const {
  return (code - kMidScale) / kMidScale * fullScale_strain_;
}

double analogNoise_strain(const config::Gauges& gauges) {
  const double noise = gauges.noise_strain, quantisation = gauges.quantisation_strain();
  return std::sqrt(std::fmax(noise * noise - quantisation * quantisation, 0));
}

}  // namespace strainfinger::simulation
