#include "host/session/thinning.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "host/config/over_range.hpp"
#include "host/session/rules.hpp"

namespace strainfinger::session {

using calibration::TouchState;
using Eigen::VectorXd;

namespace {

/// Times of arrival are so far off the finger's.
constexpr double kClockJitter_s = 1e-3;

}  // namespace

Thinner::Thinner(const config::FingerConfig& config)
    : config_(config),
      search_(calibration::drawnSearch(config)),
      kept_s_(-std::numeric_limits<double>::infinity()) {}

Verdict Thinner::take(const Sample& sample) {
  const config::Gauges& gauges = config_.gauges;
  while (!recent_.empty() && sample.time_s - recent_.front().time_s > kThinning.longestSpan_s)
    recent_.pop_front();
  const bool steady = isSteady(sample);
  recent_.push_back(sample);
  const double peak = sample.strains.cwiseAbs().maxCoeff();
  if (config::isOverRange(gauges, peak)) return Verdict::kOverRange;
  if (peak < kThinning.weakest * gauges.noise_strain) return Verdict::kWeak;
  if (!steady) return Verdict::kUnsteady;
  if (sample.time_s - kept_s_ < kThinning.closest_s - kClockJitter_s) return Verdict::kAlike;
  std::vector<VectorXd>& cell = cells_[cellOf(sample.strains)];
  if (!isDistinct(cell, sample.strains)) return Verdict::kAlike;
  if (cell.size() >= static_cast<std::size_t>(kThinning.mostPerCell)) return Verdict::kEnough;
  cell.push_back(sample.strains);
  kept_s_ = sample.time_s;
  return Verdict::kKept;
}

void Thinner::remember(const VectorXd& strains) {
  if (strains.cwiseAbs().maxCoeff() >= kThinning.weakest * config_.gauges.noise_strain)
    cells_[cellOf(strains)].push_back(strains);
}

/// Compared with the newest set that is old enough, noise taken off; over the largest size of late: between
/// gauges readings are small and change quickly though the load doesn't.
bool Thinner::isSteady(const Sample& sample) const {
  for (auto before = recent_.rbegin(); before != recent_.rend(); ++before) {
    const double span_s = sample.time_s - before->time_s;
    if (span_s < kThinning.shortestSpan_s) continue;
    const double noise = config_.gauges.noise_strain;
    const double change2 = (sample.strains - before->strains).squaredNorm() -
                           2 * noise * noise * static_cast<double>(sample.strains.size());
    double size = sample.strains.norm();
    for (const Sample& other : recent_) size = std::max(size, other.strains.norm());
    return std::sqrt(std::max(0.0, change2)) <= kThinning.fastest_per_s * span_s * size;
  }
  return false;
}

bool Thinner::isDistinct(const std::vector<VectorXd>& kept, const VectorXd& strains) const {
  const double least =
      kThinning.distinct * config_.gauges.noise_strain * std::sqrt(2 * static_cast<double>(strains.size()));
  return std::ranges::none_of(kept, [&](const VectorXd& other) { return (strains - other).norm() < least; });
}

Thinner::Cell Thinner::cellOf(const VectorXd& strains) const {
  const TouchState touch = search_.guess(strains);
  const double lean = touch[calibration::kTangentialLoad] / touch[calibration::kNormalLoad];
  const int octave = static_cast<int>(std::floor(std::log2(std::max(touch[calibration::kNormalLoad], 1e-3))));
  return {arcOf(config_.gauges, touch[calibration::kPlace]), octave,
          lean > kThinning.rubbed    ? 1
          : lean < -kThinning.rubbed ? -1
                                     : 0};
}

}  // namespace strainfinger::session
