#include "host/tables/start_weights.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/fixed_real.hpp"
#include "host/tables/pressed_ring.hpp"

namespace strainfinger::tables {
namespace {

constexpr int kStartOffsets = 128;
constexpr int kStartDirections = 32;
/// Contacts farther from the deepest gauge belong to another window.
constexpr double kStartFarthest_pitch = 0.6;
/// Of a reading, relative to the deepest one.
constexpr double kStartNoise = 0.002;
constexpr double kMostError_pitch = 1.0 / 16;

using Differences = Eigen::Vector4d;  // of the pairs, the outer one's last
struct Example {
  Differences differences;  ///< over the deepest reading
  double offset_pitch;      ///< from its gauge
};
using Examples = std::array<std::vector<Example>, kShares>;

void addContact(const PressedRing& ring, Examples& examples) {
  if (ring.share() == 0) return;
  Example example{Differences::Zero(), ring.offset_pitch()};
  for (int distance = 1; distance <= fitReach(ring.gauges()); ++distance)
    example.differences[distance - 1] = ring.differenceAt(distance) / ring.at(0);
  const auto share = static_cast<std::size_t>(ring.share() * kShares);
  examples[std::min<std::size_t>(share, kShares - 1)].push_back(example);
}

Examples examplesOf(const model::ImpulseResponse& response, int gaugeCount, double cone) {
  Examples examples;
  for (int step = 0; step <= kStartOffsets; ++step) {
    const RingResponse here(response, gaugeCount, static_cast<double>(step) / kStartOffsets - 0.5);
    for (int direction = -kStartDirections; direction <= kStartDirections; ++direction)
      addContact(here.pressed(cone * direction / kStartDirections), examples);
  }
  return examples;
}

StartWeights weightsFrom(const std::vector<Example>& examples) {
  const auto isHere = [](const Example& example) {
    return std::abs(example.offset_pitch) <= kStartFarthest_pitch;
  };
  if (std::count_if(examples.begin(), examples.end(), isHere) < 8) return {};
  Eigen::Matrix4d products = Eigen::Matrix4d::Zero();
  Differences target = Differences::Zero();
  for (const Example& example : examples) {
    if (!isHere(example)) continue;
    products += example.differences * example.differences.transpose();
    products.diagonal().array() += 2 * kStartNoise * kStartNoise;
    target += example.differences * example.offset_pitch;
  }
  const Differences weights = products.ldlt().solve(target);
  std::size_t far = 0;
  for (const Example& example : examples)
    far += std::abs(weights.dot(example.differences) - example.offset_pitch) > kMostError_pitch;
  if (far * 10 > examples.size() * 3) return {};
  const Differences scaled = weights * powerOfTwo(kStartWeightBits);
  if (!(std::numbers::sqrt2 * scaled.norm() < 0x1p15 - 1)) return {};
  StartWeights result{};
  for (std::size_t i = 0; i < result.size(); ++i)
    result[i] = static_cast<std::int16_t>(std::lround(scaled[static_cast<Eigen::Index>(i)]));
  return result;
}

}  // namespace

std::array<StartWeights, kShares> startWeights(const model::ImpulseResponse& response, int gaugeCount,
                                               double cone) {
  const Examples examples = examplesOf(response, gaugeCount, cone);
  std::array<StartWeights, kShares> weights{};
  std::transform(examples.begin(), examples.end(), weights.begin(), weightsFrom);
  return weights;
}

}  // namespace strainfinger::tables
