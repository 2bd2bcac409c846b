#pragma once
// An indenter pressed on the finger: where they touch, what acts there, and how well it is known.

#include <optional>
#include <string>
#include <vector>

#include "host/contact/spectral.hpp"

namespace strainfinger::contact {

/// What is given besides the indenter: how wide the contact is, or how much it carries.
struct ContactSize {
  enum class Kind { kWidth, kLoad };
  Kind kind;
  double value;  ///< arc from the first to the last edge [m], or normal load [N/m]
};

struct ContactRequest {
  Indenter indenter = Indenter::flat();
  Regime regime = Regime::kFrictionless;
  double friction = 0;            ///< of kSliding; negative: towards -theta
  double tangential_n_per_m = 0;  ///< of kStick: the load sidewards, positive towards +theta
  ContactSize size{ContactSize::Kind::kWidth, 2e-3};
  /// The contact's centre from the indenter's normal, if it is held there: the indenter has to turn then, or
  /// the answer doesn't fit it. Left out, the contact is where it fits.
  std::optional<double> centre_rad;
};

struct Contact {
  Tractions tractions;  ///< angles from the indenter's normal
  double normal_n_per_m = 0;
  double tangential_n_per_m = 0;
  double width_m = 0;     ///< arc from the first edge to the last
  double depth_m = 0;     ///< of the indenter's profile below the undeformed surface, at the contact's centre
  double approach_m = 0;  ///< the same at the indenter's normal: u_r = -approach + x^2 / (2 r_b) + height(x)
  double deepest_m = 0;   ///< how far below the undeformed surface the contact reaches anywhere
  double shift_m = 0;     ///< u_t of what sticks
  double offset_rad = 0;  ///< the contact's centre, from the indenter's normal
  /// How far the surface is from the indenter (what sticks: also from its sideward shift) at worst,
  /// recomputed from the tractions by SurfaceMotion at places where the solver did not look.
  double residual_m = 0;
  int terms = 0;                      ///< of each patch's series
  std::vector<std::string> warnings;  ///< what is ill-posed or inaccurate about it
};

/// Widest contact [rad of surface]: half a revolution.
inline constexpr double kWidestContact_rad = 3.141592653589793;

/// Solves for tractions and edges (Newton, each step a SpectralSolver::solve()).
/// Domain: 0 < width <= kWidestContact_rad r_b, load > 0, |friction| <= 10.
/// Throws Failure(kUsage) outside it, and Failure(kFailure) if the load needs a wider contact, if the contact
/// reaches the end of a measured shape, if no contact fits, if the layer is too thin for its width, or if it
/// sticks below nu = 1/2 and has no load of its own (limits.md).
/// Error for nu = 1/2 and a flat indenter, a cylinder or a wedge: 1e-12 of load, width and peak pressure,
/// 1e-10 rad of the offset; nu < 1/2: 1e-6. Stick below nu = 1/2 is ill-posed and tells by how much
/// (limits.md). residual_m tells. Costs 0.2 ms for a flat indenter of 2 mm in the default finger, 0.3 ms if
/// the load is given.
Contact solveContact(const SurfaceKernel& kernel, const ContactRequest& request);

}  // namespace strainfinger::contact
