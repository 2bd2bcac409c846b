#include "host/paper/spread_response.hpp"

#include <array>
#include <numbers>

#include "host/model/series.hpp"

namespace strainfinger::paper {

SpreadResponse::SpreadResponse(const model::Annulus<double>& annulus, double radius_m, double width_m,
                               model::Profile profile, StrainComponent component)
    : normalIsEven_(model::isEvenInNormalLoad(model::rowOf(component))) {
  const std::array rows{model::rowOf(component)};
  constexpr double kRelativeError = 1e-12;
  series_ = model::truncatedSeries(annulus, radius_m, rows, {}, kRelativeError);
  series_ /= std::numbers::pi * annulus.outer_radius_m;
  series_.row(0) /= 2;
  if (normalIsEven_) series_.col(model::kNormal) *= -1;  // as model::ImpulseResponse
  perWidth_ = series_;
  const double width_rad = width_m / annulus.outer_radius_m;
  const double moment_rad2 = model::momentOfWidth(width_rad),
               momentPerWidth = 2 * model::momentOfWidth(1) * width_rad / annulus.outer_radius_m;
  for (Eigen::Index n = 0; n < series_.rows(); ++n) {
    const model::SpreadFactor factor = model::spreadFactor(profile, static_cast<int>(n), moment_rad2);
    series_.row(n) *= factor.value;
    perWidth_.row(n) *= factor.slope * momentPerWidth;
  }
}

SpreadResponse::Value SpreadResponse::at(double angle_rad) const {
  Value sum{};
  model::visitMultiples(angle_rad, static_cast<int>(series_.rows()) - 1, [&](int n, double c, double s) {
    const double normal = normalIsEven_ ? c : s, tangential = normalIsEven_ ? s : c;
    const double sign = normalIsEven_ ? 1 : -1;  // of normal' = -sign n tangential
    sum.normal += series_(n, 0) * normal;
    sum.tangential += series_(n, 1) * tangential;
    sum.normalSlope -= sign * n * series_(n, 0) * tangential;
    sum.tangentialSlope += sign * n * series_(n, 1) * normal;
    sum.normalPerWidth += perWidth_(n, 0) * normal;
    sum.tangentialPerWidth += perWidth_(n, 1) * tangential;
  });
  return sum;
}

}  // namespace strainfinger::paper
