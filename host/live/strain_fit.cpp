#include "host/live/strain_fit.hpp"

#include <cmath>
#include <numbers>

namespace strainfinger::live {
namespace {

/// A finger that is told of is the drawing and its calibration.
config::FingerConfig asTold(config::FingerConfig config) {
  config.as_built = {};
  return config;
}

double orZero(double value) { return std::isnan(value) ? 0 : value; }

bool isKnown(const can::ContactReport& contact) {
  return !std::isnan(contact.angle_deg) && !std::isnan(contact.normal_n);
}

}  // namespace

StrainFit::StrainFit(const config::FingerConfig& config)
    : length_m_(config.finger.length_m), strains_(asTold(config)) {}

std::vector<double> StrainFit::readings(const can::TouchReport& touch) const {
  std::vector<simulation::Touch> touches;
  if (isKnown(touch)) touches.push_back(touchOf(touch, touch.width_m));
  if (touch.second && isKnown(*touch.second)) touches.push_back(touchOf(*touch.second, 0));
  const Eigen::VectorXd readings = strains_.readings(touches);
  return {readings.begin(), readings.end()};
}

simulation::Touch StrainFit::touchOf(const can::ContactReport& contact, double width_m) const {
  return {.angle_rad = contact.angle_deg * std::numbers::pi / 180,
          .normal_n_per_m = contact.normal_n / length_m_,
          .tangential_n_per_m = orZero(contact.tangential_n) / length_m_,
          .width_m = orZero(width_m),
          .profile = model::Profile::kUniform};
}

}  // namespace strainfinger::live
