#pragma once
// Contact and singular values in 50 digits: what their errors are measured against. Of the solvers' code
// only the harmonics' template is used.

#include <Eigen/Core>
#include <vector>

namespace strainfinger::bench {

/// A flat indenter on the default finger, full sliding.
struct PreciseContact {
  double load_n_per_m;
  double offset_rad;            ///< of the contact's centre from the indenter's normal, to +theta
  Eigen::VectorXd angles_rad;   ///< from the contact's centre
  Eigen::VectorXd pressure_pa;  ///< there, positive pressing
};

/// Nystrom's method at 40 Chebyshev nodes, the logarithm of the kernel integrated in closed form: converges
/// like the pressure's Chebyshev series, to 1e-30 at 2 mm. Domain: nu = 1/2, where the kernel has no other
/// singularity; width <= 6 mm. Costs 0.7 s.
PreciseContact preciseContact(double width_m, double friction);

/// The first singular values of T C over the continuum of the width, largest first, but for a common factor;
/// n_c = 300: from their squares over 48 Gauss-Legendre nodes, good to half the digits. Costs 2 s.
std::vector<double> preciseSingularValues(double width_m, int count);

}  // namespace strainfinger::bench
