#include "host/contact/influence.hpp"

#include <cmath>
#include <numbers>

#include "host/base/angles.hpp"
#include "host/contact/multiples.hpp"
#include "host/contact/tanh_sinh.hpp"
#include "host/model/series.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::ArrayXXd;
using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

/// What the core reflects from y to x, both on a patch: a function of their distance, by its Chebyshev
/// series. Harmonic n has Bessel coefficients, which fall from k = 2 half n on, and is the smaller the larger
/// n is.
ArrayXXd reflectedOnItself(const SurfaceKernel& kernel, const KernelMix& mix, const VectorXd& points,
                           const VectorXd& nodes, double half_rad) {
  const VectorXd &even = mix.reflected, &odd = kernel.reflection().coupling;
  const auto harmonics = static_cast<int>(even.size()) - 1;
  const int half = 8 + static_cast<int>(0.6 * half_rad * harmonics), count = 2 * half;
  VectorXd series = VectorXd::Zero(count);
  for (int k = 0; k < half; ++k) {  // and the other half by symmetry
    const double angle = std::numbers::pi * (k + 0.5) / count;
    double along = -mix.even * even[0] / 2, across = 0;
    model::visitMultiples(2 * half_rad * std::cos(angle), harmonics, [&](int n, double c, double s) {
      along += mix.even * even[n] * c;
      across += mix.odd * odd[n] * s;
    });
    model::visitMultiples(angle, count - 1, [&](int j, double c, double) {
      series[j] += 2 * (j % 2 == 0 ? along : across) * c;
    });
  }
  series *= 2 / (std::numbers::pi * count);
  series[0] /= 2;
  const double rounding = 1e-17 * series.cwiseAbs().maxCoeff();
  Index last = count;
  while (last > 1 && std::abs(series[last - 1]) < rounding) --last;
  const ArrayXXd twice =
      (points.replicate(1, nodes.size()) - nodes.transpose().replicate(points.size(), 1)).array();
  ArrayXXd sum = ArrayXXd::Zero(twice.rows(), twice.cols()), next = sum, made = sum;
  for (Index j = last; j-- > 1;) {  // Clenshaw
    made = twice * sum - next + series[j];
    next.swap(sum);
    sum.swap(made);
  }
  return twice / 2 * sum - next + series[0];
}

/// Rows: the odd part of the kernel at the points; what logWeights hold of the sign is left out.
MatrixXd signOnItself(const SurfaceKernel& kernel, const KernelMix& mix, const PatchRules& rules,
                      double half_rad) {
  MatrixXd result(rules.points.size(), rules.basis.cols());
  for (Index i = 0; i < result.rows(); ++i) {
    const auto& [rule, basis] = rules.signRules[static_cast<std::size_t>(i)];
    const KernelTable parts = kernel.table(mix.even, mix.odd, half_rad * rules.points.segment(i, 1).array(),
                                           half_rad * rule.nodes.array());
    result.row(i) =
        ((parts.sgn - rules.signInLog * parts.log).matrix().cwiseProduct(rule.weights.transpose())) * basis;
  }
  return result;
}

/// Whether the kernel is so smooth between two patches that the source's own rule integrates it.
bool areFar(const Patch& from, const Patch& at) {
  constexpr double kFar = 1.3;  // half widths: 16 nodes more than terms leave 2.1^-32 of the kernel
  const double apart_rad = std::abs(shortWay_rad(at.centre_rad, from.centre_rad));
  return apart_rad - at.half_rad > kFar * from.half_rad;
}

/// By the source's rule, or at nodes that are dense at both edges, whichever of them is near.
MatrixXd onAnother(const SurfaceKernel& kernel, const KernelMix& mix, const ReferencePatch& source,
                   const Patch& from, const VectorXd& points, const Patch& at) {
  VectorXd nodes = source.rules().rule.nodes;
  MatrixXd weighted = source.rules().rule.weights.asDiagonal() * source.rules().basis;
  if (!areFar(from, at)) {
    const TanhSinhRule rule = TanhSinhRule::ofDegree(source.terms());
    const PatchPoints places{2 * rule.fromStart, 2 * rule.fromEnd};
    nodes = places.x();
    weighted = (2 * rule.weights * edgeWeight(source.exponents(), places)).matrix().asDiagonal() *
               jacobiValues(source.exponents(), source.terms(), nodes);
  }
  MatrixXd values(points.size(), nodes.size());
  for (Index j = 0; j < nodes.size(); ++j)
    for (Index i = 0; i < points.size(); ++i) {
      const double distance =
          std::remainder(at.centre_rad - from.centre_rad + at.half_rad * points[i] - from.half_rad * nodes[j],
                         2 * std::numbers::pi);
      const auto [even, odd] = kernel.valuesAt(distance);
      values(i, j) = mix.even * even + mix.odd * odd;
    }
  return values * weighted;
}

MatrixXd reflected(const SurfaceKernel& kernel, const KernelMix& mix, const ReferencePatch& source,
                   const Patch& from, const VectorXd& points, const Patch& at) {
  const VectorXd &even = mix.reflected, &odd = kernel.reflection().coupling;
  const auto anglesOn = [](const Patch& patch, const VectorXd& x) -> VectorXd {
    return patch.centre_rad + patch.half_rad * x.array();
  };
  const Multiples here(anglesOn(at, points), even.size()),
      there(anglesOn(from, source.rules().rule.nodes), even.size());
  const MatrixXd weighted =
      source.rules().rule.weights.asDiagonal() * source.rules().basis / std::numbers::pi;
  MatrixXd cosines = there.cosines.transpose() * weighted, sines = there.sines.transpose() * weighted;
  cosines.row(0) /= 2;  // Fourier coefficients of the basis
  MatrixXd result = MatrixXd::Zero(points.size(), source.terms());
  if (mix.even != 0)
    result +=
        mix.even * (here.cosines * (even.asDiagonal() * cosines) + here.sines * (even.asDiagonal() * sines));
  if (mix.odd != 0)
    result +=
        mix.odd * (here.sines * (odd.asDiagonal() * cosines) - here.cosines * (odd.asDiagonal() * sines));
  return result;
}

}  // namespace

// ln|psi| = ln half + ln|x - y|.
OwnInfluence::OwnInfluence(const SurfaceKernel& kernel, const KernelMix& mix, const VectorXd& points,
                           const VectorXd& nodes, double half_rad)
    : kernel_(kernel), mix_(mix), half_rad_(half_rad) {
  const KernelTable parts =
      kernel.table(mix.even, mix.odd, half_rad * points.array(), half_rad * nodes.array());
  log_ = parts.log;
  smooth_ =
      parts.log * std::log(half_rad) + parts.smooth + reflectedOnItself(kernel, mix, points, nodes, half_rad);
}

MatrixXd OwnInfluence::of(const PatchRules& rules) const {
  const MatrixXd values =
      rules.logWeights.cwiseProduct(log_.matrix()) + smooth_.matrix() * rules.rule.weights.asDiagonal();
  MatrixXd result = values * rules.basis;
  if (!rules.signRules.empty()) result += signOnItself(kernel_, mix_, rules, half_rad_);
  return half_rad_ * result;
}

MatrixXd influence(const SurfaceKernel& kernel, const KernelMix& mix, const ReferencePatch& source,
                   const Patch& from, const VectorXd& points, const Patch& at) {
  return from.half_rad * (onAnother(kernel, mix, source, from, points, at) +
                          reflected(kernel, mix, source, from, points, at));
}

}  // namespace strainfinger::contact
