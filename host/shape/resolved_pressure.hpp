#pragma once
// What of a pressure the gauges see above their noise.

#include <Eigen/Core>

#include "host/shape/touch_model.hpp"

namespace strainfinger::shape {

/// A pressure on an arc of the surface and the standard deviation that the gauges' noise gives it [Pa].
struct PressureEstimate {
  Eigen::VectorXd pressure_pa;
  Eigen::VectorXd sigma_pa;
};

/// Pressures on the arc of a touch as a sum of directions: the singular functions of the map from a pressure
/// (of square-integrable kind, over the arc in m) to the gauges. A direction is above the noise if its
/// singular value times the norm of the touch's own semi-ellipse, p0 sqrt(4 a / 3), exceeds the noise of a
/// gauge.
///
/// Two maps: directions() counts for a contact whose place is known, without shear. The pressure's directions
/// are those left when the tangential load, spread by the same profile, is unknown too. The pressure is that
/// of absolute angles, so that its odd directions hold the uncertainty of the place.
class ResolvedPressure {
 public:
  /// `touch`: where to look, as wide as its moment says, and the load that the semi-ellipse carries. Domain:
  /// moment > 0, normal load > 0, noise > 0. Keeps a reference to the model. Costs 1 ms.
  ResolvedPressure(const TouchModel& model, const Touch& touch, double noise);

  int directions() const { return directions_; }                     ///< place known, no shear
  int resolved() const { return static_cast<int>(values_.size()); }  ///< of the pressure's
  /// Whether an uneven pressure would show. The first direction that is odd about the touch's angle is where
  /// the touch is; a second one, 3 times above the noise, would show an odd part as large as a pressure can
  /// have.
  bool isOddResolved() const { return strongOdd_ > 1; }

  /// The resolved directions, orthonormal over the arc [1/sqrt(m)]: one row an offset [rad] from the touch,
  /// zero outside the arc, one column a direction.
  Eigen::MatrixXd directionsAt(const Eigen::VectorXd& offsets_rad) const;

  /// The resolved part of the pressure under these readings: least squares over the resolved directions.
  PressureEstimate estimate(const Eigen::VectorXd& strains, const Eigen::VectorXd& offsets_rad) const;

 private:
  const TouchModel& model_;
  Touch touch_;
  double noise_;
  double half_rad_;
  int directions_ = 0;
  int strongOdd_ = 0;
  Eigen::VectorXd values_;    // singular values [strain / (Pa sqrt(m))]
  Eigen::MatrixXd readings_;  // one column a resolved direction: what the gauges read of it, of norm 1
};

}  // namespace strainfinger::shape
