#include "host/tables/window_fit.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

namespace strainfinger::tables {
namespace {

WindowMatrix masked(const WindowMatrix& matrix, const GaugeMask& mask) {
  WindowMatrix result = matrix;
  for (int k = 0; k < kWindowGauges; ++k) {
    if (!mask[static_cast<std::size_t>(k)]) result.row(k).setZero();
  }
  return result;
}

/// |d(remaining strain)/d(offset)| for unit normal load and the least favourable direction in the cone.
double worstSensitivity(const WindowFit& fit, double cone) {
  // With three gauges the gradient has rank 1: its length is |b1 + b2 rho| for loads (1, rho), least at an
  // end of the cone or where it crosses zero inside.
  const Eigen::Matrix2d loadToBasis = fit.amplitude.inverse();
  const WindowVector normal = fit.gradient * loadToBasis.col(0);
  const WindowVector tangential = fit.gradient * loadToBasis.col(1);
  const WindowVector plus = normal + cone * tangential;
  const WindowVector minus = normal - cone * tangential;
  if (plus.dot(minus) <= 0) return 0;
  return std::min(plus.norm(), minus.norm());
}

}  // namespace

WindowResponse windowResponse(const model::ImpulseResponse& response, int gaugeCount, double offset_pitch,
                              double unit) {
  const double pitch_rad = 2 * std::numbers::pi / gaugeCount;
  WindowResponse window;
  for (int k = 0; k < kWindowGauges; ++k) {
    const auto value = response.at((k - kWindowReach - offset_pitch) * pitch_rad);
    window.value.row(k) << value.normal / unit, value.tangential / unit;
    window.slope.row(k) << -value.normalSlope * pitch_rad / unit, -value.tangentialSlope * pitch_rad / unit;
  }
  return window;
}

WindowFit windowFit(const WindowResponse& response, const GaugeMask& mask) {
  const WindowMatrix value = masked(response.value, mask);
  const WindowMatrix slope = masked(response.slope, mask);
  const double r11 = value.col(0).norm();
  const WindowVector first = value.col(0) / r11;
  const double r12 = first.dot(value.col(1));
  const WindowVector rest = value.col(1) - r12 * first;
  const double r22 = rest.norm();

  WindowFit fit;
  fit.basis << first, rest / r22;
  fit.amplitude << 1 / r11, -r12 / (r11 * r22), 0, 1 / r22;
  const WindowMatrix slopePerAmplitude = slope * fit.amplitude;
  const Eigen::Matrix2d along = fit.basis.transpose() * slopePerAmplitude;
  fit.gradient = slopePerAmplitude - fit.basis * along;
  fit.amplitude_slope = -fit.amplitude * along;
  return fit;
}

GaugeMask bestTriple(const WindowResponse& response, double cone) {
  GaugeMask best{};
  double bestSensitivity = -1;
  for (unsigned bits = 0; bits < (1u << kWindowGauges); ++bits) {
    GaugeMask mask{};
    for (std::size_t k = 0; k < mask.size(); ++k) mask[k] = (bits >> k) & 1;
    if (std::count(mask.begin(), mask.end(), true) != 3) continue;
    const double sensitivity = worstSensitivity(windowFit(response, mask), cone);
    if (sensitivity > bestSensitivity) {
      best = mask;
      bestSensitivity = sensitivity;
    }
  }
  return best;
}

}  // namespace strainfinger::tables
