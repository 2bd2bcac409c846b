#pragma once
// Random touches that are the same on every machine.

#include <cstdint>

#include "host/config/finger_config.hpp"
#include "host/simulation/noise.hpp"
#include "host/simulation/scenario.hpp"

namespace strainfinger::evidence {

/// From `least` to `most`.
struct Range {
  double least, most;
};

/// What is drawn, each evenly. As it stands: line loads of 30 N/m anywhere on the ring, within 45 degrees of
/// pressing.
struct TouchRanges {
  Range load_n_per_m{30, 30};  ///< length of (normal, tangential); every order of magnitude alike
  Range lean_deg{-45, 45};     ///< of the load, away from the nearest gauge
  Range offset_pitch{0, 0.5};  ///< from the nearest gauge, on either side; in the gap there
  Range width_m{0, 0};         ///< of the contact
  model::Profile profile = model::Profile::kEllipse;
};

/// Touches of a ring, addressed by number.
class TouchDraws {
 public:
  TouchDraws(const config::Gauges& gauges, const TouchRanges& ranges, std::uint64_t seed)
      : gauges_(gauges), ranges_(ranges), draws_(~seed) {}

  simulation::Touch at(std::uint64_t number) const;

 private:
  config::Gauges gauges_;
  TouchRanges ranges_;
  simulation::Noise draws_;
};

}  // namespace strainfinger::evidence
