#pragma once
// Which of the thousands of sample sets of a stream are worth a row: touches that differ from the kept ones,
// that don't change quickly, and not more of a kind than tell anything.

#include <deque>
#include <map>
#include <tuple>
#include <vector>

#include "host/calibration/touch_fit.hpp"
#include "host/session/coverage.hpp"
#include "host/session/rows.hpp"

namespace strainfinger::session {

enum class Verdict {
  kTooSoon,  ///< nothing is kept of a session before the zeros are known
  kKept,
  kOverRange,  ///< a gauge at or beyond full scale
  kWeak,       ///< nothing touches it, or hardly
  kUnsteady,   ///< the load changes too quickly, or there was no set shortly before
  kAlike,      ///< as a row that was kept, or too soon after it
  kEnough,     ///< there are enough of this place, load and lean
};

/// Goes through a stream in the order of time. What it says follows from the sets that it was given alone.
class Thinner {
 public:
  /// The config's drawing says where and how strong touches are, as TouchSearch::guess() has it: what
  /// fingers are built off it doesn't matter here. Costs 50 ms for 16 gauges.
  explicit Thinner(const config::FingerConfig& config);

  Verdict take(const Sample& sample);

  /// A row that is there already, as of a session that goes on.
  void remember(const Eigen::VectorXd& strains);

 private:
  using Cell = std::tuple<int, int, int>;  ///< arc, octave of load, lean
  Cell cellOf(const Eigen::VectorXd& strains) const;
  bool isSteady(const Sample& sample) const;
  bool isDistinct(const std::vector<Eigen::VectorXd>& kept, const Eigen::VectorXd& strains) const;

  config::FingerConfig config_;
  calibration::TouchSearch search_;
  std::deque<Sample> recent_;  ///< of the last longestSpan_s
  double kept_s_;
  std::map<Cell, std::vector<Eigen::VectorXd>> cells_;
};

}  // namespace strainfinger::session
