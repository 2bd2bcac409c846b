#include "host/calibration/known_units.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <vector>

#include "host/base/angles.hpp"
#include "host/base/failure.hpp"
#include "host/base/median.hpp"
#include "host/calibration/touch_fit.hpp"

namespace strainfinger::calibration {
namespace {

constexpr double kAnotherUnit = 10;
constexpr std::size_t kLeastSaid = 3;

double apart_rad(double one_rad, double other_rad) {
  return std::abs(std::remainder(one_rad - other_rad, 2 * std::numbers::pi));
}

/// Beside the touches of the drawn finger that read most alike.
struct Compared {
  std::vector<double> asDegrees_rad, asRadians_rad;  ///< between the places, with the angles as either
  std::vector<double> said, drawn;                   ///< normal loads [N/m]
};

Compared comparedWithDrawing(const config::FingerConfig& config, std::span<const KnownTouch> known,
                             const Eigen::MatrixXd& readings) {
  const TouchSearch search = drawnSearch(config);
  Compared compared;
  for (std::size_t row = 0; row < known.size(); ++row) {
    const KnownTouch& touch = known[row];
    if (touch.isUntouched() || (!touch.angle_deg && !touch.normal_n_per_m)) continue;
    const TouchState drawn = search.guess(readings.row(static_cast<Eigen::Index>(row)).transpose());
    if (!(drawn[kNormalLoad] > 0)) continue;
    if (touch.angle_deg) {
      compared.asDegrees_rad.push_back(apart_rad(*touch.angle_deg * kRadPerDeg, drawn[kPlace]));
      compared.asRadians_rad.push_back(apart_rad(*touch.angle_deg, drawn[kPlace]));
    }
    if (touch.normal_n_per_m) {
      compared.said.push_back(*touch.normal_n_per_m);
      compared.drawn.push_back(drawn[kNormalLoad]);
    }
  }
  return compared;
}

}  // namespace

bool isOfAnotherUnit(double said_n_per_m, double drawn_n_per_m) {
  return said_n_per_m > kAnotherUnit * drawn_n_per_m || kAnotherUnit * said_n_per_m < drawn_n_per_m;
}

void requireUnits(const config::FingerConfig& config, std::span<const KnownTouch> known,
                  const Eigen::MatrixXd& readings) {
  const Compared compared = comparedWithDrawing(config, known, readings);
  const double pitch_rad = 2 * std::numbers::pi / config.gauges.count;
  if (compared.asRadians_rad.size() >= kLeastSaid && medianOf(compared.asRadians_rad) < pitch_rad / 2 &&
      medianOf(compared.asDegrees_rad) > pitch_rad)
    throw Failure(ExitCode::kFailure,
                  "the angle_deg of touches.csv are radians by the readings: multiply them by 57.29578");
  if (compared.said.size() < kLeastSaid) return;
  const double said_n_per_m = medianOf(compared.said), drawn_n_per_m = medianOf(compared.drawn);
  if (isOfAnotherUnit(said_n_per_m, drawn_n_per_m))
    throw Failure(
        ExitCode::kFailure,
        fmt::format("the normal_n_per_m of touches.csv are {:.2g} N/m as a rule, where the finger as "
                    "drawn reads as under {:.2g} N/m: they must be newtons per metre of its length "
                    "(finger.length_m = {}); else look at finger.shear_modulus_pa",
                    said_n_per_m, drawn_n_per_m, config.finger.length_m));
}

}  // namespace strainfinger::calibration
