#include "host/paper/spread_response.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "host/model/series.hpp"

namespace strainfinger::paper {
namespace {

/// What harmonics are multiplied by, and its derivative to x.
struct Window {
  double value, slope;
};

Window windowAt(double x, Spread spread) {
  const auto bessel = [x](int order) { return std::cyl_bessel_j(static_cast<double>(order), x); };
  if (x == 0) return {1, 0};
  if (spread == Spread::kPunch) return {bessel(0), -bessel(1)};
  return {2 * bessel(1) / x, -2 * bessel(2) / x};
}

}  // namespace

SpreadResponse::SpreadResponse(const model::Annulus<double>& annulus, double radius_m, double width_m,
                               Spread spread) {
  constexpr std::array kRows{model::kErr};
  constexpr double kRelative = 1e-12;
  series_ = model::truncatedSeries(annulus, radius_m, kRows, {}, kRelative);
  series_ /= std::numbers::pi * annulus.outer_radius_m;
  series_.row(0) /= 2;
  series_.col(model::kNormal) *= -1;
  perWidth_ = series_;
  for (Eigen::Index n = 0; n < series_.rows(); ++n) {
    const double perWidth = static_cast<double>(n) / (2 * annulus.outer_radius_m);
    const Window window = windowAt(perWidth * width_m, spread);
    series_.row(n) *= window.value;
    perWidth_.row(n) *= perWidth * window.slope;
  }
}

SpreadResponse::Value SpreadResponse::at(double angle_rad) const {
  Value sum{};
  model::visitMultiples(angle_rad, static_cast<int>(series_.rows()) - 1, [&](int n, double c, double s) {
    sum.normal += series_(n, 0) * c;
    sum.tangential += series_(n, 1) * s;
    sum.normalSlope -= n * series_(n, 0) * s;
    sum.tangentialSlope += n * series_(n, 1) * c;
    sum.normalPerWidth += perWidth_(n, 0) * c;
    sum.tangentialPerWidth += perWidth_(n, 1) * s;
  });
  return sum;
}

}  // namespace strainfinger::paper
