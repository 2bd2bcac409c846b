#include "host/contact/influence.hpp"

#include <cmath>
#include <numbers>

#include "host/contact/tanh_sinh.hpp"
#include "host/model/series.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

KernelParts mixedParts(const SurfaceKernel& kernel, const KernelMix& mix, double angle_rad) {
  KernelParts parts;
  if (mix.even != 0) {
    const KernelParts even = kernel.even(angle_rad);
    parts = {mix.even * even.log, mix.even * even.sgn, mix.even * even.smooth};
  }
  if (mix.odd != 0) {
    const KernelParts odd = kernel.odd(angle_rad);
    parts = {parts.log + mix.odd * odd.log, parts.sgn + mix.odd * odd.sgn,
             parts.smooth + mix.odd * odd.smooth};
  }
  return parts;
}

/// ln|psi| = ln half + ln|x - y|; what logWeights() hold of the sign is left out of the sign's rule.
MatrixXd onItself(const SurfaceKernel& kernel, const KernelMix& mix, const ReferencePatch& patch,
                  double half_rad) {
  const VectorXd &x = patch.points(), &y = patch.rule().nodes, &weights = patch.rule().weights;
  const double logHalf = std::log(half_rad);
  MatrixXd values(x.size(), y.size());
  for (Index j = 0; j < y.size(); ++j)
    for (Index i = 0; i < x.size(); ++i) {
      const KernelParts parts = mixedParts(kernel, mix, half_rad * (x[i] - y[j]));
      values(i, j) = patch.logWeights()(i, j) * parts.log + weights[j] * (parts.log * logHalf + parts.smooth);
    }
  MatrixXd result = values * patch.basis();
  for (Index i = 0; i < static_cast<Index>(patch.signRules().size()); ++i) {
    const auto& [rule, basis] = patch.signRules()[static_cast<std::size_t>(i)];
    for (Index j = 0; j < rule.nodes.size(); ++j) {
      const KernelParts parts = mixedParts(kernel, mix, half_rad * (x[i] - rule.nodes[j]));
      result.row(i) += rule.weights[j] * (parts.sgn - parts.log * patch.signInLog()) * basis.row(j);
    }
  }
  return result;
}

/// The weighted basis at nodes that are dense at both edges, whichever of them is near.
MatrixXd onAnother(const SurfaceKernel& kernel, const KernelMix& mix, const ReferencePatch& source,
                   const Patch& from, const VectorXd& points, const Patch& at) {
  constexpr int kNearEdges = 14;
  const TanhSinhRule rule(kNearEdges);
  const PatchPoints places{2 * rule.fromStart, 2 * rule.fromEnd};
  const Eigen::ArrayXd weights = 2 * rule.weights * edgeWeight(source.exponents(), places);
  MatrixXd values(points.size(), weights.size());
  for (Index i = 0; i < points.size(); ++i)
    for (Index j = 0; j < weights.size(); ++j) {
      const double x = places.x()[j];
      const double distance =
          std::remainder(at.centre_rad - from.centre_rad + at.half_rad * points[i] - from.half_rad * x,
                         2 * std::numbers::pi);
      const KernelPair pair = kernel.valuesAt(distance);
      values(i, j) = weights[j] * (mix.even * pair.even + mix.odd * pair.odd);
    }
  return values * jacobiValues(source.exponents(), source.terms(), places.x().matrix());
}

/// cos n angle and sin n angle: one row an angle.
struct Multiples {
  MatrixXd cosines, sines;

  Multiples(const Patch& patch, const VectorXd& x, Index harmonics)
      : cosines(x.size(), harmonics), sines(x.size(), harmonics) {
    for (Index i = 0; i < x.size(); ++i)
      model::visitMultiples(patch.centre_rad + patch.half_rad * x[i], static_cast<int>(harmonics) - 1,
                            [&](int n, double c, double s) {
                              cosines(i, n) = c;
                              sines(i, n) = s;
                            });
  }
};

MatrixXd reflected(const SurfaceKernel& kernel, const KernelMix& mix, const ReferencePatch& source,
                   const Patch& from, const VectorXd& points, const Patch& at) {
  const VectorXd &even = mix.reflected, &odd = kernel.reflection().coupling;
  const Multiples here(at, points, even.size()), there(from, source.rule().nodes, even.size());
  const MatrixXd weighted = source.rule().weights.asDiagonal() * source.basis() / std::numbers::pi;
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

MatrixXd influence(const SurfaceKernel& kernel, const KernelMix& mix, const ReferencePatch& source,
                   const Patch& from, const VectorXd& points, const Patch& at) {
  const bool isSame = from.centre_rad == at.centre_rad;
  const MatrixXd direct = isSame ? onItself(kernel, mix, source, from.half_rad)
                                 : onAnother(kernel, mix, source, from, points, at);
  return from.half_rad * (direct + reflected(kernel, mix, source, from, points, at));
}

}  // namespace strainfinger::contact
