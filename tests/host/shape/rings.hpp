#pragma once
// Fingers whose rings can tell shapes, and readings of theirs made another way than the estimator's.

#include <Eigen/Core>
#include <cmath>
#include <numbers>
#include <optional>

#include "host/config/finger_config.hpp"
#include "host/model/impulse_response.hpp"
#include "host/shape/touch_model.hpp"

namespace strainfinger::testing {

inline constexpr double kSurface_m = 12.7e-3;

/// The default finger, perfect, but for alpha = r_a / r_b and the number of gauges, 0.5 mm above the core.
inline config::FingerConfig ringOf(double alpha, int gauges) {
  config::FingerConfig config;
  config.finger.core_radius_m = alpha * kSurface_m;
  config.gauges.radius_m = config.finger.core_radius_m + 0.5e-3;
  config.gauges.count = gauges;
  config.gauges.model_error = 0;
  return config;
}

/// The same finger with gauges off the drawing by up to a degree and 50 um.
inline config::FingerConfig asBuilt(config::FingerConfig config) {
  for (int i = 0; i < config.gauges.count; ++i) {
    config.calibration.angle_offset_deg.push_back(std::sin(7.0 * i));
    config.calibration.depth_offset_m.push_back(5e-5 * std::cos(5.0 * i));
  }
  return config;
}

/// Strain of the gauge below a line load of 1 N/m: what noise is measured in.
inline double peakStrain(const config::FingerConfig& config) {
  return std::abs(
      model::ImpulseResponse(config.finger.annulus(), config.gauges.radius_m, config.gauges.component)
          .at(0)
          .normal);
}

/// What gauges of gain 1, where the calibration has them, read of an elliptic pressure and shear: line loads
/// at Chebyshev's nodes, which the weight sqrt(1 - t^2) makes exact for polynomials. No Bessel function, no
/// series of the estimator.
inline Eigen::VectorXd ellipseStrains(const config::FingerConfig& config, const shape::Touch& touch) {
  constexpr int kNodes = 60;
  Eigen::VectorXd strains = Eigen::VectorXd::Zero(config.gauges.count);
  std::optional<model::ImpulseResponse> line;
  for (int i = 0; i < config.gauges.count; ++i) {
    const model::PlacedGauge gauge = config.calibrated(i);
    if (i == 0 || gauge.radius_m != config.calibrated(i - 1).radius_m)
      line.emplace(config.finger.annulus(), gauge.radius_m, config.gauges.component,
                   config.gauges.arc_length_m);
    for (int k = 1; k <= kNodes; ++k) {
      const double turn = std::numbers::pi * k / (kNodes + 1), sine = std::sin(turn);
      const double share = 2 * sine * sine / (kNodes + 1);
      const double place_rad = touch.angle_rad + 2 * std::sqrt(touch.moment_rad2) * std::cos(turn);
      const auto response = line->at(gauge.angle_rad - place_rad);
      strains[i] +=
          share * (touch.normal_n_per_m * response.normal + touch.tangential_n_per_m * response.tangential);
    }
  }
  return strains;
}

}  // namespace strainfinger::testing
