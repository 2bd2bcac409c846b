#pragma once
// One finger, as finger.toml describes it. The defaults are the default finger: Fearing's (1990), the one
// Nicolson & Fearing (1993) compute with, and electronics that suit it.

#include <cmath>
#include <numbers>
#include <vector>

#include "common/quantities.hpp"
#include "host/model/annulus.hpp"

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
  double arc_length_m = 0;          ///< the strain is averaged over it
  double noise_strain = 6e-6;       ///< standard deviation of a conditioned reading, quantisation included
  double full_scale_strain = 0.03;  ///< the converter covers +- this; 65 N/m on the default finger
  int adc_bits = 12;

  /// One code of the converter.
  double step_strain() const { return 2 * std::ldexp(full_scale_strain, -adc_bits); }
  /// Standard deviation of what rounding to codes adds.
  double quantisation_strain() const { return step_strain() / std::sqrt(12.0); }

  /// Of a gauge, 0 .. 360.
  double angle_deg(int gauge) const { return std::fmod(first_angle_deg + gauge * 360.0 / count, 360); }
  /// The same, not reduced.
  double angle_rad(int gauge) const {
    return (first_angle_deg / 360 + static_cast<double>(gauge) / count) * 2 * std::numbers::pi;
  }
};

struct Contact {
  double friction_coefficient = 1.0;
  double width_m = 0;  ///< 0: line load
};

struct Can {
  int node = 1;
  int bitrate = 1'000'000;
  double contact_rate_hz = 500;
};

struct Calibration {
  std::vector<double> gain;  ///< what each gauge reads over what it should; empty: not calibrated
};

struct FingerConfig {
  Finger finger;
  Gauges gauges;
  Contact contact;
  Can can;
  Calibration calibration;
};

}  // namespace strainfinger::config
