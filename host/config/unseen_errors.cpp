#include "host/config/unseen_errors.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>

#include "host/model/impulse_response.hpp"

namespace strainfinger::config {
namespace {

/// The scale of all loads is off by so many times the model error: a Poisson's ratio of 0.48 instead of 0.5
/// makes the loads of the default finger a fifth smaller, and leaves no residuals.
constexpr double kScaleErrorPerModelError = 4;
/// What scaleError() is for the default finger. Where it is more, as of gauges nearer to the core, loads are
/// off by as many times more. Without that, loads told by an uncalibrated finger of 30 mm whose gauges are
/// 0.2 mm above a core that is 0.1 mm off are 4.9 of their standard errors off, with it 1.4 (closed_loop,
/// AsBuilt).
constexpr double kDefaultScaleError = 0.27;

/// All places near a gauge are off by so many times the model error and the gauges' depth: what a gauge that
/// is beside its place reads is what one in its place reads of a touch beside, and leaves no residuals. Of
/// 2,000 line touches of fingers as built 1 is beyond six sigma, without it 56 (closed_loop, AsBuilt).
constexpr double kPlaceErrorPerModelError = 0.3;

/// Second moments are off by so many times the model error and the square of the gauges' depth: a gauge that
/// lies deeper sees a narrow touch as wider. Of 2,000 line touches of fingers as built the widths of 17 are
/// beyond six sigma, without it those of 290 (closed_loop, AsBuilt).
constexpr double kMomentErrorPerModelError = 0.5;

/// The model error is meant for gauges that read so much more or less of a line load where they lie
/// tolerance.depth_m off: 0.068 on the default finger. Near the core, where strains are small, it is more: on
/// 20 mm, 0.2 mm above the core, 0.2. Without that the places of 30 of 2,000 touches of such fingers as built
/// are beyond six sigma, with it of 4, and 5 are more than half a pitch off, all unflagged (closed_loop,
/// AsBuilt).
constexpr double kShareOffByDepth = 0.07;
/// The model error is increased so many times at most. A quarter of those touches are flagged then; with 2.4
/// times it is more than a third, and as many are wrong.
constexpr double kMostTimes = 2;

/// What a gauge reads of a line load pressing, by harmonics of the angle between them.
Eigen::VectorXd lineResponse(const FingerConfig& config, const model::Annulus<double>& annulus,
                             double radius_m) {
  constexpr double kTolerance = 1e-6;
  const model::ImpulseResponse response(annulus, radius_m, config.gauges.component, 0, 0, kTolerance);
  return response.isEvenInNormal() ? response.even() : response.odd();
}

/// The error over the load that is told, where `built` reads a load, and it and its second moment are fitted
/// by `drawn`: a moment takes as much off each harmonic as the square of its number.
double loadError(const Eigen::VectorXd& drawn, const Eigen::VectorXd& built) {
  const Eigen::Index count = std::min(drawn.size(), built.size());
  const Eigen::VectorXd number = Eigen::VectorXd::LinSpaced(count, 0, static_cast<double>(count - 1));
  Eigen::MatrixX2d columns(count, 2);
  columns.col(0) = drawn.head(count);
  columns.col(1) = number.cwiseAbs2().cwiseProduct(drawn.head(count));
  return 1 / columns.colPivHouseholderQr().solve(built.head(count))[0] - 1;
}

/// Of loads, where core and Poisson's ratio are off by their tolerances. A core that is thicker than drawn
/// takes more away than one that is thinner adds.
double scaleError(const FingerConfig& config, const Eigen::VectorXd& drawn) {
  model::Annulus<double> thicker = config.finger.annulus(), softer = thicker;
  const double radius_m = config.gauges.radius_m;
  thicker.core_radius_m = std::min(thicker.core_radius_m + config.tolerance.core_radius_m,
                                   (thicker.core_radius_m + radius_m) / 2);
  softer.poisson_ratio = std::max(softer.poisson_ratio - config.tolerance.poisson_ratio, 0.0);
  return std::hypot(loadError(drawn, lineResponse(config, thicker, radius_m)),
                    loadError(drawn, lineResponse(config, softer, radius_m)));
}

/// By how much of itself a gauge's reading changes where the gauge lies shallower by the tolerance: by the
/// slope, because the tolerance may be more than its depth.
double shareOffByDepth(const FingerConfig& config, const Eigen::VectorXd& drawn) {
  constexpr double kStep = 0.01;  // of the depth
  const double step_m = kStep * (config.finger.outer_radius_m - config.gauges.radius_m);
  const Eigen::VectorXd shallower =
      lineResponse(config, config.finger.annulus(), config.gauges.radius_m + step_m);
  const Eigen::Index count = std::min(drawn.size(), shallower.size());
  const double change = shallower.head(count).dot(drawn.head(count)) / drawn.head(count).squaredNorm() - 1;
  return std::abs(change) * config.tolerance.depth_m / step_m;
}

/// How many times as much as on the default finger model error and loads' scale are off.
struct Times {
  double model = 1, loadScale = 1;
};

/// Of a finger that is calibrated, so that core, ratio and depths are known, or perfect: as much.
Times timesDefault(const FingerConfig& config) {
  if (config.calibration.load_error > 0 || config.gauges.model_error == 0) return {};
  const Eigen::VectorXd drawn = lineResponse(config, config.finger.annulus(), config.gauges.radius_m);
  return {std::clamp(shareOffByDepth(config, drawn) / kShareOffByDepth, 1.0, kMostTimes),
          std::max(1.0, scaleError(config, drawn) / kDefaultScaleError)};
}

}  // namespace

UnseenErrors unseenErrors(const FingerConfig& config) {
  const Times times = timesDefault(config);
  const double given = config.gauges.model_error, model = std::min(1.0, given * times.model);
  const double depth_m = config.finger.outer_radius_m - config.gauges.radius_m;
  return {.modelError = model,
          .place_m = std::hypot(config.calibration.place_error_m, kPlaceErrorPerModelError * model * depth_m),
          .loadScale = std::min(1.0, kScaleErrorPerModelError * given * times.loadScale),
          .normalShare = config.calibration.load_error,
          .moment_m2 = std::hypot(config.calibration.moment_error_m2,
                                  kMomentErrorPerModelError * model * depth_m * depth_m)};
}

}  // namespace strainfinger::config
