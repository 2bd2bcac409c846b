#include "host/contact/spectral.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "host/contact/influence.hpp"
#include "host/contact/surface_motion.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

EdgeExponents pressureEdges(const SurfaceKernel& kernel, double friction) {
  const double shift = kernel.edgeShift(friction);
  return {0.5 + shift, 0.5 - shift};
}

bool needsSign(const SurfaceKernel& kernel) { return kernel.annulus().poisson_ratio != 0.5; }

/// The pressure below the edge of a wedge, if that is on the patch.
EdgePressure edgePressure(const Indenter& indenter, const Patch& patch,
                          const model::Annulus<double>& annulus) {
  const double position = -patch.centre_rad / patch.half_rad;
  if (indenter.edgeSlope() == 0 || !(std::abs(position) < 1)) return {};
  const double modulus_pa = 2 * annulus.shear_modulus_pa / (1 - annulus.poisson_ratio);
  return {position, indenter.edgeSlope() * modulus_pa / std::numbers::pi};
}

}  // namespace

double PatchSolution::tail() const {
  double worst = 0;
  for (const PatchTractions& part : tractions) {
    const VectorXd& c = part.smooth.coefficients;
    const double largest = std::max(c.cwiseAbs().maxCoeff(), std::abs(part.edge.amplitude_pa));
    if (largest > 0) worst = std::max(worst, c.tail(3).cwiseAbs().maxCoeff() / largest);
  }
  return worst;
}

/// The equations of one solve. Unknowns: coefficients of the pressures (patch by patch) [pressureUnit_pa], of
/// the shears, lifts and tilts, the shift [lengthUnit_m]; equations: u_r, u_t, the tangential load.
class SpectralSolver::Assembly {
 public:
  Assembly(const SpectralSolver& solver, const std::vector<Patch>& patches, const Indenter& indenter);

  PatchSolution solve(double tangential_n_per_m);

 private:
  Index patchCount() const { return static_cast<Index>(patches_.size()); }
  Index rows() const { return solver_.pressure_.points().size(); }
  Index firstShear() const { return patchCount() * solver_.terms(); }
  Index firstLift() const {
    return firstShear() + (solver_.shear_ ? patchCount() * solver_.shear_->terms() : 0);
  }
  void fillPressure(Index at, Index from);
  void fillShear(Index at, Index from);
  void fillRigid(Index at);
  void fillProfile(Index at, const SurfaceMotion& edges);
  void fillTangentialLoad(double tangential_n_per_m);
  PatchSolution unpack(const VectorXd& unknowns) const;

  const SpectralSolver& solver_;
  const std::vector<Patch>& patches_;
  const Indenter& indenter_;
  Tractions edges_;
  double lengthUnit_m_, pressureUnit_pa_;
  MatrixXd matrix_;
  VectorXd right_;
};

SpectralSolver::Assembly::Assembly(const SpectralSolver& solver, const std::vector<Patch>& patches,
                                   const Indenter& indenter)
    : solver_(solver), patches_(patches), indenter_(indenter) {
  const model::Annulus<double>& annulus = solver.kernel_.annulus();
  double largest = 0;
  bool hasEdge = false;
  for (const Patch& patch : patches) {
    largest = std::max(largest, patch.half_rad);
    edges_.push_back({patch, {}, edgePressure(indenter, patch, annulus), solver.friction_, {}});
    hasEdge |= edges_.back().edge.amplitude_pa != 0;
  }
  if (!hasEdge) edges_.clear();
  pressureUnit_pa_ = annulus.shear_modulus_pa * largest;
  lengthUnit_m_ = annulus.outer_radius_m * largest * largest;
  const Index size = firstLift() + 2 * patchCount() + (solver.shear_ ? 1 : 0);
  matrix_ = MatrixXd::Zero(size, size);
  right_ = VectorXd::Zero(size);
}

PatchSolution SpectralSolver::Assembly::solve(double tangential_n_per_m) {
  const SurfaceMotion edges(solver_.kernel_, edges_);
  for (Index at = 0; at < patchCount(); ++at) {
    for (Index from = 0; from < patchCount(); ++from) {
      fillPressure(at, from);
      if (solver_.shear_) fillShear(at, from);
    }
    fillRigid(at);
    fillProfile(at, edges);
  }
  if (solver_.shear_) fillTangentialLoad(tangential_n_per_m);
  return unpack(matrix_.partialPivLu().solve(right_));
}

void SpectralSolver::Assembly::fillPressure(Index at, Index from) {
  const auto& [kernel, friction, pressure, shear] =
      std::tie(solver_.kernel_, solver_.friction_, solver_.pressure_, solver_.shear_);
  const Patch &here = patches_[static_cast<std::size_t>(at)],
              &there = patches_[static_cast<std::size_t>(from)];
  const double unit = pressureUnit_pa_ / lengthUnit_m_;
  const Reflection& reflection = kernel.reflection();
  matrix_.block(at * rows(), from * pressure.terms(), rows(), pressure.terms()) =
      unit * influence(kernel, {-1, friction, reflection.normal}, pressure, there, pressure.points(), here);
  if (shear)
    matrix_.block((patchCount() + at) * rows(), from * pressure.terms(), rows(), pressure.terms()) =
        unit * influence(kernel, {0, 1, reflection.sheared}, pressure, there, pressure.points(), here);
}

void SpectralSolver::Assembly::fillShear(Index at, Index from) {
  const ReferencePatch& shear = *solver_.shear_;
  const Patch &here = patches_[static_cast<std::size_t>(at)],
              &there = patches_[static_cast<std::size_t>(from)];
  const double unit = pressureUnit_pa_ / lengthUnit_m_;
  const Reflection& reflection = solver_.kernel_.reflection();
  const Index column = firstShear() + from * shear.terms();
  matrix_.block(at * rows(), column, rows(), shear.terms()) =
      unit * influence(solver_.kernel_, {0, 1, reflection.normal}, shear, there, shear.points(), here);
  matrix_.block((patchCount() + at) * rows(), column, rows(), shear.terms()) =
      unit * influence(solver_.kernel_, {1, 0, reflection.sheared}, shear, there, shear.points(), here);
}

void SpectralSolver::Assembly::fillRigid(Index at) {
  matrix_.block(at * rows(), firstLift() + at, rows(), 1).setConstant(-1);
  matrix_.block(at * rows(), firstLift() + patchCount() + at, rows(), 1) = -solver_.pressure_.points();
  if (solver_.shear_)
    matrix_.block((patchCount() + at) * rows(), matrix_.cols() - 1, rows(), 1).setConstant(-1);
}

void SpectralSolver::Assembly::fillProfile(Index at, const SurfaceMotion& edges) {
  const Patch& patch = patches_[static_cast<std::size_t>(at)];
  const double radius_m = solver_.kernel_.annulus().outer_radius_m;
  for (Index i = 0; i < rows(); ++i) {
    const double angle_rad = patch.centre_rad + patch.half_rad * solver_.pressure_.points()[i];
    const SurfacePoint known = edges_.empty() ? SurfacePoint{} : edges.displacementAt(angle_rad);
    const double profile_m = radius_m * angle_rad * angle_rad / 2 + indenter_.height(radius_m * angle_rad);
    right_[at * rows() + i] = (profile_m - known.ur_m) / lengthUnit_m_;
    if (solver_.shear_) right_[(patchCount() + at) * rows() + i] = -known.ut_m / lengthUnit_m_;
  }
}

void SpectralSolver::Assembly::fillTangentialLoad(double tangential_n_per_m) {
  const ReferencePatch& shear = *solver_.shear_;
  const Index row = matrix_.rows() - 1;
  const double integral = EdgeSeries{shear.exponents(), VectorXd::Ones(1)}.integral();
  double scale = 0;
  for (const Patch& patch : patches_) scale = std::max(scale, patch.half_rad);
  for (Index l = 0; l < patchCount(); ++l)
    matrix_(row, firstShear() + l * shear.terms()) =
        integral * patches_[static_cast<std::size_t>(l)].half_rad / scale;
  right_[row] = tangential_n_per_m / (solver_.kernel_.annulus().outer_radius_m * pressureUnit_pa_ * scale);
}

PatchSolution SpectralSolver::Assembly::unpack(const VectorXd& unknowns) const {
  PatchSolution solution;
  for (Index l = 0; l < patchCount(); ++l) {
    const auto index = static_cast<std::size_t>(l);
    PatchTractions part{patches_[index], {}, {}, solver_.friction_, {}};
    if (!edges_.empty()) part.edge = edges_[index].edge;
    part.smooth = {solver_.pressure_.exponents(),
                   pressureUnit_pa_ * unknowns.segment(l * solver_.terms(), solver_.terms())};
    if (solver_.shear_)
      part.stuck = {solver_.shear_->exponents(),
                    pressureUnit_pa_ * unknowns.segment(firstShear() + l * solver_.shear_->terms(),
                                                        solver_.shear_->terms())};
    solution.tractions.push_back(part);
  }
  solution.lift_m = lengthUnit_m_ * unknowns.segment(firstLift(), patchCount());
  solution.tilt_m = lengthUnit_m_ * unknowns.segment(firstLift() + patchCount(), patchCount());
  if (solver_.shear_) solution.shift_m = lengthUnit_m_ * unknowns[unknowns.size() - 1];
  return solution;
}

SpectralSolver::SpectralSolver(const SurfaceKernel& kernel, Regime regime, double friction, int terms)
    : kernel_(kernel),
      friction_(regime == Regime::kSliding ? friction : 0),
      pressure_(pressureEdges(kernel, friction_), terms, terms + 2, needsSign(kernel)) {
  if (regime == Regime::kStick) shear_.emplace(kStuckEdges, terms + 2, terms + 2, needsSign(kernel));
}

PatchSolution SpectralSolver::solve(const std::vector<Patch>& patches, const Indenter& indenter,
                                    double tangential_n_per_m) const {
  return Assembly(*this, patches, indenter).solve(tangential_n_per_m);
}

}  // namespace strainfinger::contact
