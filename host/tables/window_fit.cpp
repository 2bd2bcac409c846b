#include "host/tables/window_fit.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace strainfinger::tables {
namespace {

WindowMatrix masked(const WindowMatrix& matrix, const GaugeMask& mask) {
  WindowMatrix result = matrix;
  for (int k = 0; k < kWindowReadings; ++k) {
    if (!mask[static_cast<std::size_t>(k)]) result.row(k).setZero();
  }
  return result;
}

using Variances = Eigen::Vector3d;  // of offset, normal load, tangential load

/// Cramer-Rao bound for unit noise and loads (1, direction): the offset's variance is that of the gradient,
/// the loads' their own at a known offset and what the offset's adds.
Variances variances(const WindowFit& fit, double direction) {
  const Eigen::Vector2d loads(1, direction);
  const Eigen::Vector2d amplitudes = fit.amplitude.triangularView<Eigen::Upper>().solve(loads);
  const double offset = 1 / (fit.gradient * amplitudes).squaredNorm();
  const Eigen::Vector2d slope = fit.amplitude_slope * amplitudes;
  const Eigen::Vector2d own = fit.amplitude.rowwise().squaredNorm();
  return {offset, own[0] + slope[0] * slope[0] * offset, own[1] + slope[1] * slope[1] * offset};
}

/// The gradient along the load direction that three gauges see keeps its sign over the range.
bool seesOffset(const WindowFit& fit, DirectionRange directions) {
  const auto gradient = [&](double direction) -> WindowVector {
    return fit.gradient * fit.amplitude.triangularView<Eigen::Upper>().solve(Eigen::Vector2d(1, direction));
  };
  return gradient(directions.least).dot(gradient(directions.most)) > 0;
}

constexpr int kConeDirections = 5;  // the errors are smooth between them once seesOffset() holds

std::array<Variances, kConeDirections> variancesOver(const WindowFit& fit, DirectionRange directions) {
  std::array<Variances, kConeDirections> result;
  for (int i = 0; i < kConeDirections; ++i) {
    const double part = static_cast<double>(i) / (kConeDirections - 1);
    result[static_cast<std::size_t>(i)] =
        variances(fit, directions.least + part * (directions.most - directions.least));
  }
  return result;
}

}  // namespace

WindowResponse windowResponse(const model::ImpulseResponse& response, int gaugeCount, double offset_pitch) {
  const double pitch_rad = 2 * std::numbers::pi / gaugeCount;
  const auto at = [&](int gauge) { return response.at((gauge - offset_pitch) * pitch_rad); };
  WindowResponse window{WindowMatrix::Zero(), WindowMatrix::Zero()};
  const auto add = [&](int row, const model::ImpulseResponse::Value& value, double weight) {
    window.value.row(row) += weight * Eigen::RowVector2d(value.normal, value.tangential);
    window.slope.row(row) -=
        weight * pitch_rad * Eigen::RowVector2d(value.normalSlope, value.tangentialSlope);
  };
  for (int k = 0; k < kWindowGauges; ++k) add(k, at(k - kWindowReach), 1);
  if (hasOuterPair(gaugeCount)) {
    add(kWindowGauges, at(kOuterReach), 1 / std::numbers::sqrt2);
    add(kWindowGauges, at(-kOuterReach), -1 / std::numbers::sqrt2);
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

GaugeMask gaugesOfTriple(std::size_t triple) {
  GaugeMask mask{};
  for (const int gauge : kTripleList[triple]) mask[static_cast<std::size_t>(gauge + kWindowReach)] = true;
  return mask;
}

std::optional<std::uint8_t> bestTriple(const WindowResponse& response, DirectionRange directions) {
  const auto reference = variancesOver(windowFit(response, kAllGauges), directions);
  std::optional<std::uint8_t> best;
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t triple = 0; triple < kTriples; ++triple) {
    const WindowFit fit = windowFit(response, gaugesOfTriple(triple));
    if (!seesOffset(fit, directions)) continue;
    const auto own = variancesOver(fit, directions);
    double worst = 0;
    for (std::size_t i = 0; i < own.size(); ++i)
      worst = std::max(worst, own[i].cwiseQuotient(reference[i]).maxCoeff());
    if (worst >= least) continue;
    best = static_cast<std::uint8_t>(triple);
    least = worst;
  }
  return best;
}

}  // namespace strainfinger::tables
