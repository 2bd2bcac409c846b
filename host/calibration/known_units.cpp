#include "host/calibration/known_units.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/base/angles.hpp"
#include "host/base/failure.hpp"
#include "host/base/quantile.hpp"
#include "host/config/over_range.hpp"

namespace strainfinger::calibration {
namespace {

constexpr double kTurn_rad = 2 * std::numbers::pi;
constexpr double kAnotherUnit = 10;
constexpr std::size_t kLeastSaid = 3;
/// Of a row's energy, that no touch of the drawn finger explains: with more it tells of wires or zeros. Of a
/// glued finger's rows a thousandth is left (kHealthy, wiring.cpp).
constexpr double kMostUnexplainedShare = 0.1;
/// Of the normal load: a smaller tangential one may be of either sign by the readings.
constexpr double kFirmRub = 0.2;

double apart_rad(double one_rad, double other_rad) { return std::abs(shortWay_rad(one_rad, other_rad)); }

/// What is said of touches, beside the touches of the drawn finger that read most alike.
struct Compared {
  std::vector<double> angles;                        ///< in whatever unit
  std::vector<double> asDegrees_rad, asRadians_rad;  ///< between the places, with the angles as either
  std::vector<double> said_n_per_m, drawn_n_per_m, saidToDrawn;  ///< normal loads
  std::vector<double> rubSaidToDrawn;                            ///< tangential loads that are firm
};

bool isExplained(const TouchSearch& drawn, const Eigen::VectorXd& strains) {
  return drawn.unexplainedShare(strains) < kMostUnexplainedShare;
}

bool isOfAnotherUnit(double saidToDrawn) {
  return saidToDrawn > kAnotherUnit || saidToDrawn < 1 / kAnotherUnit;
}

bool isComparable(const config::FingerConfig& config, const TouchSearch& drawn,
                  const Eigen::VectorXd& strains) {
  const double peak = strains.lpNorm<Eigen::Infinity>();
  return peak > kWeakestTouch * config.gauges.noise_strain && !config::isOverRange(config.gauges, peak) &&
         isExplained(drawn, strains);
}

Compared comparedWithDrawing(const config::FingerConfig& config, std::span<const KnownTouch> known,
                             const Eigen::MatrixXd& readings) {
  const TouchSearch search = drawnSearch(config);
  Compared compared;
  for (std::size_t row = 0; row < known.size(); ++row) {
    const KnownTouch& touch = known[row];
    const bool isLoadSaid = touch.normal_n_per_m.value_or(0) > 0;
    if (touch.isUntouched() || (!touch.angle_deg && !isLoadSaid)) continue;
    const Eigen::VectorXd strains = readings.row(static_cast<Eigen::Index>(row)).transpose();
    if (!isComparable(config, search, strains)) continue;
    const TouchState drawn = search.guess(strains);
    if (touch.angle_deg) {
      compared.angles.push_back(*touch.angle_deg);
      compared.asDegrees_rad.push_back(apart_rad(*touch.angle_deg * kRadPerDeg, drawn[kPlace]));
      compared.asRadians_rad.push_back(apart_rad(*touch.angle_deg, drawn[kPlace]));
    }
    if (!isLoadSaid) continue;
    compared.said_n_per_m.push_back(*touch.normal_n_per_m);
    compared.drawn_n_per_m.push_back(drawn[kNormalLoad]);
    compared.saidToDrawn.push_back(*touch.normal_n_per_m / drawn[kNormalLoad]);
    const double rub_n_per_m = touch.tangential_n_per_m.value_or(0);
    if (drawn[kNormalLoad] > 0 && std::abs(rub_n_per_m) > kFirmRub * *touch.normal_n_per_m &&
        std::abs(drawn[kTangentialLoad]) > kFirmRub * drawn[kNormalLoad])
      compared.rubSaidToDrawn.push_back(rub_n_per_m / drawn[kTangentialLoad]);
  }
  return compared;
}

/// Of one place alone a unit cannot be told from a ring that is turned, nor of angles beyond a turn in
/// radians.
bool areRadians(const Compared& compared, double pitch_rad) {
  if (compared.angles.size() < kLeastSaid) return false;
  const auto [least, most] = std::ranges::minmax(compared.angles);
  return least >= -kTurn_rad && most <= kTurn_rad && most - least > pitch_rad &&
         medianOf(compared.asRadians_rad) < pitch_rad / 2 && medianOf(compared.asDegrees_rad) > pitch_rad;
}

/// All push the other way than the readings say. Without angles that fit the drawing, gauges that are wired
/// the other way round would look the same.
bool areOpposite(const Compared& compared, double pitch_rad) {
  if (compared.rubSaidToDrawn.size() < kLeastSaid || compared.angles.size() < kLeastSaid) return false;
  return std::ranges::max(compared.rubSaidToDrawn) < 0 &&
         std::ranges::max(compared.asDegrees_rad) < pitch_rad / 2;
}

std::size_t countSaid(std::span<const KnownTouch> known) {
  return static_cast<std::size_t>(std::ranges::count_if(known, [](const KnownTouch& touch) {
    return !touch.isUntouched() && (touch.angle_deg || touch.normal_n_per_m);
  }));
}

}  // namespace

bool isOfAnotherUnit(const TouchSearch& drawn, const Eigen::VectorXd& strains, double said_n_per_m) {
  return isExplained(drawn, strains) && isOfAnotherUnit(said_n_per_m / drawn.guess(strains)[kNormalLoad]);
}

std::optional<double> placeRead_deg(const TouchSearch& drawn, const Eigen::VectorXd& strains) {
  if (!isExplained(drawn, strains)) return std::nullopt;
  return degreesOf(drawn.guess(strains)[kPlace]);
}

void requireUnits(const config::FingerConfig& config, std::span<const KnownTouch> known,
                  const Eigen::MatrixXd& readings) {
  if (countSaid(known) < kLeastSaid) return;
  const Compared compared = comparedWithDrawing(config, known, readings);
  if (areRadians(compared, kTurn_rad / config.gauges.count))
    throw Failure(ExitCode::kFailure,
                  "the angle_deg of touches.csv are radians by the readings: multiply them by 57.29578");
  if (areOpposite(compared, kTurn_rad / config.gauges.count))
    throw Failure(ExitCode::kFailure,
                  "the tangential_n_per_m of touches.csv push the other way than the readings say, all of "
                  "them: they are positive towards growing angles, so change their signs");
  if (compared.said_n_per_m.size() < kLeastSaid || !isOfAnotherUnit(medianOf(compared.saidToDrawn))) return;
  throw Failure(
      ExitCode::kFailure,
      fmt::format("the normal_n_per_m of touches.csv are {:.3g} N/m in the median, where a finger as in "
                  "the config reads so under about {:.3g} N/m: they must be newtons per metre of its "
                  "length (finger.length_m = {}); else look at finger.shear_modulus_pa",
                  medianOf(compared.said_n_per_m), medianOf(compared.drawn_n_per_m), config.finger.length_m));
}

}  // namespace strainfinger::calibration
