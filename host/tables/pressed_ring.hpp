#pragma once
// What the gauges of a ring read of one contact, as the locator first looks at it: whose reading is deepest,
// and how deep.

#include <vector>

#include "host/model/impulse_response.hpp"

namespace strainfinger::tables {

/// Of what a normal load makes the gauge under it read; 1 for shear, of which that is nothing.
inline double peakSign(const model::ImpulseResponse& response) { return response.at(0).normal < 0 ? -1 : 1; }

/// Readings of a contact somewhere on a ring.
struct PressedRing {
  double position_pitch;         ///< of the contact, from gauge 0
  std::vector<double> readings;  ///< by gauge, positive where a normal load's peak is
  int deepest;                   ///< gauge with the largest, the first of equals
  double energy;                 ///< sum of their squares

  int gauges() const { return static_cast<int>(readings.size()); }
  /// Of the gauge so many pitches from the deepest one, less than once round.
  double at(int away) const {
    return readings[static_cast<std::size_t>((deepest + away + gauges()) % gauges())];
  }
  /// Difference of the pair at this distance from the deepest gauge, + side minus - side.
  double differenceAt(int distance) const { return at(distance) - at(-distance); }
  /// What the deepest reading has of the energy; 0 if nothing is pressed.
  double share() const { return at(0) > 0 ? at(0) * at(0) / energy : 0; }
  /// Of the contact from the deepest gauge, the short way round [pitches].
  double offset_pitch() const;
};

/// A ring's responses to a contact at one place, pressed with any load.
class RingResponse {
 public:
  /// Cost: the responses of `gaugeCount` gauges.
  RingResponse(const model::ImpulseResponse& response, int gaugeCount, double position_pitch);

  /// By a unit normal load and so much of a tangential one.
  PressedRing pressed(double tangential) const;

 private:
  double position_pitch_;
  double sign_;
  std::vector<model::ImpulseResponse::Value> values_;
};

}  // namespace strainfinger::tables
