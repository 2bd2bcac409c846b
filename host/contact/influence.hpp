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

/// What moves a patch's points under tractions at nodes of the same patch, looked up once for all densities
/// that are known at these nodes.
class OwnInfluence {
 public:
  /// Keeps references to the kernel and the reflection. Costs 15 us for 16 points and 30 nodes.
  OwnInfluence(const SurfaceKernel& kernel, const KernelMix& mix, const Eigen::VectorXd& points,
               const Eigen::VectorXd& nodes, double half_rad);

  /// Row i, column k: the displacement [m/Pa] at point i of the k-th density. Domain: rules for the points
  /// and nodes given.
  Eigen::MatrixXd of(const PatchRules& rules) const;

 private:
  const SurfaceKernel& kernel_;
  KernelMix mix_;
  double half_rad_;
  Eigen::ArrayXXd log_, smooth_;
};

/// Row i, column k: the displacement [m/Pa] at point i on `at` of the k-th weighted polynomial of `source` on
/// `from`, which doesn't overlap with it.
Eigen::MatrixXd influence(const SurfaceKernel& kernel, const KernelMix& mix, const ReferencePatch& source,
                          const Patch& from, const Eigen::VectorXd& points, const Patch& at);

}  // namespace strainfinger::contact
