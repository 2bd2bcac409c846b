#pragma once
// Displacements on one patch per coefficient of the tractions on another.

#include <Eigen/Core>

#include "host/contact/reference_patch.hpp"
#include "host/contact/surface_kernel.hpp"
#include "host/contact/tractions.hpp"

namespace strainfinger::contact {

/// A displacement as a sum of what the even and what the odd kernel make of a traction; `reflected` belongs
/// to the even one.
struct KernelMix {
  double even;
  double odd;
  const Eigen::VectorXd& reflected;
};

/// Row i, column k: the displacement [m/Pa] at point i of `reference` on `at` of the k-th weighted polynomial
/// of `source` on `from`.
Eigen::MatrixXd influence(const SurfaceKernel& kernel, const KernelMix& mix, const ReferencePatch& source,
                          const Patch& from, const Eigen::VectorXd& points, const Patch& at);

}  // namespace strainfinger::contact
