#pragma once
// Where on the ring a touch may be: the global part of the fit.

#include <optional>
#include <vector>

#include "host/shape/touch_fit.hpp"

namespace strainfinger::shape {

struct SearchResult {
  /// Its covariance is that of all touches found, each weighing its likelihood: the best one's own where no
  /// other fits about as well.
  TouchFit best;
  /// The angle of another touch, 3 of the best one's sigmas away in any of its numbers, that is less than
  /// kSure worse in chi squared.
  std::optional<double> rivalAngle_rad;
};

/// Differences of chi squared from which on one answer is held for better than another: 3 sigma.
inline constexpr double kSure = 9;

/// Looks for touches everywhere: all angles in eighths of a pitch and seven widths, friction observed, then
/// refine() from the eight best places. An ellipse's pressure.
class TouchSearch {
 public:
  /// Keeps a reference to the model. |tangential| <= friction normal counts against a touch that has more by
  /// as many sigmas. Costs 1 ms.
  TouchSearch(const TouchModel& model, double friction);

  /// Nothing if readings are noise: no touch lowers chi squared by kTouched. Domain: a finite strain a gauge,
  /// noise > 0. Costs 0.2 ms for 32 gauges.
  std::optional<SearchResult> search(const Eigen::VectorXd& strains, double noise) const;

  /// Of noise alone 1 in 10,000 is that much like a touch somewhere (chi squared of four fitted numbers, at
  /// some 30 independent places).
  static constexpr double kTouched = 31;

 private:
  struct Start;
  Start bestLoads(Eigen::Index place, double alongNormal, double alongTangential) const;
  void tabulate(Eigen::Index moment, Eigen::Index angle);
  std::vector<Start> starts(const Eigen::VectorXd& strains) const;

  const TouchModel& model_;
  double friction_;
  std::vector<double> moments_rad2_;
  std::vector<double> angles_rad_;
  Eigen::MatrixXd normal_, tangential_;  // one column a moment and angle, angles running
  Eigen::VectorXd normalSquare_, tangentialSquare_, product_;
};

}  // namespace strainfinger::shape
