#include "host/contact/spectral.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/contact/decompositions.hpp"
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

}  // namespace

double PatchSolution::tail() const {
  double worst = 0;
  for (const PatchTractions& part : tractions) {
    const VectorXd& c = part.smooth.coefficients;
    double largest = c.cwiseAbs().maxCoeff();
    if (part.tip.isThere()) largest = std::max(largest, std::abs(part.tip.log[0]));
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
  void fillOwn(Index at);
  void fillOther(Index at, Index from);
  void fillRigid(Index at);
  void fillProfile(Index at);
  void fillStep(Index at);  ///< where the tip's tractions have one: numerically
  void fillTangentialLoad(double tangential_n_per_m);
  PatchSolution unpack(const VectorXd& unknowns) const;

  const SpectralSolver& solver_;
  const std::vector<Patch>& patches_;
  const Indenter& indenter_;
  Tractions tips_;  ///< what is known of the tractions
  double lengthUnit_m_, pressureUnit_pa_;
  MatrixXd matrix_;
  VectorXd right_;
};

SpectralSolver::Assembly::Assembly(const SpectralSolver& solver, const std::vector<Patch>& patches,
                                   const Indenter& indenter)
    : solver_(solver), patches_(patches), indenter_(indenter) {
  const model::Annulus<double>& annulus = solver.kernel_.annulus();
  double largest = 0;
  for (const Patch& patch : patches) {
    largest = std::max(largest, patch.half_rad);
    TipTractions tip = tipTractions(solver.kernel_, indenter, solver.regime_, solver.friction_, patch);
    tips_.push_back({patch, {}, std::move(tip.pressure), solver.friction_, {}, std::move(tip.stuck)});
  }
  pressureUnit_pa_ = annulus.shear_modulus_pa * largest;
  lengthUnit_m_ = annulus.outer_radius_m * largest * largest;
  const Index size = firstLift() + 2 * patchCount() + (solver.shear_ ? 1 : 0);
  matrix_ = MatrixXd::Zero(size, size);
  right_ = VectorXd::Zero(size);
}

PatchSolution SpectralSolver::Assembly::solve(double tangential_n_per_m) {
  for (Index at = 0; at < patchCount(); ++at) {
    fillOwn(at);
    for (Index from = 0; from < patchCount(); ++from)
      if (from != at) fillOther(at, from);
    fillRigid(at);
    fillProfile(at);
    if (tips_[static_cast<std::size_t>(at)].tip.step.size() > 0) fillStep(at);
  }
  if (solver_.shear_) fillTangentialLoad(tangential_n_per_m);
  return unpack(luSolution(matrix_, right_));
}

// Tangential displacements only where something sticks.
void SpectralSolver::Assembly::fillOwn(Index at) {
  const SurfaceKernel& kernel = solver_.kernel_;
  const ReferencePatch &pressure = solver_.pressure_, &nodes = solver_.shear_ ? *solver_.shear_ : pressure;
  const PatchTractions& known = tips_[static_cast<std::size_t>(at)];
  const auto own = [&](const KernelMix& mix) {
    return OwnInfluence(kernel, mix, pressure.points(), nodes.rules().rule.nodes, known.patch.half_rad);
  };
  const bool hasTip = known.tip.isThere() && known.tip.step.size() == 0;
  const PatchRules tip = hasTip ? tipRules({known.tip, known.stuckTip}, nodes) : PatchRules{};
  const double unit = pressureUnit_pa_ / lengthUnit_m_;
  const Index row = at * rows(), column = at * pressure.terms();
  const OwnInfluence normal = own({-1, solver_.friction_, kernel.reflection().normal});
  matrix_.block(row, column, rows(), pressure.terms()) = unit * normal.of(pressure.rules());
  if (hasTip) right_.segment(row, rows()) -= normal.of(tip).col(0) / lengthUnit_m_;
  if (!solver_.shear_) return;
  const Index rowT = (patchCount() + at) * rows(), columnT = firstShear() + at * nodes.terms();
  const OwnInfluence across = own({0, 1, kernel.reflection().normal}),
                     along = own({1, 0, kernel.reflection().sheared});
  matrix_.block(rowT, column, rows(), pressure.terms()) = unit * across.of(pressure.rules());
  matrix_.block(row, columnT, rows(), nodes.terms()) = unit * across.of(nodes.rules());
  matrix_.block(rowT, columnT, rows(), nodes.terms()) = unit * along.of(nodes.rules());
  if (!hasTip) return;
  const MatrixXd acrossTip = across.of(tip), alongTip = along.of(tip);
  right_.segment(row, rows()) -= acrossTip.col(1) / lengthUnit_m_;
  right_.segment(rowT, rows()) -= (acrossTip.col(0) + alongTip.col(1)) / lengthUnit_m_;
}

void SpectralSolver::Assembly::fillOther(Index at, Index from) {
  const SurfaceKernel& kernel = solver_.kernel_;
  const Reflection& reflection = kernel.reflection();
  const Patch &here = patches_[static_cast<std::size_t>(at)],
              &there = patches_[static_cast<std::size_t>(from)];
  const auto fill = [&](Index row, Index column, const KernelMix& mix, const ReferencePatch& source) {
    matrix_.block(row * rows(), column, rows(), source.terms()) =
        pressureUnit_pa_ / lengthUnit_m_ * influence(kernel, mix, source, there, source.points(), here);
  };
  const ReferencePatch& pressure = solver_.pressure_;
  const Index p = from * pressure.terms();
  fill(at, p, {-1, solver_.friction_, reflection.normal}, pressure);
  if (!solver_.shear_) return;
  const Index q = firstShear() + from * solver_.shear_->terms(), atT = patchCount() + at;
  fill(at, q, {0, 1, reflection.normal}, *solver_.shear_);
  fill(atT, p, {0, 1, reflection.sheared}, pressure);
  fill(atT, q, {1, 0, reflection.sheared}, *solver_.shear_);
}

void SpectralSolver::Assembly::fillRigid(Index at) {
  matrix_.block(at * rows(), firstLift() + at, rows(), 1).setConstant(-1);
  matrix_.block(at * rows(), firstLift() + patchCount() + at, rows(), 1) = -solver_.pressure_.points();
  if (solver_.shear_)
    matrix_.block((patchCount() + at) * rows(), matrix_.cols() - 1, rows(), 1).setConstant(-1);
}

void SpectralSolver::Assembly::fillProfile(Index at) {
  const Patch& patch = patches_[static_cast<std::size_t>(at)];
  const double radius_m = solver_.kernel_.annulus().outer_radius_m;
  for (Index i = 0; i < rows(); ++i) {
    const double angle_rad = patch.centre_rad + patch.half_rad * solver_.pressure_.points()[i];
    const double profile_m = radius_m * angle_rad * angle_rad / 2 + indenter_.height(radius_m * angle_rad);
    right_[at * rows() + i] += profile_m / lengthUnit_m_;
  }
}

void SpectralSolver::Assembly::fillStep(Index at) {
  const PatchTractions& part = tips_[static_cast<std::size_t>(at)];
  const SurfaceMotion motion(solver_.kernel_, {part});
  for (Index i = 0; i < rows(); ++i) {
    const double x = solver_.pressure_.points()[i];
    const SurfacePoint point = motion.displacementAt(part.patch.centre_rad + part.patch.half_rad * x);
    right_[at * rows() + i] -= point.ur_m / lengthUnit_m_;
    if (solver_.shear_) right_[(patchCount() + at) * rows() + i] -= point.ut_m / lengthUnit_m_;
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
  const double radius_m = solver_.kernel_.annulus().outer_radius_m;
  right_[row] = (tangential_n_per_m / radius_m - totalTraction(tips_).shear_pa) / (pressureUnit_pa_ * scale);
}

PatchSolution SpectralSolver::Assembly::unpack(const VectorXd& unknowns) const {
  PatchSolution solution;
  for (Index l = 0; l < patchCount(); ++l) {
    const auto index = static_cast<std::size_t>(l);
    PatchTractions part = tips_[index];
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
      regime_(regime),
      friction_(regime == Regime::kSliding ? friction : 0),
      pressure_(pressureEdges(kernel, friction_), terms, terms + 2, needsSign(kernel)) {
  if (regime != Regime::kStick) return;
  shear_.emplace(kStuckEdges, terms + 2, terms + 2, needsSign(kernel));
  pressure_ = pressure_.atNodesOf(*shear_);
}

PatchSolution SpectralSolver::solve(const std::vector<Patch>& patches, const Indenter& indenter,
                                    double tangential_n_per_m) const {
  return Assembly(*this, patches, indenter).solve(tangential_n_per_m);
}

}  // namespace strainfinger::contact
