#pragma once
// The elastic model of a config, for oracles that work from its values alone.

#include <Eigen/Dense>
#include <array>
#include <numbers>

#include "common/table_image.hpp"
#include "host/config/finger_config.hpp"
#include "host/model/impulse_response.hpp"

namespace strainfinger::tables {

inline model::ImpulseResponse responseOf(const config::FingerConfig& config) {
  return {config.finger.annulus(), config.gauges.radius_m, config.gauges.component,
          config.gauges.arc_length_m, config.contact.width_m.value_or(0)};
}

using OracleMatrix = Eigen::Matrix<double, kWindowGauges + 1, 2>;

/// The responses of a window's gauges, and of their outer pair (rows; those not in `mask` are zero), to a
/// normal and a tangential load of 1 N/m at an offset from the middle one.
inline OracleMatrix oracleResponse(const model::ImpulseResponse& response, int gauges, double offset_pitch,
                                   const std::array<bool, kWindowGauges + 1>& mask) {
  OracleMatrix matrix = OracleMatrix::Zero();
  for (int k = 0; k < kWindowGauges; ++k) {
    if (!mask[static_cast<std::size_t>(k)]) continue;
    const auto value = response.at((k - 3 - offset_pitch) * 2 * std::numbers::pi / gauges);
    matrix.row(k) << value.normal, value.tangential;
  }
  if (gauges > 16 && mask[kWindowGauges]) {
    const auto plus = response.at((4 - offset_pitch) * 2 * std::numbers::pi / gauges);
    const auto minus = response.at((-4 - offset_pitch) * 2 * std::numbers::pi / gauges);
    matrix.row(kWindowGauges) << plus.normal - minus.normal, plus.tangential - minus.tangential;
    matrix.row(kWindowGauges) /= std::numbers::sqrt2;
  }
  return matrix;
}

/// Derivative of a function of the offset, by central differences of fourth order: an error of 1e-10 by
/// rounding, and much the same by the step, for functions of the size of 1 with features a pitch wide.
template <typename Function>
auto derivative(const Function& f, double offset_pitch) {
  constexpr double h = 3e-4;
  const auto near = (f(offset_pitch + h) - f(offset_pitch - h)).eval();
  const auto far = (f(offset_pitch + 2 * h) - f(offset_pitch - 2 * h)).eval();
  return ((8 * near - far) / (12 * h)).eval();
}

}  // namespace strainfinger::tables
