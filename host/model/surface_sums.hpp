#pragma once
// Sums over the harmonics at r_b in closed form: what a body without a core responds there, from the second
// harmonic on. Templates on the scalar.

#include <Eigen/Core>
#include <cmath>

#include "host/model/harmonic.hpp"

namespace strainfinger::model {

template <typename Scalar>
using Vector3 = Eigen::Matrix<Scalar, 3, 1>;

/// c_0, c_1, c_2 of the response c_0 + c_1 / (n - 1) + c_2 / (n + 1) at r_b for alpha^2n -> 0, n >= 2:
/// harmonic.hpp's terms with A = B = 0, b = a.
template <typename Scalar>
struct Asymptote {
  Vector3<Scalar> normal, tangential;

  Scalar at(int n, Traction traction) const {
    const Vector3<Scalar> falls(Scalar(1), Scalar(1) / (n - 1), Scalar(1) / (n + 1));
    return falls.dot(traction == kNormal ? normal : tangential);
  }
};

template <typename Scalar>
Asymptote<Scalar> asymptote(const Annulus<Scalar>& annulus, Row row) {
  const Scalar twoMu = 2 * annulus.shear_modulus_pa, kappaOne = 2 * (1 - 2 * annulus.poisson_ratio);
  const Scalar half = annulus.outer_radius_m / (2 * twoMu), flexible = half * (1 + kappaOne);
  const Vector3<Scalar> sharp(Scalar(0), half, flexible), blunt(Scalar(0), half, -flexible);
  const auto constant = [](const Scalar& value) { return Vector3<Scalar>(value, Scalar(0), Scalar(0)); };
  const Vector3<Scalar> one = constant(1), none = constant(0), dilated = constant(kappaOne / (2 * twoMu));
  switch (row) {
    case kTrr:
      return {one, none};
    case kTrt:
      return {none, one};
    case kTtt:
      return {one, -2 * one};
    case kUr:
      return {sharp, blunt};
    case kUt:
      return {blunt, sharp};
    case kErr:
      return {dilated, constant(2 * annulus.poisson_ratio / twoMu)};
    case kEtt:
      return {dilated, constant(-2 * (1 - annulus.poisson_ratio) / twoMu)};
    default:
      return {none, constant(1 / twoMu)};
  }
}

/// Differences between the two edges of a load (the one further on less the other) of the sums over n >= 2 of
/// (1, 1 / (n - 1), 1 / (n + 1)) times cos n t / n and sin n t / n, t being the angle to the edge.
template <typename Scalar>
struct EdgeDifferences {
  Vector3<Scalar> cosines, sines;
};

// The sums are made of L = -ln |2 sin t/2|, the saw-tooth T, 1 - cos t and sin t. A narrow load's edges have
// nearly the same of each: what differs is computed, not subtracted.
namespace edges {

/// Something at both edges: its difference, and its mean.
template <typename Scalar>
struct Pair {
  Scalar difference, mean;

  Scalar differenceOfProduct(const Pair& other) const {
    return difference * other.mean + mean * other.difference;
  }
};

/// L; infinite where an edge is.
template <typename Scalar>
Pair<Scalar> logarithm(const Scalar& angle, const Scalar& half) {
  using std::abs;
  using std::cos;
  using std::log;
  using std::log1p;
  using std::sin;
  const Scalar after = abs(sin((angle + half) / 2)), before = abs(sin((angle - half) / 2));
  const Scalar mean = -log(4 * after * before) / 2;
  const Scalar width = sin(half / 2) * cos(angle / 2), place = cos(half / 2) * sin(angle / 2);
  const Scalar ratio = abs(width) < abs(place) ? Scalar(width / place) : Scalar(place / width);
  if (2 * abs(ratio) < 1) return {log1p(-ratio) - log1p(ratio), mean};
  return {log(before / after), mean};
}

/// T = (pi - t) / 2 for 0 < t < 2 pi, odd.
template <typename Scalar>
Pair<Scalar> tooth(const Scalar& angle, const Scalar& half, const Scalar& pi) {
  using std::abs;
  const auto at = [&pi](const Scalar& t) -> Scalar {
    if (t == 0) return Scalar(0);
    return t > 0 ? Scalar((pi - t) / 2) : Scalar(-(pi + t) / 2);
  };
  const Scalar beyond = abs(angle) - half;
  const Scalar jump = beyond > 0 ? Scalar(0) : beyond < 0 ? pi : Scalar(pi / 2);
  return {jump - half, (at(angle + half) + at(angle - half)) / 2};
}

}  // namespace edges

/// At `angle` from the load's centre, within half a revolution; 0 < half <= pi, half of its width. Error:
/// some roundings of each sum's larger term, however narrow the load. Where an edge is, jumps are halfway and
/// cosines[0] is infinite.
template <typename Scalar>
EdgeDifferences<Scalar> edgeDifferences(const Scalar& angle, const Scalar& half, const Scalar& pi) {
  using std::abs;
  using std::cos;
  using std::log;
  using std::sin;
  if (half >= pi) return {Vector3<Scalar>::Zero(), Vector3<Scalar>::Zero()};  // both edges are one
  const auto versine = [](const Scalar& t) -> Scalar { return 2 * sin(t / 2) * sin(t / 2); };
  const edges::Pair<Scalar> s{2 * cos(angle) * sin(half), sin(angle) * cos(half)};
  const edges::Pair<Scalar> v{2 * sin(angle) * sin(half),
                              versine(angle) + versine(half) - versine(angle) * versine(half)};
  const auto L = edges::logarithm(angle, half), T = edges::tooth(angle, half, pi);
  Scalar Lv = L.differenceOfProduct(v), Ls = L.differenceOfProduct(s);
  if (abs(angle) == half) {  // the factors of L vanish where it is infinite: what remains is the other edge's
    const Scalar other = -log(2 * sin(half));
    Lv = (angle > 0 ? 1 : -1) * other * versine(2 * half);
    Ls = other * sin(2 * half);
  }
  const Scalar Ts = T.differenceOfProduct(s), Tv = T.differenceOfProduct(v);
  return {{L.difference + v.difference, -v.difference - Lv - Ts, Lv - Ts + v.difference / 2},
          {T.difference - s.difference, Ls - Tv + s.difference, Tv + Ls - s.difference / 2}};
}

}  // namespace strainfinger::model
