#include "host/shape/curvature.hpp"

#include <cmath>

namespace strainfinger::shape {
namespace {

constexpr int kTerms = 16;
constexpr double kLogStep = 1e-3;  // error 1e-6 of the derivative

}  // namespace

CurvatureScale::CurvatureScale(const model::Annulus<double>& annulus)
    : kernel_(annulus), solver_(kernel_, contact::Regime::kFrictionless, 0, kTerms) {}

double CurvatureScale::flatLoad_n_per_m(double width_rad) const {
  const auto solution = solver_.solve({{0, width_rad / 2}}, contact::Indenter::flat(), 0);
  return kernel_.annulus().outer_radius_m * contact::totalTraction(solution.tractions).pressure_pa;
}

CurvatureScale::Curvature CurvatureScale::of(double load_n_per_m, double width_rad) const {
  const double finger_per_m = 1 / kernel_.annulus().outer_radius_m;
  const double both_per_m = finger_per_m * load_n_per_m / flatLoad_n_per_m(width_rad);
  const double exponent = std::log(flatLoad_n_per_m(width_rad * std::exp(kLogStep)) /
                                   flatLoad_n_per_m(width_rad * std::exp(-kLogStep))) /
                          (2 * kLogStep);
  return {both_per_m - finger_per_m, both_per_m, -exponent * both_per_m};
}

}  // namespace strainfinger::shape
