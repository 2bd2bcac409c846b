#pragma once
// Where on the ring a touch may be: the global part of the fit.

#include <optional>
#include <vector>

#include "host/shape/plausible_touches.hpp"

namespace strainfinger::shape {

struct SearchResult {
  /// Its covariance is that of all places that explain the readings about as well, each weighing its
  /// likelihood: the fit's own where the model is as linear as that says. With rivals it is enlarged until
  /// bands of 90 % hold them all.
  TouchFit best;
  /// The angle of a rival: a touch less than kRival worse in chi squared that is another one (3 of the best
  /// one's own sigmas away in any of its numbers, as an end of the search, or 4.5 of all places' sigmas), or
  /// of a valley too long or too bent to be followed to its ends.
  std::optional<double> rivalAngle_rad;
};

/// Places less worse than this fit about as well as the best: 3 sigma for the two numbers, angle and moment,
/// that make a place.
inline constexpr double kRival = 11.83;

/// Differences of chi squared from which on one answer is held for better than another: 3 sigma.
inline constexpr double kSure = 9;

/// Looks for touches everywhere: all angles in eighths of a pitch and seven widths, friction observed, then
/// refine() from the eight best places, then all places around that fit about as well. An ellipse's pressure.
class TouchSearch {
 public:
  /// Keeps a reference to the model. |tangential| <= friction normal and a moment of 0 at least count
  /// against a touch that breaks them by as many sigmas. Costs 20 ms, 70 ms for 32 gauges.
  TouchSearch(const TouchModel& model, double friction);

  /// Nothing if readings are noise: no touch lowers chi squared by kTouched. Domain: a finite strain a gauge,
  /// noise > 0. Costs 2 ms for 32 gauges, up to 30 ms where they tell little.
  std::optional<SearchResult> search(const Eigen::VectorXd& strains, double noise) const;

  /// Of noise alone 1 in 10,000 is that much like a touch somewhere (chi squared of four fitted numbers, at
  /// some 30 independent places).
  static constexpr double kTouched = 31;

 private:
  struct Start;
  Start bestLoads(Eigen::Index place, double alongNormal, double alongTangential) const;
  std::vector<Start> starts(const Eigen::VectorXd& strains) const;

  const TouchModel& model_;
  double friction_;
  std::vector<double> moments_rad2_;
  std::vector<double> angles_rad_;
  Eigen::MatrixXd normal_, tangential_;  // one column a moment and angle, angles running
  Eigen::VectorXd normalSquare_, tangentialSquare_, product_;
};

}  // namespace strainfinger::shape
