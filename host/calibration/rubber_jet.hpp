#pragma once
// A number with its derivatives to a gauge's radius, the core's radius and Poisson's ratio.

#include <cmath>
#include <limits>

#include <ceres/jet.h>

namespace strainfinger::calibration {

enum RubberSlope : int { kToRadius, kToCore, kToPoisson, kRubberSlopes };

/// ceres::Jet, but its operators take integers as any scalar's do, as the templates of host/model ask.
class RubberJet : public ceres::Jet<double, kRubberSlopes> {
 public:
  using Base = ceres::Jet<double, kRubberSlopes>;
  RubberJet() = default;
  RubberJet(double value) : Base(value) {}   // NOLINT: a constant is a number too
  RubberJet(const Base& jet) : Base(jet) {}  // NOLINT: what Ceres' functions return
  RubberJet(double value, RubberSlope variable) : Base(value, variable) {}

  RubberJet& operator+=(const RubberJet& y) { return *this = *this + y; }
  RubberJet& operator-=(const RubberJet& y) { return *this = *this - y; }
  RubberJet& operator*=(const RubberJet& y) { return *this = *this * y; }
  RubberJet& operator/=(const RubberJet& y) { return *this = *this / y; }

  friend RubberJet operator-(const RubberJet& x) { return -x.base(); }
  friend RubberJet operator+(const RubberJet& x, const RubberJet& y) { return x.base() + y.base(); }
  friend RubberJet operator-(const RubberJet& x, const RubberJet& y) { return x.base() - y.base(); }
  friend RubberJet operator*(const RubberJet& x, const RubberJet& y) { return x.base() * y.base(); }
  friend RubberJet operator/(const RubberJet& x, const RubberJet& y) { return x.base() / y.base(); }
  friend RubberJet operator+(double x, const RubberJet& y) { return x + y.base(); }
  friend RubberJet operator-(double x, const RubberJet& y) { return x - y.base(); }
  friend RubberJet operator*(double x, const RubberJet& y) { return x * y.base(); }
  friend RubberJet operator/(double x, const RubberJet& y) { return x / y.base(); }
  friend RubberJet operator+(const RubberJet& x, double y) { return x.base() + y; }
  friend RubberJet operator-(const RubberJet& x, double y) { return x.base() - y; }
  friend RubberJet operator*(const RubberJet& x, double y) { return x.base() * y; }
  friend RubberJet operator/(const RubberJet& x, double y) { return x.base() / y; }
  friend bool operator<(const RubberJet& x, const RubberJet& y) { return x.a < y.a; }
  friend bool operator>(const RubberJet& x, const RubberJet& y) { return x.a > y.a; }
  friend bool operator<=(const RubberJet& x, const RubberJet& y) { return x.a <= y.a; }
  friend bool operator==(const RubberJet& x, const RubberJet& y) { return x.a == y.a; }
  friend RubberJet pow(const RubberJet& x, int n) {
    const double below = n == 0 ? 0 : std::pow(x.a, n - 1);
    return Base(below * x.a + (n == 0 ? 1 : 0), n * below * x.v);
  }
  friend RubberJet log(const RubberJet& x) { return ceres::log(x.base()); }
  friend RubberJet log1p(const RubberJet& x) { return ceres::log1p(x.base()); }
  friend RubberJet expm1(const RubberJet& x) { return ceres::expm1(x.base()); }
  friend RubberJet abs(const RubberJet& x) { return ceres::abs(x.base()); }
  friend RubberJet sin(const RubberJet& x) { return ceres::sin(x.base()); }

 private:
  const Base& base() const { return *this; }
};

}  // namespace strainfinger::calibration

template <>
struct Eigen::NumTraits<strainfinger::calibration::RubberJet>
    : Eigen::NumTraits<strainfinger::calibration::RubberJet::Base> {
  using Real = strainfinger::calibration::RubberJet;
  using NonInteger = Real;
  using Nested = Real;
  using Literal = Real;
};

template <>
class std::numeric_limits<strainfinger::calibration::RubberJet> : public std::numeric_limits<double> {};
