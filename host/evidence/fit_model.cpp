#include "host/evidence/fit_model.hpp"

#include <cmath>
#include <vector>

#include "host/model/pressure_profile.hpp"
#include "host/simulation/gauge_strains.hpp"

namespace strainfinger::evidence {
namespace {

/// Of the peak: what it leaves out is far below any noise.
constexpr double kTolerance = 1e-9;

model::GaugeRing ringOf(const config::FingerConfig& config) {
  std::vector<model::PlacedGauge> gauges;
  for (int i = 0; i < config.gauges.count; ++i) gauges.push_back(config.calibrated(i));
  return {config.finger.annulus(), std::move(gauges), config.gauges.component, config.gauges.arc_length_m,
          kTolerance};
}

}  // namespace

FitModel::FitModel(const config::FingerConfig& config) : config_(config), ring_(ringOf(config)) {}

FittedContact FitModel::describe(const simulation::Touch& touch) const {
  model::TouchLoad load = simulation::loadOf(touch, config_.contact, config_.finger.outer_radius_m);
  load.profile = model::Profile::kEllipse;
  return {touch.angle_rad, load};
}

Eigen::VectorXd FitModel::readings(std::span<const FittedContact> contacts) const {
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(gauges());
  for (const FittedContact& contact : contacts)
    sum += ring_.under(fittedSpectrum(contact.load, ring_.harmonics()), contact.angle_rad).strains;
  return sum;
}

Eigen::MatrixX4d FitModel::slopes(const FittedContact& contact) const {
  const int last = ring_.harmonics();
  Eigen::MatrixX4d slopes(gauges(), 4);
  slopes.col(kAngle) = ring_.under(fittedSpectrum(contact.load, last), contact.angle_rad).slopes;
  const auto spectra = fittedSlopes(contact.load, last);
  for (const Parameter parameter : {kNormal, kTangential, kMoment})
    slopes.col(parameter) =
        ring_.under(spectra[static_cast<std::size_t>(parameter - kNormal)], contact.angle_rad).strains;
  return slopes;
}

double FitModel::uniformWidth_m(double moment_rad2) const {
  return config_.finger.outer_radius_m * model::uniformWidth_rad(moment_rad2);
}

double FitModel::uniformWidthSigma_m(double moment_rad2, double sigmaMoment_rad2) const {
  const double radius_m = config_.finger.outer_radius_m;
  return 6 * sigmaMoment_rad2 * radius_m * radius_m / uniformWidth_m(moment_rad2);
}

}  // namespace strainfinger::evidence
