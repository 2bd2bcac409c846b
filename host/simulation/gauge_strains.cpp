#include "host/simulation/gauge_strains.hpp"

#include <algorithm>

namespace strainfinger::simulation {
namespace {

constexpr double kTolerance = 1e-9;  ///< of the peak: four orders below a step of a 16-bit converter

}  // namespace

model::TouchLoad loadOf(const Touch& touch, const config::Contact& contact, double outerRadius_m) {
  const model::Profile profile = touch.width_m ? touch.profile : model::Profile::kUniform;
  const double width_m = touch.width_m.value_or(contact.width_m.value_or(0));
  return {touch.normal_n_per_m, touch.tangential_n_per_m, model::momentOf(profile, width_m / outerRadius_m),
          profile, contact.friction_coefficient};
}

GaugeStrains::GaugeStrains(const config::FingerConfig& config) : GaugeStrains(config, builtFinger(config)) {}

GaugeStrains::GaugeStrains(const config::FingerConfig& config, const BuiltFinger& built)
    : contact_(config.contact),
      outerRadius_m_(built.annulus.outer_radius_m),
      ring_(built.annulus, built.gauges, config.gauges.component, config.gauges.arc_length_m, kTolerance),
      drawn_(built.annulus, config.gauges.radius_m, config.gauges.component, config.gauges.arc_length_m, 0,
             kTolerance) {}

model::LoadSpectrum GaugeStrains::spectrumOf(const Touch& touch) const {
  return trueSpectrum(loadOf(touch, contact_, outerRadius_m_),
                      std::max(ring_.harmonics(), drawn_.harmonics()));
}

Eigen::VectorXd GaugeStrains::readings(std::span<const Touch> touches) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(count());
  for (const Touch& touch : touches) sum += ring_.under(spectrumOf(touch), touch.angle_rad).strains;
  return sum;
}

Strains GaugeStrains::under(std::span<const Touch> touches) const {
  const Eigen::VectorXd read = readings(touches);
  Strains strains{};
  for (int i = 0; i < count(); ++i) strains[static_cast<std::size_t>(i)] = read[i] / gain(i);
  return strains;
}

double GaugeStrains::at(double angle_rad, std::span<const Touch> touches) const {
  double strain = 0;
  for (const Touch& touch : touches)
    strain += drawn_.under(spectrumOf(touch), angle_rad - touch.angle_rad).strain;
  return strain;
}

}  // namespace strainfinger::simulation
