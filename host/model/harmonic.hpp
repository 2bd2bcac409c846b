#pragma once
// The response of the rubber to one harmonic of the surface tractions, at one radius. The mathematics, the
// rescaled form used here and its accuracy are in README.md.

#include <Eigen/Core>
#include <cmath>
#include <limits>
#include <type_traits>

#include "common/quantities.hpp"
#include "host/model/annulus.hpp"

namespace strainfinger::model {

/// What responds: stresses [Pa], displacements [m], tensor strains.
enum Row : int { kTrr, kTrt, kTtt, kUr, kUt, kErr, kEtt, kErt, kRowCount };

constexpr Row rowOf(StrainComponent component) {
  if (component == StrainComponent::kRadial) return kErr;
  return component == StrainComponent::kHoop ? kEtt : kErt;
}

/// Which traction acts: the columns of a HarmonicResponse.
enum Traction : int { kNormal, kTangential };

/// Response of harmonic n to unit coefficients [1 Pa] of the tractions at r_b, tension positive. It maps
/// (p_n^s, q_n^c) to (trr^s, trt^c, ttt^s, ur^s, ut^c, err^s, ett^s) and (p_n^c, -q_n^s) to
/// (trr^c, -trt^s, ttt^c, ur^c, -ut^s, err^c, ett^c), where s and c are factors of sin n theta and cos n
/// theta (paper, eq. 3).
template <typename Scalar>
using HarmonicResponse = Eigen::Matrix<Scalar, kRowCount, 2>;

/// Whether a normal load at theta = 0 makes this even in theta, and a tangential one odd; else the reverse.
constexpr bool isEvenInNormalLoad(Row row) { return row != kTrt && row != kUt && row != kErt; }

/// (x / y)^n for 0 < x <= y, n >= 0. For built-in types the rounding of the quotient, which the power would
/// amplify n times, is taken back by its residual.
template <typename Scalar>
Scalar powerOfQuotient(const Scalar& x, const Scalar& y, int n) {
  using std::pow;
  const Scalar quotient = x / y;
  const Scalar power = pow(quotient, n);
  if constexpr (std::is_floating_point_v<Scalar>) {
    const Scalar residual = std::fma(-quotient, y, x) / x;
    return power + power * (static_cast<Scalar>(n) * residual);
  } else {
    return power;
  }
}

/// All harmonics at one radius.
template <typename Scalar>
class HarmonicModel {
 public:
  /// Domain: an annulus within its own domain, core_radius_m <= radius_m <= outer_radius_m.
  HarmonicModel(const Annulus<Scalar>& annulus, const Scalar& radius_m);

  /// Response of harmonic n >= 0. Never overflows; every power in it is of a base <= 1. Where (r / r_b)^n
  /// underflows, so does the response: it loses digits below 1e-307 and ends as 0. Error in double: below
  /// 1e-14 of the larger of a row's two coefficients, 3e-15 for alpha >= 0.08 (kTtt: of kTrr's, if larger).
  /// Costs a few powers, about 0.2 us.
  HarmonicResponse<Scalar> operator()(int n) const;

 private:
  struct Terms;
  Terms terms(int n) const;
  HarmonicResponse<Scalar> zeroth() const;
  void addTractions(const Terms& t, HarmonicResponse<Scalar>& response) const;
  void addDisplacements(const Terms& t, HarmonicResponse<Scalar>& response) const;
  void addStrainsAndHoopStress(const Terms& t, HarmonicResponse<Scalar>& response) const;
  bool isNearCore(const Terms& t) const { return (t.n + 1) * core_ < 1; }
  Scalar linearExcess(int m) const;
  Scalar meanQuadraticExcess(int m) const;
  Scalar logarithmicExcess() const;
  Scalar oneMinusPower(int m) const {
    using std::expm1;
    return -expm1(m * logB_);
  }

  Annulus<Scalar> annulus_;
  Scalar radius_;
  Scalar a_;         // alpha^2
  Scalar b_;         // beta^2
  Scalar rubber_;    // 1 - alpha^2
  Scalar core_;      // 1 - beta^2: 0 at the core
  Scalar surface_;   // 1 - gamma^2: 0 at the surface
  Scalar logB_;      // ln beta^2
  Scalar kappa_;     // 3 - 4 nu
  Scalar kappaOne_;  // kappa - 1: 0 for an incompressible rubber
};

// What the rows of one harmonic n >= 1 have in common. Differences that vanish at the core are kept as
// computed by expm1, not subtracted anew.
template <typename Scalar>
struct HarmonicModel<Scalar>::Terms {
  int n;
  Scalar w;      // gamma^n
  Scalar A;      // alpha^2n
  Scalar B;      // beta^2n
  Scalar fall;   // 1 - beta^(2n+2)
  Scalar drop;   // beta^2 - beta^2n
  Scalar slope;  // drop / (n - 1), at n = 1 its limit -beta^2 ln beta^2
  Scalar cross;  // (1 - alpha^2) drop - alpha^2 (1 - beta^2), small at the surface and at the core
  Scalar gain;   // 1 + alpha^(2n+2) kappa
  Scalar load;   // alpha^2n + alpha^2 kappa
  Scalar delta;  // -alpha^2n delta_n of the paper
};

template <typename Scalar>
HarmonicModel<Scalar>::HarmonicModel(const Annulus<Scalar>& annulus, const Scalar& radius_m)
    : annulus_(annulus), radius_(radius_m) {
  using std::log;
  using std::log1p;
  const Scalar &ra = annulus.core_radius_m, &rb = annulus.outer_radius_m, &r = radius_m;
  a_ = (ra / rb) * (ra / rb);
  b_ = (ra / r) * (ra / r);
  rubber_ = ((rb - ra) / rb) * ((rb + ra) / rb);
  core_ = ((r - ra) / r) * ((r + ra) / r);
  surface_ = ((rb - r) / rb) * ((rb + r) / rb);
  logB_ = 2 * (r < 2 * ra ? log1p(-(r - ra) / r) : log(ra / r));
  kappaOne_ = 2 * (1 - 2 * annulus.poisson_ratio);
  kappa_ = 1 + kappaOne_;
}

template <typename Scalar>
HarmonicResponse<Scalar> HarmonicModel<Scalar>::operator()(int n) const {
  if (n == 0) return zeroth();
  const Terms t = terms(n);
  HarmonicResponse<Scalar> response;
  addTractions(t, response);
  addDisplacements(t, response);
  addStrainsAndHoopStress(t, response);
  const Scalar common = t.w / (2 * t.delta);
  for (int row = 0; row < kErt; ++row) {
    const Scalar sum = common * response(row, 0), difference = common * response(row, 1);
    response(row, kNormal) = sum + difference;
    response(row, kTangential) = sum - difference;
  }
  response.row(kErt) = response.row(kTrt) / (2 * annulus_.shear_modulus_pa);
  return response;
}

template <typename Scalar>
HarmonicResponse<Scalar> HarmonicModel<Scalar>::zeroth() const {
  const Scalar twoMu = 2 * annulus_.shear_modulus_pa;
  const Scalar scale = 2 + a_ * kappaOne_;
  const Scalar outward = annulus_.outer_radius_m / radius_;
  HarmonicResponse<Scalar> response = HarmonicResponse<Scalar>::Zero();
  response(kTrr, kNormal) = (2 + b_ * kappaOne_) / scale;
  response(kTtt, kNormal) = (core_ * kappaOne_ + 4 * annulus_.poisson_ratio) / scale;
  response(kErr, kNormal) = (1 + b_) * kappaOne_ / (twoMu * scale);
  response(kEtt, kNormal) = core_ * kappaOne_ / (twoMu * scale);
  response(kUr, kNormal) = radius_ * response(kEtt, kNormal);
  response(kTrt, kTangential) = outward * outward;
  response(kErt, kTangential) = response(kTrt, kTangential) / twoMu;
  response(kUt, kTangential) = radius_ * core_ / (twoMu * a_);
  return response;
}

template <typename Scalar>
typename HarmonicModel<Scalar>::Terms HarmonicModel<Scalar>::terms(int n) const {
  Terms t;
  t.n = n;
  t.w = powerOfQuotient(radius_, annulus_.outer_radius_m, n);
  t.A = powerOfQuotient(annulus_.core_radius_m, annulus_.outer_radius_m, 2 * n);
  t.B = powerOfQuotient(annulus_.core_radius_m, radius_, 2 * n);
  t.fall = oneMinusPower(n + 1);
  t.drop = b_ * oneMinusPower(n - 1);
  t.slope = n == 1 ? Scalar(-b_ * logB_) : Scalar(t.drop / (n - 1));
  t.cross = core_ * (b_ * surface_ - t.B) + b_ * surface_ * t.drop;
  t.gain = 1 + a_ * t.A * kappa_;
  t.load = t.A + a_ * kappa_;
  t.delta = t.A * rubber_ * rubber_ * (Scalar(n) * n - 1) + t.gain * t.load;
  return t;
}

// The three functions below fill a row with its response to (p + q) / 2 and (p - q) / 2, times
// delta / gamma^n: the product A_n B_n L of the paper, multiplied out.
template <typename Scalar>
void HarmonicModel<Scalar>::addTractions(const Terms& t, HarmonicResponse<Scalar>& response) const {
  const int n = t.n;
  const Scalar near = 1 + kappa_ * b_ * t.B;
  const Scalar thin = (n + 1) * t.A * rubber_;
  const Scalar bend = (n + 1) * core_;
  const Scalar depth = kappa_ * (n - 1) * b_ * surface_ - t.A * (n - 1) * core_;
  const Scalar core = (n - 1) * rubber_ * t.B;
  response(kTrr, 0) = thin * ((n - 1) * core_ - near) + t.gain * (kappa_ * b_ + t.B * (1 + bend));
  response(kTrr, 1) = depth + core * (1 + bend) + t.load * near;
  response(kTrt, 0) = thin * ((n - 1) * core_ + near) + t.gain * (kappa_ * b_ + t.B * (1 - bend));
  response(kTrt, 1) = depth + core * (1 - bend) - t.load * near;
}

template <typename Scalar>
void HarmonicModel<Scalar>::addDisplacements(const Terms& t, HarmonicResponse<Scalar>& response) const {
  const int n = t.n;
  const Scalar scale = radius_ / (2 * annulus_.shear_modulus_pa);
  const Scalar thin = t.A * rubber_;
  const Scalar tilt = kappa_ * t.fall / (n + 1);
  const Scalar lift = kappaOne_ * t.fall - linearExcess(n + 1);
  const Scalar push = kappaOne_ * t.slope + b_ * meanQuadraticExcess(n - 1);
  response(kUr, 0) = scale * (t.gain * push - thin * lift);
  if (isNearCore(t)) {
    response(kUr, 1) = scale * (t.load * lift / (n + 1) + rubber_ * (n - 1) * push);
  } else {
    response(kUr, 1) =
        scale * (t.A * lift / (n + 1) + kappa_ * (a_ * tilt + t.cross) - (n - 1) * rubber_ * core_ * t.B);
  }
  response(kUt, 0) = scale * (thin * (n + 1) * (tilt + core_) + t.gain * (kappa_ * t.slope + core_ * t.B));
  response(kUt, 1) =
      scale * (kappa_ * (t.cross - a_ * tilt) + (n - 1) * rubber_ * core_ * t.B - t.A * (tilt + core_));
}

template <typename Scalar>
void HarmonicModel<Scalar>::addStrainsAndHoopStress(const Terms& t,
                                                    HarmonicResponse<Scalar>& response) const {
  const int n = t.n;
  const Scalar scale = 1 / (2 * annulus_.shear_modulus_pa);
  const Scalar thin = (n + 1) * t.A * rubber_;
  const Scalar stretch = kappa_ * t.fall + (n - 1) * core_;
  const Scalar shrink = kappa_ * t.drop + (n + 1) * core_ * t.B;
  const Scalar hoopSum = -(thin * stretch + t.gain * shrink);
  const Scalar hoopDifference = t.A * stretch + kappa_ * (a_ * kappa_ * t.fall - (n - 1) * t.cross) -
                                (n - 1) * rubber_ * (n + 1) * core_ * t.B;
  const Scalar meanSum = t.gain * t.B - thin;
  const Scalar meanDifference = t.load + (n - 1) * rubber_ * t.B;
  const Scalar dilation = 2 * kappaOne_, lateral = 4 * annulus_.poisson_ratio;
  response(kEtt, 0) = scale * hoopSum;
  response(kEtt, 1) = scale * hoopDifference;
  response(kErr, 0) = scale * (dilation * meanSum - hoopSum);
  response(kErr, 1) = scale * (dilation * meanDifference - hoopDifference);
  response(kTtt, 0) = lateral * meanSum + hoopSum;
  response(kTtt, 1) = lateral * meanDifference + hoopDifference;
}

// m x - (1 - (1 - x)^m) at x = 1 - beta^2, m >= 1: of second order at the core.
template <typename Scalar>
Scalar HarmonicModel<Scalar>::linearExcess(int m) const {
  if (!(m * core_ < 1)) return m * core_ - oneMinusPower(m);
  using std::abs;
  Scalar term = m * core_, sum = 0;
  for (int k = 2; k <= m; ++k) {
    term *= -(m - k + 1) * core_ / k;
    sum -= term;
    if (abs(term) <= std::numeric_limits<Scalar>::epsilon() * abs(sum)) break;
  }
  return sum;
}

// (1 - beta^2m (1 + m x)) / m at x = 1 - beta^2, m >= 0: of second order at the core.
template <typename Scalar>
Scalar HarmonicModel<Scalar>::meanQuadraticExcess(int m) const {
  if (m == 0) return logarithmicExcess();
  const Scalar linear = m * core_;
  if (linear < 1) return (linear * linear - linearExcess(m) * (1 + linear)) / m;
  const Scalar fall = oneMinusPower(m);
  return (fall - linear * (1 - fall)) / m;
}

// -ln(1 - x) - x at x = 1 - beta^2: the limit of the above for m -> 0.
template <typename Scalar>
Scalar HarmonicModel<Scalar>::logarithmicExcess() const {
  if (!(2 * core_ < 1)) return -logB_ - core_;
  Scalar power = core_, sum = 0;
  for (int k = 2; power > 0; ++k) {
    power *= core_;
    const Scalar term = power / k;
    sum += term;
    if (term <= std::numeric_limits<Scalar>::epsilon() * sum) break;
  }
  return sum;
}

}  // namespace strainfinger::model
