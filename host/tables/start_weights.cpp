#include "host/tables/start_weights.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/fixed_real.hpp"

namespace strainfinger::tables {
namespace {

constexpr int kStartOffsets = 128;
constexpr int kStartDirections = 32;
constexpr double kStartFarthest_pitch =
    0.6;                               ///< contacts farther from the deepest gauge belong to another window
constexpr double kStartNoise = 0.002;  ///< of a reading, relative to the deepest one
constexpr double kMostError_pitch = 1.0 / 16;

struct Example {
  Eigen::Vector3d differences;  ///< over the deepest reading
  double offset_pitch;          ///< from its gauge
};
using Examples = std::array<std::vector<Example>, kShares>;

void addContact(const std::vector<double>& readings, double position_pitch, Examples& examples) {
  const int gauges = static_cast<int>(readings.size());
  const int deepest = static_cast<int>(std::max_element(readings.begin(), readings.end()) - readings.begin());
  const auto at = [&](int away) {
    return readings[static_cast<std::size_t>((deepest + away + gauges) % gauges)];
  };
  const double offset = std::remainder(position_pitch - deepest, gauges);
  double energy = 0;
  for (const double reading : readings) energy += reading * reading;
  if (!(at(0) > 0)) return;
  Example example{{}, offset};
  for (int distance = 1; distance <= kWindowReach; ++distance)
    example.differences[distance - 1] = (at(distance) - at(-distance)) / at(0);
  const double share = at(0) * at(0) / energy * kShares;
  examples[std::min<std::size_t>(static_cast<std::size_t>(share), kShares - 1)].push_back(example);
}

Examples examplesOf(const model::ImpulseResponse& response, int gaugeCount, double cone) {
  Examples examples;
  const double sign = response.at(0).normal < 0 ? -1 : 1;
  for (int step = 0; step <= kStartOffsets; ++step) {
    const double position_pitch = static_cast<double>(step) / kStartOffsets - 0.5;
    std::vector<model::ImpulseResponse::Value> values;
    for (int gauge = 0; gauge < gaugeCount; ++gauge)
      values.push_back(response.at((gauge - position_pitch) * 2 * std::numbers::pi / gaugeCount));
    for (int direction = -kStartDirections; direction <= kStartDirections; ++direction) {
      std::vector<double> readings;
      for (const auto& value : values)
        readings.push_back(sign * (value.normal + cone * direction / kStartDirections * value.tangential));
      addContact(readings, position_pitch, examples);
    }
  }
  return examples;
}

StartWeights weightsFrom(const std::vector<Example>& examples) {
  const auto isHere = [](const Example& example) {
    return std::abs(example.offset_pitch) <= kStartFarthest_pitch;
  };
  if (std::count_if(examples.begin(), examples.end(), isHere) < 8) return {};
  Eigen::Matrix3d products = Eigen::Matrix3d::Zero();
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  for (const Example& example : examples) {
    if (!isHere(example)) continue;
    products += example.differences * example.differences.transpose();
    products.diagonal().array() += 2 * kStartNoise * kStartNoise;
    target += example.differences * example.offset_pitch;
  }
  const Eigen::Vector3d weights = products.inverse() * target;
  std::size_t far = 0;
  for (const Example& example : examples)
    far += std::abs(weights.dot(example.differences) - example.offset_pitch) > kMostError_pitch;
  if (far * 10 > examples.size() * 3) return {};
  const Eigen::Vector3d scaled = weights * powerOfTwo(kStartWeightBits);
  if (!(std::numbers::sqrt2 * scaled.norm() < 0x1p15 - 1)) return {};
  StartWeights result{};
  for (std::size_t i = 0; i < 3; ++i)
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
