#include "host/tables/tail_energy.hpp"

#include <Eigen/Core>
#include <algorithm>
#include <cstdlib>
#include <numbers>

#include "common/table_image.hpp"

namespace strainfinger::tables {
namespace {

/// Energies as quadratic forms in the normal and the tangential load.
struct Split {
  Eigen::Matrix2d inside = Eigen::Matrix2d::Zero();
  Eigen::Matrix2d outside = Eigen::Matrix2d::Zero();
};

/// With the contact at an offset from the window's middle gauge.
Split splitAt(const model::ImpulseResponse& response, int gaugeCount, double offset_pitch) {
  Split split;
  for (int gauge = -gaugeCount / 2; gauge < (gaugeCount + 1) / 2; ++gauge) {
    const auto value = response.at((gauge - offset_pitch) * 2 * std::numbers::pi / gaugeCount);
    const Eigen::Vector2d strain(value.normal, value.tangential);
    (std::abs(gauge) <= kWindowReach ? split.inside : split.outside) += strain * strain.transpose();
  }
  return split;
}

constexpr int kTailOffsets = 32;
constexpr int kTailDirections = 64;

double ratioOf(const Split& split, double direction) {
  const Eigen::Vector2d loads(1, direction);
  const double inside = loads.dot(split.inside * loads);
  return inside > 0 ? loads.dot(split.outside * loads) / inside : 0;
}

}  // namespace

double tailEnergy(const model::ImpulseResponse& response, int gaugeCount, double cone) {
  double most = 0;
  for (int offset = 0; offset <= kTailOffsets; ++offset) {
    const Split split = splitAt(response, gaugeCount, 0.5 * offset / kTailOffsets);
    for (int step = -kTailDirections; step <= kTailDirections; ++step)
      most = std::max(most, ratioOf(split, cone * step / kTailDirections));
  }
  return most;
}

}  // namespace strainfinger::tables
