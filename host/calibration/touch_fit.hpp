#pragma once
// One touch of a finger that is given: from its readings alone, or from where it is thought to be.

#include <Eigen/Core>
#include <limits>
#include <optional>
#include <vector>

#include "host/calibration/touch_equations.hpp"

namespace strainfinger::calibration {

struct TouchFit {
  TouchState touch = TouchState::Zero();
  double chiSquared = 0;  ///< of readings and prior
  /// How much worse the best touch at another place or of another width explains the readings, and that
  /// touch; infinite if there is none.
  double rivalGap = std::numeric_limits<double>::infinity();
  TouchState rival = TouchState::Zero();
};

/// Gauss-Newton with Levenberg's damping from a start nearby. Costs 40 us an iteration; four as a rule.
TouchFit refineTouch(const RingResponse& ring, const TouchData& data, const TouchState& start);

/// The best of what these starts lead to, and its rival among them; of no starts: infinite chi-squared, no
/// gap.
TouchFit refineTouches(const RingResponse& ring, const TouchData& data,
                       const std::vector<TouchState>& starts);

/// Finds touches without a start: all places of a grid with all widths of a grid, each with the loads that
/// fit best there, and the best few refined.
class TouchSearch {
 public:
  /// Within the config's friction, up to its largest width. Costs 5 ms for 16 gauges.
  TouchSearch(const RingResponse& ring, const config::FingerConfig& config);

  /// Of readings, zeros apart, the nodes that explain most, each of another width; none where no touch of
  /// this prior could be. Costs 30 us.
  std::vector<TouchState> starts(const Eigen::VectorXd& strains, const TouchPrior& prior) const;

  /// Those refined. Costs 0.7 ms. `ring` is the one of the search, or one near it.
  TouchFit find(const RingResponse& ring, const TouchData& data) const;

  /// The touch of the grid that explains readings, zeros apart, best; 0 where no touch could be.
  /// Nineteen of twenty places are within a tenth of the gap between gauges, loads within a quarter; one in a
  /// hundred is another touch that reads alike.
  TouchState guess(const Eigen::VectorXd& strains) const;

  /// The share of the energy of readings, zeros apart, that no touch of the grid explains: 0 .. 1; 1 where no
  /// touch could be. With one gauge left out, as if the ring had no such gauge. Costs 20 us.
  double unexplainedShare(const Eigen::VectorXd& strains, std::optional<int> leftOut = {}) const;

 private:
  struct Node {
    double place_rad, moment_rad2;
    Eigen::Matrix2d toLoads;  ///< loads of unit length along the orthonormal directions
  };
  TouchState stateAt(std::size_t node, const Eigen::Vector2d& coordinates) const;
  bool isAdmissible(const TouchState& touch, const TouchPrior& prior) const;

  double friction_;
  std::size_t moments_;
  std::vector<Node> nodes_;      ///< place by place, each with all moments
  Eigen::MatrixXd orthonormal_;  ///< two columns a node: a basis of what loads there make the gauges read
};

/// Of the finger as drawn.
TouchSearch drawnSearch(const config::FingerConfig& config);

}  // namespace strainfinger::calibration
