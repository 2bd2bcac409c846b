#pragma once
// The tractions between an indenter and given patches of the surface: a linear problem.

#include <optional>
#include <vector>

#include "host/contact/indenter.hpp"
#include "host/contact/reference_patch.hpp"
#include "host/contact/regime.hpp"
#include "host/contact/surface_kernel.hpp"
#include "host/contact/tractions.hpp"
#include "host/contact/wedge_tip.hpp"

namespace strainfinger::contact {

/// A PatchSolution::tail() from which on more terms change nothing.
inline constexpr double kConverged = 1e-12;

/// Most terms that searches give one patch: what they haven't resolved by then is said to be inaccurate.
inline constexpr int kMostTerms = 160;

/// Terms of each patch on a measured shape that fewer don't resolve.
inline constexpr int kMeasuredTerms = 64;

/// Tractions that vanish at the edges of the patches (shear that sticks: rise there) and make
/// u_r = x^2 / (2 r_b) + height(x) + lift + tilt * (theta - centre) / half on each patch. A patch is a
/// contact region if its tilt is 0 and all lifts are the same, -depth.
struct PatchSolution {
  Tractions tractions;
  Eigen::VectorXd lift_m;  ///< one a patch
  Eigen::VectorXd tilt_m;
  double shift_m = 0;  ///< u_t of what sticks

  /// The last coefficients of the pressures relative to the largest: below kConverged where the series did.
  double tail() const;
};

/// Collocation at terms + 2 Chebyshev points of series of `terms` weighted polynomials for the pressure and
/// terms + 2 for shear that sticks. The kernel's logarithm and sign are integrated in closed form or exactly,
/// the rest by Gauss's rule; between patches the double exponential rule serves.
///
/// Convergence: exponential for nu = 1/2 and an indenter that is smooth on the patches (relative error of the
/// load at 2 mm in the default finger: 4 terms 3e-6, 8 6e-11, 12 1e-14); algebraic otherwise.
class SpectralSolver {
 public:
  /// Domain: 4 <= terms; friction counts in sliding only. Keeps a reference to the kernel.
  SpectralSolver(const SurfaceKernel& kernel, Regime regime, double friction, int terms);

  /// Patches in rising order without overlap, each of at most half a revolution. tangential_n_per_m is what
  /// shear that sticks adds up to. Costs 60 us for a patch and 16 terms.
  PatchSolution solve(const std::vector<Patch>& patches, const Indenter& indenter,
                      double tangential_n_per_m) const;

  int terms() const { return pressure_.terms(); }

 private:
  class Assembly;

  const SurfaceKernel& kernel_;
  Regime regime_;
  double friction_;
  ReferencePatch pressure_;
  std::optional<ReferencePatch> shear_;
};

}  // namespace strainfinger::contact
