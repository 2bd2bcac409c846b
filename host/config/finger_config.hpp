#pragma once
// One finger, as finger.toml describes it. The defaults are the default finger: Fearing's (1990), the one
// Nicolson & Fearing (1993) compute with, and electronics that suit it.

#include <cmath>
#include <cstddef>
#include <numbers>
#include <optional>
#include <string>
#include <vector>

#include "common/quantities.hpp"
#include "host/base/angles.hpp"
#include "host/model/annulus.hpp"
#include "host/model/placed_gauge.hpp"

namespace strainfinger::config {

struct Finger {
  double core_radius_m = 8.9e-3;
  double outer_radius_m = 12.7e-3;
  double length_m = 0.02;  ///< of the contact line: turns N/m into N
  double shear_modulus_pa = 8.3e4;
  double poisson_ratio = 0.5;

  model::Annulus<double> annulus() const {
    return {core_radius_m, outer_radius_m, shear_modulus_pa, poisson_ratio};
  }
};

struct Gauges {
  int count = 16;
  double radius_m = 9.4e-3;
  StrainComponent component = StrainComponent::kRadial;
  double first_angle_deg = 0;
  double arc_length_m = 0;     ///< the strain is averaged over it
  double noise_strain = 6e-6;  ///< standard deviation of a conditioned reading, quantisation included
  double full_scale_strain =
      0.03;  ///< largest that the converter covers, of either sign; 65 N/m on the default finger
  int adc_bits = 12;
  /// Standard deviation of what a reading may be off what the model says, as a fraction of that reading:
  /// build tolerances and rubber. Its neighbours and the touch's largest reading add to it
  /// (firmware::weigh()). 0.05 is for a finger that nobody calibrated.
  double model_error = 0.05;
  /// Where each gauge is, for a ring that is not even: 0 .. 360, counter-clockwise from gauge to gauge;
  /// empty: the ring is even, from first_angle_deg on.
  std::vector<double> angles_deg = {};

  /// One code of the converter.
  double step_strain() const { return 2 * std::ldexp(full_scale_strain, -adc_bits); }
  /// Standard deviation of what rounding to codes adds.
  double quantisation_strain() const { return step_strain() / std::sqrt(12.0); }

  bool isEven() const { return angles_deg.empty(); }
  /// Of a gauge, 0 .. 360.
  double angle_deg(int gauge) const {
    if (!isEven()) return angles_deg[static_cast<std::size_t>(gauge)];
    return std::fmod(first_angle_deg + gauge * 360.0 / count, 360);
  }
  /// The same; of an even ring not reduced to one revolution.
  double angle_rad(int gauge) const {
    if (!isEven()) return angle_deg(gauge) * kRadPerDeg;
    return (first_angle_deg / 360 + static_cast<double>(gauge) / count) * 2 * std::numbers::pi;
  }
  /// Counter-clockwise from a gauge to the next, the last one's next being gauge 0: 0 .. 360.
  double gap_deg(int gauge) const {
    return std::fmod(angle_deg((gauge + 1) % count) - angle_deg(gauge) + 360, 360);
  }
};

struct Contact {
  double friction_coefficient = 1.0;
  /// Width over which a contact presses, an arc of the surface; 0: a line load. Empty: unknown, fitted with
  /// each touch.
  std::optional<double> width_m = {};
  double largest_width_m = 8e-3;  ///< what the tables cover
};

struct Can {
  int node = 1;
  int bitrate = 1'000'000;
  double contact_rate_hz = 500;
};

/// What calibration found of each gauge, one number a gauge; an empty list: not calibrated. And what it does
/// not know, as standard errors of all touches to come.
struct Calibration {
  std::vector<double> gain;              ///< what a gauge reads over what it should
  std::vector<double> angle_offset_deg;  ///< its true angle less the drawing's, counter-clockwise positive
  std::vector<double> depth_offset_m;    ///< deeper than the drawing: positive towards the core
  double place_error_m = 0;              ///< of places, an arc of the surface
  double load_error = 0;                 ///< of normal and tangential loads, over the normal load
  double moment_error_m2 = 0;            ///< of second moments of the pressure, as widths are told by

  bool isEmpty() const { return gain.empty() && angle_offset_deg.empty() && depth_offset_m.empty(); }
};

/// How a simulated finger differs from the drawing. The spreads are standard deviations over its gauges, each
/// drawn by the seed.
struct AsBuilt {
  int seed = 1;
  double angle_deg = 0;         ///< spread of the gauges' angles
  double depth_m = 0;           ///< spread of their depths
  double gain = 0;              ///< spread of their gains, relative
  double core_radius_m = 0;     ///< true radius of the core less finger.core_radius_m
  double poisson_ratio = 0;     ///< true ratio less finger.poisson_ratio
  double shear_modulus_pa = 0;  ///< true modulus less finger.shear_modulus_pa

  bool isAsDrawn() const {
    return angle_deg == 0 && depth_m == 0 && gain == 0 && core_radius_m == 0 && poisson_ratio == 0 &&
           shear_modulus_pa == 0;
  }
};

/// How far a finger of this drawing may be off it: standard deviations. What `calibrate` takes for granted
/// where touches tell nothing, and how it weighs that against what they tell; and what errors of a finger
/// that is not calibrated come from (unseenErrors()).
struct Tolerance {
  double angle_deg = 0.5;     ///< of each gauge
  double depth_m = 5e-5;      ///< of each gauge
  double gain = 0.03;         ///< of each gauge, relative
  double zero_strain = 1e-4;  ///< of each gauge, what taring leaves
  double core_radius_m = 1e-4;
  double poisson_ratio = 0.02;
  double shear_modulus = 0.2;  ///< relative
};

struct FingerConfig {
  Finger finger;
  Gauges gauges;
  Contact contact;
  Can can;
  Calibration calibration;
  Tolerance tolerance;
  AsBuilt as_built;
  std::string source = {};  ///< the file that it was read from, for messages; empty: none

  /// A gauge by the drawing.
  model::PlacedGauge drawn(int gauge) const { return {gauges.angle_rad(gauge), gauges.radius_m, 1}; }

  /// A gauge by the drawing and what calibration found.
  model::PlacedGauge calibrated(int gauge) const {
    const auto found = [gauge](const std::vector<double>& list, double otherwise) {
      return list.empty() ? otherwise : list[static_cast<std::size_t>(gauge)];
    };
    model::PlacedGauge placed = drawn(gauge);
    placed.angle_rad += found(calibration.angle_offset_deg, 0) * kRadPerDeg;
    placed.radius_m -= found(calibration.depth_offset_m, 0);
    placed.gain = found(calibration.gain, 1);
    return placed;
  }
};

}  // namespace strainfinger::config
