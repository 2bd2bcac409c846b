#include "host/simulation/strain_fit.hpp"

#include <cmath>

#include "host/base/angles.hpp"

namespace strainfinger::simulation {
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
  const Eigen::VectorXd readings = strains_.readings(touchesOf(touch));
  return {readings.begin(), readings.end()};
}

double StrainFit::at(double angle_rad, const can::TouchReport& touch) const {
  return strains_.at(angle_rad, touchesOf(touch));
}

std::vector<Touch> StrainFit::touchesOf(const can::TouchReport& report) const {
  std::vector<Touch> touches;
  if (isKnown(report)) touches.push_back(touchOf(report, report.width_m));
  if (report.second && isKnown(*report.second)) touches.push_back(touchOf(*report.second, 0));
  return touches;
}

Touch StrainFit::touchOf(const can::ContactReport& contact, double width_m) const {
  return {.angle_rad = contact.angle_deg * kRadPerDeg,
          .normal_n_per_m = contact.normal_n / length_m_,
          .tangential_n_per_m = orZero(contact.tangential_n) / length_m_,
          .width_m = orZero(width_m),
          .profile = model::Profile::kUniform};
}

}  // namespace strainfinger::simulation
