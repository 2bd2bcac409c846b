#pragma once
// The tractions below the tip of a wedge: what is singular there, with the motion of the surface it makes.

#include "host/contact/indenter.hpp"
#include "host/contact/reference_patch.hpp"
#include "host/contact/regime.hpp"
#include "host/contact/surface_kernel.hpp"
#include "host/contact/tractions.hpp"

namespace strainfinger::contact {

/// Of the pressure, and of what sticks of the shear.
struct TipTractions {
  TipTraction pressure, stuck;
};

/// All that is singular in the tractions on a patch below the jump of the indenter's slope, so that what is
/// left is as smooth as below an indenter without one; empty if the jump is not on the patch.
///
/// Harmonic n -> infinity of |tau|, tau the angle from the tip, is -(2/pi) / n^2; divided by the surface's
/// response (SurfaceKernel) and expanded in powers of 1/n it is a pressure sum a_k / n^(k+1), whose singular
/// part at the tip is -ln(-i tau) sum a_k (i tau)^k / k!: a logarithm times one entire function and a step
/// times another. At nu = 1/2 there is no step.
TipTractions tipTractions(const SurfaceKernel& kernel, const Indenter& indenter, Regime regime,
                          double friction, const Patch& patch);

/// Rules for the logarithms of a tip, one column for the pressure, one for what sticks if there is that, seen
/// at the points of other rules on the same patch, at the same nodes: in closed form but for the analytic
/// factors of the kernel. Domain: tractions without a step; rules of kSmoothEdges or kStuckEdges.
PatchRules tipRules(const TipTractions& tip, const ReferencePatch& same);

}  // namespace strainfinger::contact
