#include "host/simulation/gauge_strains.hpp"

namespace strainfinger::simulation {
namespace {

constexpr double kTolerance = 1e-9;  ///< of the peak: four orders below a step of a 16-bit converter

}  // namespace

GaugeStrains::GaugeStrains(const config::FingerConfig& config)
    : gauges_(config.gauges),
      response_(config.finger.annulus(), gauges_.radius_m, gauges_.component, gauges_.arc_length_m,
                config.contact.width_m.value_or(0), kTolerance) {}

Strains GaugeStrains::under(std::span<const Touch> touches) const {
  Strains strains{};
  if (touches.empty()) return strains;
  for (int gauge = 0; gauge < gauges_.count; ++gauge)
    strains[static_cast<std::size_t>(gauge)] = at(gaugeAngle_rad(gauge), touches);
  return strains;
}

double GaugeStrains::at(double angle_rad, std::span<const Touch> touches) const {
  double strain = 0;
  for (const Touch& touch : touches) {
    const auto response = response_.at(angle_rad - touch.angle_rad);
    strain += touch.normal_n_per_m * response.normal + touch.tangential_n_per_m * response.tangential;
  }
  return strain;
}

double GaugeStrains::gaugeAngle_rad(int gauge) const { return gauges_.angle_rad(gauge); }

}  // namespace strainfinger::simulation
