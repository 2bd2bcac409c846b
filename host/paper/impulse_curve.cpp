#include "host/paper/impulse_curve.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/model/impulse_response.hpp"
#include "host/paper/crossing.hpp"
#include "host/paper/spectrum.hpp"

namespace strainfinger::paper {
namespace {

constexpr double kStep_rad = 2e-3;

/// Largest magnitude near `angle`, by the parabola through three points; its error is of fourth order.
double refinedPeakAngle(const std::function<double(double)>& strain, double angle_rad, double step) {
  for (int i = 0; i < 3; ++i, step /= 8) {
    const double before = strain(angle_rad - step), at = strain(angle_rad), after = strain(angle_rad + step);
    const double curvature = before - 2 * at + after;
    if (curvature != 0) angle_rad += step / 2 * (before - after) / curvature;
  }
  return angle_rad;
}

}  // namespace

ImpulseCurve::ImpulseCurve(std::function<double(double)> strain, double depth_rad)
    : strain_(std::move(strain)) {
  const auto stepAt = [&](double angle) { return std::min(kStep_rad, sampleStep_rad(depth_rad, angle)); };
  double best = 0;
  for (double angle = 0; angle <= std::numbers::pi; angle += stepAt(angle)) {
    const double size = std::abs(strain_(angle));
    if (size > peak_) {
      peak_ = size;
      best = angle;
    }
  }
  if (best != 0) peak_ = std::abs(strain_(refinedPeakAngle(strain_, best, stepAt(best))));
}

ImpulseCurve ImpulseCurve::ofCylinder(const model::Annulus<double>& annulus, double radius_m,
                                      StrainComponent component, model::Traction load) {
  return {[response = model::ImpulseResponse(annulus, radius_m, component), load](double angle) {
            const auto value = response.at(angle);
            return load == model::kNormal ? value.normal : value.tangential;
          },
          depth_rad(annulus, radius_m)};
}

ImpulseCurve ImpulseCurve::ofHalfPlane(const model::Annulus<double>& annulus, double radius_m,
                                       StrainComponent component, model::Traction load) {
  return {
      [plane = halfPlaneOf(annulus, radius_m), r_b = annulus.outer_radius_m,
       row = static_cast<int>(component), load](double angle) { return plane.atArc(r_b * angle)(row, load); },
      depth_rad(annulus, radius_m)};
}

double depth_rad(const model::Annulus<double>& annulus, double radius_m) {
  return 1 - radius_m / annulus.outer_radius_m;
}

double sampleStep_rad(double depth_rad, double angle_rad) {
  constexpr double kSamplesOfAPeak = 32;
  return (depth_rad + angle_rad) / kSamplesOfAPeak;
}

double partingAngle_rad(const ImpulseCurve& one, const ImpulseCurve& other, double share) {
  const auto excess = [&](double angle) {
    return std::abs(one.relative(angle) - other.relative(angle)) - share;
  };
  return firstCrossing(excess, 0, std::numbers::pi, kStep_rad);
}

}  // namespace strainfinger::paper
