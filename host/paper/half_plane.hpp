#pragma once
// The elastic half plane that the paper compares the finger with, in plane strain, in the finger's own terms:
// r points out of the rubber, theta is x / r_b.

#include <Eigen/Core>

#include "common/quantities.hpp"

namespace strainfinger::paper {

/// Strains (rows: StrainComponent) under a normal and a tangential load (columns: model::Traction).
using Strains = Eigen::Matrix<double, 3, 2>;

/// At one depth below the surface of a half plane (Johnson, Contact Mechanics, 1985, sec. 2.2 and 2.3).
/// Domain: shear_modulus_pa > 0, 0 <= poisson_ratio <= 1/2, depth_m > 0.
struct HalfPlane {
  double shear_modulus_pa;
  double poisson_ratio;
  double depth_m;

  /// Response [1/Pa] to unit tractions of wave number k >= 0, tension positive, in the pairing of
  /// model::HarmonicResponse: sines of p and cosines of q make sines of e_rr and e_tt, cosines of e_rt.
  Strains atWaveNumber(double k_per_m) const;

  /// Strains [m/N] at an arc x_m along the surface from a line load of 1 N/m, pressing or towards +theta.
  Strains atArc(double x_m) const;

 private:
  Strains strains(const Strains& stresses) const;
};

}  // namespace strainfinger::paper
