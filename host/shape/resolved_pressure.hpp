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
/// (square integrable over the arc in m) to the gauges. A direction as strong as the touch's own
/// semi-ellipse, of norm p0 sqrt(4 a / 3), reads its singular value times that norm: it is above the noise if
/// that exceeds the noise of a gauge, and resolved if it does 3 times.
///
/// Two maps: directions() counts what is above the noise for a contact whose place is known, without shear.
/// The pressure is resolved in directions that are left when the tangential load, spread by the same profile,
/// is unknown too; it is that of absolute angles, so that its odd directions hold the uncertainty of the
/// place.
class ResolvedPressure {
 public:
  /// The arc reaches half_rad to both sides of the touch; the semi-ellipse over it carries the touch's normal
  /// load; shear is spread like the touch's own. Domain: half_rad > 0, normal load > 0, noise > 0. Keeps a
  /// reference to the model. Costs 0.5 ms.
  ResolvedPressure(const TouchModel& model, const Touch& touch, double half_rad, double noise);

  int directions() const { return directions_; }
  int resolved() const { return static_cast<int>(values_.size()); }  ///< at least 1
  /// Whether an uneven pressure would show: the first direction that is odd about the touch's angle is where
  /// the touch is, so it takes a second one.
  bool isOddResolved() const { return oddResolved_ > 1; }

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
  int oddResolved_ = 0;
  Eigen::VectorXd values_;    // singular values [strain / (Pa sqrt(m))]
  Eigen::MatrixXd readings_;  // one column a resolved direction: what the gauges read of it, of norm 1
};

}  // namespace strainfinger::shape
