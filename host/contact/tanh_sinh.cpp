#include "host/contact/tanh_sinh.hpp"

#include <algorithm>
#include <numbers>

namespace strainfinger::contact {

TanhSinhRule::TanhSinhRule(int density) {
  constexpr double kReach = 3.9;  // 1e-33 from the ends: an inverse root has 3e-17 of its integral beyond
  const auto half = static_cast<Eigen::Index>(kReach * density);
  const Eigen::ArrayXd t = Eigen::ArrayXd::LinSpaced(2 * half + 1, -kReach, kReach);
  const double step = kReach / static_cast<double>(half);
  const Eigen::ArrayXd exponent = std::numbers::pi * t.sinh();
  fromStart = 1 / (1 + (-exponent).exp());
  fromEnd = 1 / (1 + exponent.exp());
  weights = step * std::numbers::pi * t.cosh() * fromStart * fromEnd;
}

TanhSinhRule TanhSinhRule::ofDegree(int degree) { return TanhSinhRule(std::max(14, 10 + degree / 5)); }

}  // namespace strainfinger::contact
