#pragma once
// computeField() in 100 digits.

#include "host/model/field.hpp"
#include "tests/host/model/wide.hpp"

namespace strainfinger::stability {

using testing::Wide;

/// Fields at one radius per N/m of a normal and of a tangential load, from the model's own templates:
/// harmonics until 1e-25 and, at r_b, the closed form of what is left.
class WideField {
 public:
  WideField(const model::Annulus<double>& annulus, double radius_m);

  /// How many harmonics that takes.
  static int harmonics(const model::Annulus<double>& annulus, double radius_m);

  /// Rows as in model::Row, columns as in model::Traction, at an angle from the load's centre.
  Eigen::Matrix<Wide, model::kRowCount, 2> at(double width_rad, double angle_rad) const;

 private:
  bool atSurface_;
  testing::WideAnnulus annulus_;
  std::vector<testing::WideResponse> responses_;  // at r_b: without what the closed form has
};

}  // namespace strainfinger::stability
