#pragma once
// The field below the surface as a sum of the oracle's harmonics, in 100 digits, as many as 1e-30 takes.

#include <array>
#include <memory>

#include "host/model/harmonic.hpp"
#include "host/model/surface_load.hpp"

namespace strainfinger::testing {

class ExactField {
 public:
  ExactField(const model::Annulus<double>& annulus, double radius_m);
  ~ExactField();

  /// All rows at an angle to the load's centre, averaged over a gauge of that width.
  std::array<long double, model::kRowCount> at(const model::SurfaceLoad& load, double angle_rad,
                                               double gauge_rad = 0) const;

 private:
  struct Harmonics;
  std::unique_ptr<const Harmonics> harmonics_;
};

}  // namespace strainfinger::testing
