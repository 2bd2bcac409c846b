#include "host/contact/edge_search.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/base/failure.hpp"
#include "host/contact/decompositions.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr int kMostSteps = 40;
constexpr double kDifference = 1e-6;  // of a half width
constexpr double kSmallStep = 2e-13;  // of a half width
constexpr double kFits = 1e-9;        // misfit that an answer may have
constexpr double kVanished = 1e-8;    // half width of a patch, of the whole contact's width
constexpr double kSlow = 0.3;         // of the misfit is left: Broyden's updates don't do
constexpr int kMostHalvings = 6;

/// The logarithm, and its tangent where ratios are small or below 0, as the load of a bad guess may be.
double logarithmAbove(double ratio) {
  constexpr double kLeast = 0.1;
  return ratio > kLeast ? std::log(ratio) : std::log(kLeast) + ratio / kLeast - 1;
}

double worstOf(const VectorXd& values) { return values.cwiseAbs().maxCoeff(); }

}  // namespace

/// Unknowns are changes in half widths of the guess: of the centre, and of the logarithm of the half width.
struct EdgeSearch::State {
  VectorXd unknowns;
  EdgeResult result;
  VectorXd misfits;
};

EdgeSearch::EdgeSearch(const SurfaceKernel& kernel, const SpectralSolver& solver,
                       const ContactRequest& request)
    : kernel_(kernel), solver_(solver), request_(request) {}

bool EdgeSearch::movesCentre(std::size_t patches) const {
  if (patches > 1) return true;
  const bool isSymmetric = request_.indenter.isSymmetric() &&
                           (request_.regime == Regime::kFrictionless ||
                            (request_.regime == Regime::kSliding && request_.friction == 0) ||
                            (request_.regime == Regime::kStick && request_.tangential_n_per_m == 0));
  return !request_.centre_rad && !isSymmetric;
}

bool EdgeSearch::changesWidth(std::size_t patches) const {
  return patches > 1 || request_.size.kind == ContactSize::Kind::kLoad;
}

std::vector<Patch> EdgeSearch::patchesOf(const VectorXd& unknowns, const std::vector<Patch>& guess) const {
  std::vector<Patch> patches = guess;
  Index next = 0;
  for (Patch& patch : patches) {
    if (movesCentre(guess.size())) patch.centre_rad += patch.half_rad * unknowns[next++];
    if (changesWidth(guess.size())) patch.half_rad *= std::exp(unknowns[next++]);
  }
  return patches;
}

VectorXd EdgeSearch::misfits(const std::vector<Patch>& patches, const PatchSolution& solution) const {
  const double radius_m = kernel_.annulus().outer_radius_m;
  const double width_rad = patches.back().last_rad() - patches.front().first_rad();
  const double unit_m =
      radius_m * (width_rad * width_rad / 4 + request_.indenter.edgeSlope() * width_rad / 2);
  std::vector<double> misfits;
  for (std::size_t k = 0; k < patches.size(); ++k) {
    const auto index = static_cast<Index>(k);
    if (movesCentre(patches.size())) misfits.push_back(solution.tilt_m[index] / unit_m);
    if (k > 0) misfits.push_back((solution.lift_m[index] - solution.lift_m[0]) / unit_m);
  }
  if (changesWidth(patches.size())) {
    const double size = request_.size.kind == ContactSize::Kind::kWidth
                            ? radius_m * width_rad
                            : radius_m * totalTraction(solution.tractions).pressure_pa;
    misfits.push_back(logarithmAbove(size / request_.size.value));
  }
  return Eigen::Map<VectorXd>(misfits.data(), static_cast<Index>(misfits.size()));
}

bool EdgeSearch::areWithin(const std::vector<Patch>& patches) const {
  const double radius_m = kernel_.annulus().outer_radius_m;
  const double first_rad = patches.front().first_rad(), last_rad = patches.back().last_rad();
  return last_rad - first_rad <= kWidestContact_rad &&
         radius_m * first_rad >= request_.indenter.firstPosition_m() &&
         radius_m * last_rad <= request_.indenter.lastPosition_m();
}

void EdgeSearch::requireWithin(const std::vector<Patch>& patches) const {
  if (areWithin(patches)) return;
  const double radius_m = kernel_.annulus().outer_radius_m;
  const double first_rad = patches.front().first_rad(), last_rad = patches.back().last_rad();
  if (!(last_rad - first_rad <= kWidestContact_rad))
    throw Failure(ExitCode::kFailure, "no contact found: the load needs one wider than half the surface");
  throw Failure(
      ExitCode::kFailure,
      fmt::format("the contact, {:.6g} to {:.6g} m, reaches beyond the measured shape, {} to {} m: measure "
                  "more of it, or press less",
                  radius_m * first_rad, radius_m * last_rad, request_.indenter.firstPosition_m(),
                  request_.indenter.lastPosition_m()));
}

/// Whether patches are in order, and none has all but vanished.
bool EdgeSearch::areApart(const std::vector<Patch>& patches) const {
  const double width_rad = patches.back().last_rad() - patches.front().first_rad();
  for (std::size_t k = 0; k < patches.size(); ++k)
    if (patches[k].half_rad < kVanished * width_rad ||
        (k > 0 && !(patches[k].first_rad() > patches[k - 1].last_rad())))
      return false;
  return true;
}

EdgeSearch::State EdgeSearch::evaluate(const VectorXd& unknowns, const std::vector<Patch>& guess) const {
  State state{unknowns, {patchesOf(unknowns, guess), {}, {}}, {}};
  requireWithin(state.result.patches);
  state.result.solution = solver_.solve(state.result.patches, request_.indenter, request_.tangential_n_per_m);
  state.misfits = misfits(state.result.patches, state.result.solution);
  return state;
}

MatrixXd EdgeSearch::differences(const State& state, const std::vector<Patch>& guess) const {
  const Index count = state.unknowns.size();
  MatrixXd jacobian(count, count);
  for (Index i = 0; i < count; ++i) {
    VectorXd moved = state.unknowns;
    moved[i] -= kDifference;  // inwards: the widest contact stays within its domain
    jacobian.col(i) = (state.misfits - evaluate(moved, guess).misfits) / kDifference;
  }
  return jacobian;
}

// A centre moves by half widths of the guess, so by others about other patches.
MatrixXd EdgeSearch::aboutPatches(MatrixXd jacobian, const std::vector<Patch>& patches,
                                  const std::vector<Patch>& guess) const {
  if (!movesCentre(patches.size())) return jacobian;
  const Index step = changesWidth(patches.size()) ? 2 : 1;
  for (std::size_t k = 0; k < patches.size(); ++k)
    jacobian.col(static_cast<Index>(k) * step) *= patches[k].half_rad / guess[k].half_rad;
  return jacobian;
}

EdgeResult EdgeSearch::run(const std::vector<Patch>& guess, const MatrixXd& known) const {
  const auto count =
      static_cast<Index>(guess.size()) * (movesCentre(guess.size()) + changesWidth(guess.size()));
  State state = evaluate(VectorXd::Zero(count), guess);
  if (count == 0) return state.result;
  MatrixXd jacobian = known.cols() == count ? known : differences(state, guess);
  for (int step = 0; step < kMostSteps; ++step) {
    VectorXd move = -luSolution(jacobian, state.misfits);
    move *= std::min(1.0, 0.5 / worstOf(move));
    for (int half = 0; half < kMostHalvings; ++half) {
      const std::vector<Patch> moved = patchesOf(state.unknowns + move, guess);
      if (areApart(moved) && areWithin(moved)) break;
      move /= 2;
    }
    if (!areApart(patchesOf(state.unknowns + move, guess))) {
      state.result.outcome = EdgeResult::Outcome::kCollide;
      return state.result;
    }
    State next = evaluate(state.unknowns + move, guess);
    const double misfit = worstOf(state.misfits), left = worstOf(next.misfits);
    if (count > 2 && left > kSlow * misfit && left > kFits)
      jacobian = differences(next, guess);
    else
      jacobian += (next.misfits - state.misfits - jacobian * move) * move.transpose() / move.squaredNorm();
    state = std::move(next);
    if (left < kSmallStep || worstOf(move) < kSmallStep ||
        (left < kFits && misfit < kFits && left > misfit / 2))
      break;
  }
  if (!(worstOf(state.misfits) < kFits)) state.result.outcome = EdgeResult::Outcome::kLost;
  state.result.jacobian = aboutPatches(jacobian, state.result.patches, guess);
  return state.result;
}

}  // namespace strainfinger::contact
