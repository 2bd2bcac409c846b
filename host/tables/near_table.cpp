#include "host/tables/near_table.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "common/fixed_real.hpp"

namespace strainfinger::tables {
namespace {

constexpr double kLongestNear = 0x1p14 - 1;

std::int16_t nearWeight(double value) { return saturate<std::int16_t>(std::llround(value)); }

/// Weights of middle reading and difference for one load, rounded.
std::array<std::int16_t, 2> loadOf(const Eigen::Vector2d& weights) {
  return {nearWeight(weights[0]), nearWeight(weights[1])};
}

double unfoldedLength(const Eigen::Vector2d& weights) {
  return std::sqrt(weights[0] * weights[0] + 2 * weights[1] * weights[1]);
}

using NearResponse = Eigen::Matrix<double, 3, 2>;  // of the gauges at -1, 0 and 1

NearResponse nearOf(const WindowResponse& response) { return response.value.middleRows<3>(kWindowReach - 1); }

/// Of middle reading and difference.
Eigen::Matrix2d toldBy(const NearResponse& response) {
  Eigen::Matrix2d told;
  told << response.row(1), response.row(2) - response.row(0);
  return told;
}

Eigen::Vector3d normalOf(const NearResponse& response) { return response.col(0).cross(response.col(1)); }

/// `normal` and `scale`: of the plane, and of the loads.
NearRow nearRow(const NearResponse& response, const Eigen::Vector3d& normal, double scale) {
  const Eigen::Matrix2d told = toldBy(response);
  const double determinant = told.determinant();
  if (determinant == 0) return {};
  Eigen::Matrix2d loads;
  loads << told(1, 1), -told(0, 1), -told(1, 0), told(0, 0);
  loads *= scale / determinant;
  if (!(unfoldedLength(loads.row(0)) < kLongestNear && unfoldedLength(loads.row(1)) < kLongestNear))
    return {};
  const auto weight = [](double value) { return nearWeight(std::ldexp(value, 14)); };
  return {{weight(normal[1]), weight((normal[2] + normal[0]) / 2), weight((normal[2] - normal[0]) / 2), 0},
          loadOf(loads.row(0)),
          loadOf(loads.row(1))};
}

}  // namespace

double nearPole(const model::ImpulseResponse& response, int gaugeCount) {
  constexpr int kSteps = 256;  // a pitch
  constexpr double kLeast = kLeastNearPole_q15 * 0x1p-15;
  const auto determinant = [&](double offset_pitch) {
    return toldBy(nearOf(windowResponse(response, gaugeCount, offset_pitch))).determinant();
  };
  const double first = determinant(0);
  for (int step = 1; step <= kSteps; ++step) {
    const double offset_pitch = static_cast<double>(step) / kSteps, here = determinant(offset_pitch);
    if ((here > 0) == (first > 0)) continue;
    const double before = determinant(offset_pitch - 1.0 / kSteps);
    return std::max(kLeast, offset_pitch - here / (here - before) / kSteps);
  }
  return 2 - 1.0 / kSteps;
}

NearTable nearTable(const WindowResponses& responses, double peak, int amplitudeExponent, double pole_pitch) {
  double longest = 0;
  for (std::size_t row = 0; row < kNearRows; ++row)
    longest = std::max(longest, normalOf(nearOf(responses[row * kNearStride])).norm());
  NearTable table{};
  for (std::size_t row = 0; row < table.size(); ++row) {
    const double offset_pitch = static_cast<double>(row * kNearStride) / kRowsPerPitch;
    const double scale = std::ldexp(1 - offset_pitch / pole_pitch, amplitudeExponent - 1);
    const NearResponse here = nearOf(responses[row * kNearStride]);
    table[row] = nearRow(here / peak, normalOf(here) / longest, scale);
    if (!table[row].tells()) break;
  }
  return table;
}

}  // namespace strainfinger::tables
