#pragma once
// One gauge of a ring.

namespace strainfinger::model {

struct PlacedGauge {
  double angle_rad;
  double radius_m;
  double gain;  ///< what it reads over the strain that is there
};

}  // namespace strainfinger::model
