#include "host/shape/shape.hpp"

#include <algorithm>
#include <boost/math/special_functions/gamma.hpp>
#include <cmath>
#include <limits>
#include <vector>

#include "host/shape/quantiles.hpp"

namespace strainfinger::shape {
namespace {

constexpr int kFitted = 4;

Measured measured(const TouchFit& fit, double value, int member) {
  return {value, std::sqrt(fit.covariance(member, member))};
}

/// The errors of 1 / (curvature + 1 / r_b), about the moment over the load, are normal; those of its inverse
/// are not.
Band bandOf(const Measured& curvature_per_m, double radius_m) {
  const double both_per_m = curvature_per_m.value + 1 / radius_m;
  const double share = kTwoSided95 * curvature_per_m.sigma / both_per_m;
  const double most = share < 1 ? both_per_m / (1 - share) : std::numeric_limits<double>::infinity();
  return {both_per_m / (1 + share) - 1 / radius_m, most - 1 / radius_m};
}

}  // namespace

ShapeEstimator::ShapeEstimator(const config::FingerConfig& config, bool isSparse)
    : config_(config),
      model_(config),
      search_(model_, config.contact.friction_coefficient),
      curvature_(config.finger.annulus()),
      unseen_(config::unseenErrors(config)),
      isSparse_(isSparse) {}

void ShapeEstimator::addUnseenErrors(TouchFit& fit) const {
  const double radius_m = model_.outerRadius_m();
  const auto& [modelError, place_m, loadScale, normalShare, moment_m2] = unseen_;
  const auto load = [&](double load_n_per_m) {
    return std::hypot(loadScale * load_n_per_m, normalShare * fit.touch.normal_n_per_m);
  };
  const Eigen::Vector4d errors{place_m / radius_m, load(fit.touch.normal_n_per_m),
                               load(fit.touch.tangential_n_per_m), moment_m2 / (radius_m * radius_m)};
  fit.covariance.diagonal() += errors.cwiseAbs2();
}

double ShapeEstimator::probability(double chiSquared) const {
  return boost::math::gamma_q((model_.gauges() - kFitted) / 2.0, chiSquared / 2);
}

/// Width and curvature by the first derivatives of what they are made of.
void ShapeEstimator::addMeasures(const TouchFit& noisy, Shape& shape) const {
  TouchFit fit = noisy;
  addUnseenErrors(fit);
  shape.angle_rad = measured(fit, fit.touch.angle_rad, 0);
  shape.normal_n_per_m = measured(fit, fit.touch.normal_n_per_m, 1);
  shape.tangential_n_per_m = measured(fit, fit.touch.tangential_n_per_m, 2);
  const double moment = fit.touch.moment_rad2, sigma = std::sqrt(fit.covariance(kMoment, kMoment));
  const double most = std::max(0.0, moment) + kOneSided95 * sigma, radius_m = model_.outerRadius_m();
  shape.widthLimit_m = radius_m * equivalentWidth_rad(std::min(most, TouchModel::kMostMoment_rad2));
  shape.isWidthAtLimit = fit.isAtLimit;
  shape.isSparse = isSparse_;
  if (shape.isSparse || !(moment * moment > kSure * sigma * sigma) || moment < 0) return;
  const double width_rad = equivalentWidth_rad(moment), logSlope = 1 / (2 * moment);
  shape.width_m = {radius_m * width_rad, radius_m * width_rad * logSlope * sigma};
  const auto curvature = curvature_.of(fit.touch.normal_n_per_m, width_rad);
  const Eigen::Vector4d slopes{0, curvature.toLogLoad_per_m / fit.touch.normal_n_per_m, 0,
                               curvature.toLogWidth_per_m * logSlope};
  shape.curvature_per_m = {curvature.value_per_m, std::sqrt(slopes.dot(fit.covariance * slopes))};
  shape.curvatureBand_per_m = bandOf(*shape.curvature_per_m, radius_m);
}

/// All profiles from the ellipse's place: the best one's probability, its name and measures if it is alone.
void ShapeEstimator::addClass(const TouchFit& ellipse, const Eigen::VectorXd& strains, Shape& shape) const {
  struct Fitted {
    Profile profile;
    TouchFit fit;
  };
  std::vector<Fitted> fits;
  for (const Profile profile : allProfiles())
    fits.push_back({profile, refine(model_, profile, strains, shape.deviation_strain, ellipse.touch)});
  std::ranges::sort(fits, {}, [](const Fitted& fitted) { return fitted.fit.chiSquared; });
  const auto fitsToo = [&](const Fitted& fitted) {
    return fitted.fit.chiSquared < fits[0].fit.chiSquared + kSure;
  };
  shape.fitProbability = probability(fits[0].fit.chiSquared);
  if (!fitsToo(fits[1]) && shape.fitProbability >= kUnlikely) {
    shape.profile = fits[0].profile;
    addMeasures(fits[0].fit, shape);
  } else {
    shape.isOfEllipse = std::ranges::any_of(fits, [&](const Fitted& fitted) {
      return fitsToo(fitted) && areApart(ellipse, fitted.fit.touch, kTwoSided95);
    });
  }
}

std::optional<Shape> ShapeEstimator::estimate(const Eigen::VectorXd& strains, double largest_strain) const {
  const double largest = std::max(largest_strain, strains.lpNorm<Eigen::Infinity>());
  Shape shape;
  shape.deviation_strain = std::hypot(config_.gauges.noise_strain, unseen_.modelError * largest);
  const auto found = search_.search(strains, shape.deviation_strain);
  if (!found) return std::nullopt;
  const TouchFit& fit = found->best;
  shape.touch = fit.touch;
  shape.fitProbability = probability(fit.chiSquared);
  addMeasures(fit, shape);
  if (shape.width_m && !found->rivalAngle_rad) addClass(fit, strains, shape);
  shape.rivalAngle_rad = found->rivalAngle_rad;
  const ResolvedPressure resolved = resolution(shape);
  shape.directions = resolved.directions();
  shape.isOddResolved = resolved.isOddResolved();
  return shape;
}

double ShapeEstimator::pressedHalf_rad(const Shape& shape) const {
  return (shape.width_m ? shape.width_m->value : shape.widthLimit_m) / model_.outerRadius_m() / 2;
}

ResolvedPressure ShapeEstimator::resolution(const Shape& shape) const {
  return {model_, shape.touch, pressedHalf_rad(shape), shape.deviation_strain};
}

PressureEstimate ShapeEstimator::pressure(const Shape& shape, const Eigen::VectorXd& strains,
                                          const Eigen::VectorXd& offsets_rad) const {
  return resolution(shape).estimate(strains, offsets_rad);
}

}  // namespace strainfinger::shape
