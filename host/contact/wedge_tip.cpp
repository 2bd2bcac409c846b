#include "host/contact/wedge_tip.hpp"

#include <algorithm>
#include <cmath>
#include <complex>
#include <numbers>

namespace strainfinger::contact {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;
using std::numbers::pi;
using Complex = std::complex<double>;

constexpr int kPowers = 40;  // of tau, at most pi from the tip

/// a_k of a traction whose harmonics are sum a_k / n^(k+1).
using Powers = Eigen::Vector<Complex, kPowers>;

/// (n^2 - 1) / (n^2 (alpha n + beta)).
Powers slidingPowers(Complex alpha, Complex beta) {
  Powers a = Powers::Zero();
  const Complex ratio = -beta / alpha;
  Complex power = 1.0 / alpha;
  for (Index k = 0; k < kPowers; ++k, power *= ratio) {
    a[k] += power;
    if (k + 2 < kPowers) a[k + 2] -= power;
  }
  return a;
}

Powers twoPowers(Complex first, Complex second) {
  Powers a = Powers::Zero();
  a.head(2) << first, second;
  return a;
}

/// sum a_k (i half)^k t^k / k!: the coefficients of t^k.
Powers onPatch(Powers a, double half_rad) {
  Complex factor = 1;
  for (Index k = 0; k < kPowers; factor *= Complex(0, half_rad) / static_cast<double>(++k)) a[k] *= factor;
  return a;
}

/// Series of (1 - x^2)^2 [a / (1 - x^2)^2], the bracket cut after so many powers of t = x - x0 as leave
/// nothing but t^6 ln|t| (more amplify what the edges lack): for edges with other powers than 1/2, which a
/// root there must not meddle with.
Powers awayFromEdges(const Powers& a, double x0) {
  constexpr Index kKept = 6;
  Powers result = a;
  result.tail(kPowers - kKept).setZero();
  const double constant = 1 - x0 * x0;  // 1 - x^2 = constant - 2 x0 t - t^2
  for (int time = 0; time < 2; ++time)
    for (Index k = 0; k < kKept; ++k)
      result[k] = (result[k] + (k > 0 ? 2 * x0 * result[k - 1] : 0) + (k > 1 ? result[k - 2] : 0)) / constant;
  for (int time = 0; time < 2; ++time)
    for (Index k = kKept + 4; k-- > 0;)
      result[k] = constant * result[k] - (k > 0 ? 2 * x0 * result[k - 1] : 0) - (k > 1 ? result[k - 2] : 0);
  return result;
}

/// A polynomial of t as series of the smooth edges' orthonormal polynomials: by as many points as powers.
TipTraction tractionOf(const Powers& powers, double x0, bool hasStep) {
  const double largest = powers.cwiseAbs().maxCoeff();
  Index count = kPowers;
  while (count > 1 &&
         std::abs(powers[count - 1]) * std::ldexp(1.0, static_cast<int>(count)) < 1e-18 * largest)
    --count;
  const QuadratureRule rule = gaussRule(kSmoothEdges, static_cast<int>(count));
  VectorXd log(count), step(count);
  for (Index i = 0; i < count; ++i) {
    Complex sum = 0;
    for (Index k = count; k-- > 0;) sum = sum * (rule.nodes[i] - x0) + powers[k];
    log[i] = sum.real();
    step[i] = -sum.imag();
  }
  const MatrixXd transform =
      jacobiValues(kSmoothEdges, static_cast<int>(count), rule.nodes).transpose() * rule.weights.asDiagonal();
  TipTraction tip{x0, transform * log, {}};
  if (hasStep) tip.step = transform * step;
  return tip;
}

VectorXd seriesAt(const VectorXd& coefficients, const VectorXd& x) {
  return jacobiValues(kSmoothEdges, static_cast<int>(coefficients.size()), x) * coefficients;
}

}  // namespace

TipTractions tipTractions(const SurfaceKernel& kernel, const Indenter& indenter, Regime regime,
                          double friction, const Patch& patch) {
  const double x0 = -patch.centre_rad / patch.half_rad;
  if (indenter.edgeSlope() == 0 || !(std::abs(x0) < 1)) return {};
  const model::Annulus<double>& annulus = kernel.annulus();
  const double kappa = 3 - 4 * annulus.poisson_ratio;
  const double unit_pa = 8 * annulus.shear_modulus_pa * indenter.edgeSlope() / pi;
  const bool hasStep = annulus.poisson_ratio != 0.5;
  const auto traction = [&](const Powers& powers) { return tractionOf(powers, x0, hasStep); };
  if (regime == Regime::kStick) {
    const double share_pa = unit_pa / (4 * kappa);
    const double along_pa = share_pa * (kappa + 1), across_pa = share_pa * (kappa - 1);
    return {traction(onPatch(twoPowers(along_pa, -across_pa), patch.half_rad)),
            traction(onPatch(twoPowers({0, -across_pa}, {0, along_pa}), patch.half_rad))};
  }
  const Complex alpha(kappa + 1, friction * (1 - kappa)), beta(1 - kappa, friction * (kappa + 1));
  const Powers powers = onPatch(unit_pa * slidingPowers(alpha, beta), patch.half_rad);
  return {traction(kernel.edgeShift(friction) == 0 ? powers : awayFromEdges(powers, x0)), {}};
}

// With y = cos phi, x0 = cos phi0: the integral of arccosh / (x - y) is (pi^2/2) sgn(x - x0) + pi asin x0,
// and (U_k(x) - U_k(y)) / (x - y) = 2 sum_j U_j(x) U_(k-1-j)(y); the logarithm's are the antiderivatives,
// their constants from int T_n / sqrt(1 - x^2) = 0 and that of the logarithm, -pi ln 2. norm U_k is
// orthonormal.
PatchRules tipRules(const TipTractions& tip, const ReferencePatch& same) {
  const VectorXd &points = same.points(), &places = same.rules().rule.nodes;
  const auto nodes = static_cast<int>(places.size()) - 2;
  const double norm = std::sqrt(2 / pi), x0 = tip.pressure.position, phi0 = std::acos(x0);
  const VectorXd moments = tipMoments(x0, nodes);
  const ArrayXd angles = points.array().acos(), side = (points.array() - x0).sign();
  MatrixXd integrals(points.size(), nodes), antiderivatives(points.size(), nodes);
  for (Index k = 0; k < nodes; ++k) {
    const auto n = static_cast<double>(k + 1);
    const double there = std::cos(n * phi0) / n;
    antiderivatives.col(k) = (n * angles).cos() / n;
    integrals.col(k) = norm * pi *
                       (pi / 2 * side * (antiderivatives.col(k).array() - there) +
                        std::asin(x0) * antiderivatives.col(k).array() - std::sin(n * phi0) / (n * n) -
                        there * (pi / 2 - phi0));
    integrals.col(k) -= 2 * antiderivatives.leftCols(k) * moments.head(k).reverse();
    integrals.col(k).array() -= std::numbers::ln2 * moments[k];
  }
  // f(y) by its series up to degree nodes - 1, whose coefficients either rule gives exactly
  const MatrixXd values = jacobiValues(kSmoothEdges, nodes, places);
  VectorXd weights = same.rules().rule.weights;
  if (same.exponents().right < 0) weights.array() *= 1 - places.array().square();
  const MatrixXd projection = values.transpose() * weights.asDiagonal();
  PatchRules rules{points, {places, projection.transpose() * moments}, {}, integrals * projection, 0, {}};
  rules.basis.resize(places.size(), tip.stuck.isThere() ? 2 : 1);
  rules.basis.col(0) = seriesAt(tip.pressure.log, places);
  if (tip.stuck.isThere()) rules.basis.col(1) = seriesAt(tip.stuck.log, places);
  return rules;
}

}  // namespace strainfinger::contact
