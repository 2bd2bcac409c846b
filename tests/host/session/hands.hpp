#pragma once
// What the gauges of a simulated finger read of touches: by the simulation's code, not by calibration's.

#include <Eigen/Core>
#include <cmath>
#include <cstdint>
#include <vector>

#include "host/base/angles.hpp"
#include "host/evidence/touched_ring.hpp"
#include "host/session/rows.hpp"

namespace strainfinger::session {

class Hand {
 public:
  explicit Hand(const config::FingerConfig& config) : ring_(config, 1) {}

  Eigen::VectorXd touch(double angle_deg, double normal_n_per_m, double tangential_n_per_m = 0) {
    const simulation::Touch touch{angle_deg * kRadPerDeg, normal_n_per_m, tangential_n_per_m, 2e-3};
    return ring_.noisy(ring_.exact(touch), number_++);
  }
  Eigen::VectorXd nothing() {
    return ring_.noisy(Eigen::VectorXd::Zero(ring_.exact(simulation::Touch{0, 1, 0, 2e-3}).size()),
                       number_++);
  }

 private:
  evidence::TouchedRing ring_;
  std::uint64_t number_ = 0;
};

}  // namespace strainfinger::session
