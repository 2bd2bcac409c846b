#pragma once
// How the surface moves under tractions on it, in closed form but for the few harmonics that the core
// reflects.

#include <Eigen/Core>

#include "host/model/annulus.hpp"

namespace strainfinger::contact {

/// A kernel at a distance psi [rad]: log * ln|psi| + sgn * sign(psi) + smooth, each of the three analytic.
struct KernelParts {
  double log = 0;
  double sgn = 0;
  double smooth = 0;
};

/// The same of a mix of kernels between many places: a row where it is looked, a column where it acts.
struct KernelTable {
  Eigen::ArrayXXd log, sgn, smooth;
};

/// Something of both kernels at a distance psi != 0.
struct KernelPair {
  double even = 0;
  double odd = 0;
};

/// What the core reflects of each harmonic, n = 0 and 1 whole, per unit Fourier coefficient [m/Pa]: u_r of a
/// normal and u_t of a tangential traction along themselves (cosines of cosines), and u_r of a tangential,
/// u_t of a normal one (sines of cosines).
struct Reflection {
  Eigen::VectorXd normal;
  Eigen::VectorXd coupling;
  Eigen::VectorXd sheared;
};

/// The displacements at r_b per radian of traction, psi = angle of the point - angle of the traction:
///     u_r = int [-even(psi) pressure + odd(psi) shear] dphi + reflection, pressure positive when pressing,
///     u_t = int [ odd(psi) pressure + even(psi) shear] dphi + reflection, shear positive towards +theta.
///
/// A harmonic n >= 2 of the traction moves the surface by s [kappa/(n+1) + 1/(n-1)] along itself and by
/// s [1/(n-1) - kappa/(n+1)] across, s = r_b / 4 mu, and a rest that falls like n^2 alpha^2n. Those sum to,
/// with C = -ln(2 sin |psi|/2), S = sgn(psi) (pi - |psi|)/2:
///     even = (s/pi) [(kappa+1) cos psi C + (kappa-1) sin psi S - kappa (1 + cos(psi)/2)]
///     odd  = (s/pi) [(kappa+1) sin psi C - (kappa-1) cos psi S + kappa sin(psi)/2]
class SurfaceKernel {
 public:
  /// Domain: an annulus within its own domain. The reflection is summed until it is rounding: 72 harmonics
  /// for alpha = 0.70, 2521 for 0.99; 0.2 us each.
  explicit SurfaceKernel(const model::Annulus<double>& annulus);

  KernelParts even(double angle_rad) const;  ///< angle in -pi..pi [m/Pa]
  KernelParts odd(double angle_rad) const;
  /// even * even() + odd * odd() from places to places, at most pi apart, in a tenth of the time a pair.
  KernelTable table(double even, double odd, const Eigen::ArrayXd& at_rad,
                    const Eigen::ArrayXd& from_rad) const;

  KernelPair valuesAt(double angle_rad) const;  ///< as a whole, by C and S [m/Pa]
  /// Their derivatives to psi [m/(Pa rad)]. At psi = 0 that of odd has besides a delta function of oddStep().
  KernelPair slopesAt(double angle_rad) const;
  double oddStep() const;   ///< by how much odd jumps at psi = 0 [m/Pa]
  double evenPole() const;  ///< factor of cot(psi/2)/2 in the slope of even [m/Pa]

  const Reflection& reflection() const { return reflection_; }
  const model::Annulus<double>& annulus() const { return annulus_; }

  /// tan(pi e) = friction (1 - 2 nu) / (2 - 2 nu): a contact that slides towards +theta has pressures that
  /// fall with the power 1/2 + e at its edge on the +theta side and 1/2 - e at the other.
  double edgeShift(double friction) const;

 private:
  model::Annulus<double> annulus_;
  double scale_;  // s / pi
  double kappa_;
  Reflection reflection_;
};

}  // namespace strainfinger::contact
