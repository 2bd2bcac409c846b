#pragma once
// The edges of a contact: those at which tractions that vanish there fit the indenter.

#include <vector>

#include "host/contact/contact.hpp"

namespace strainfinger::contact {

struct EdgeResult {
  std::vector<Patch> patches;
  PatchSolution solution;
  /// kCollide: two patches run into each other, or one vanishes; kLost: no edges fit.
  enum class Outcome { kSettled, kCollide, kLost } outcome = Outcome::kSettled;
  /// Of the misfits, by the unknowns about these patches, as it was last known; none if nothing is unknown.
  Eigen::MatrixXd jacobian{};
};

/// Moves patches until every tilt is 0, all lifts are the same and the size is what is asked for. Unknowns: a
/// centre and a half width a patch, less what is known (width given: the half width; symmetric, or held: the
/// centre).
class EdgeSearch {
 public:
  /// Keeps references to all three.
  EdgeSearch(const SurfaceKernel& kernel, const SpectralSolver& solver, const ContactRequest& request);

  /// Newton's method, its Jacobian as given, if it fits, or by differences once; then by Broyden's updates. 1
  /// solve for a symmetric contact of given width, about 6 for one of given load. Throws Failure(kFailure)
  /// if the contact grows beyond the indenter or half the surface.
  EdgeResult run(const std::vector<Patch>& guess, const Eigen::MatrixXd& jacobian = {}) const;

 private:
  struct State;
  State evaluate(const Eigen::VectorXd& unknowns, const std::vector<Patch>& guess) const;
  Eigen::MatrixXd differences(const State& state, const std::vector<Patch>& guess) const;
  Eigen::MatrixXd aboutPatches(Eigen::MatrixXd jacobian, const std::vector<Patch>& patches,
                               const std::vector<Patch>& guess) const;
  std::vector<Patch> patchesOf(const Eigen::VectorXd& unknowns, const std::vector<Patch>& guess) const;
  Eigen::VectorXd misfits(const std::vector<Patch>& patches, const PatchSolution& solution) const;
  bool movesCentre(std::size_t patches) const;
  bool changesWidth(std::size_t patches) const;
  bool areWithin(const std::vector<Patch>& patches) const;
  void requireWithin(const std::vector<Patch>& patches) const;
  bool areApart(const std::vector<Patch>& patches) const;

  const SurfaceKernel& kernel_;
  const SpectralSolver& solver_;
  const ContactRequest& request_;
};

}  // namespace strainfinger::contact
