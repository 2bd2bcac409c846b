#pragma once
// computeField() in 100 digits.

#include <span>
#include <vector>

#include "host/model/field.hpp"
#include "tests/host/model/wide.hpp"

namespace strainfinger::stability {

using testing::Wide;

/// Fields at one radius per N/m of a normal and of a tangential load, from the model's own templates:
/// harmonics until 1e-20 and, at r_b, the closed form of what is left.
class WideField {
 public:
  /// Where to look: an angle from the centre of a load of some width.
  struct Place {
    double width_rad, angle_rad;
  };
  /// Rows as in model::Row, columns as in model::Traction.
  using Value = Eigen::Matrix<Wide, model::kRowCount, 2>;

  WideField(const model::Annulus<double>& annulus, double radius_m);

  /// How many harmonics that takes.
  static int harmonics(const model::Annulus<double>& annulus, double radius_m);

  /// A value a place, all summed at once: a harmonic's response is computed once and kept no longer.
  std::vector<Value> at(std::span<const Place> places) const;

 private:
  testing::WideResponse response(const model::HarmonicModel<Wide>& responses, int n) const;

  bool atSurface_;
  testing::WideAnnulus annulus_;
  Wide radius_m_;
  int harmonics_;
};

}  // namespace strainfinger::stability
