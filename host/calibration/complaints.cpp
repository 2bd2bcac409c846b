#include "host/calibration/complaints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "host/base/failure.hpp"
#include "host/config/keys.hpp"

namespace strainfinger::calibration {
namespace {

/// Touches by hand, on a scale, are right to a few percent; the wrong touches, to none.
constexpr double kMostUnexplained = 0.2;
/// Of the noise: weak touches, many of them, may leave much of what was read.
constexpr double kMostExcess = 3;

[[noreturn]] void fail(const std::string& message) { throw Failure(ExitCode::kFailure, message); }

void requireTouch(const KnownTouch& touch, std::size_t row) {
  if (!std::isfinite(touch.angle_deg) || !std::isfinite(touch.normal_n_per_m) ||
      !std::isfinite(touch.tangential_n_per_m))
    fail(fmt::format("touch {}: its angle and loads must be finite numbers", row));
  if (touch.normal_n_per_m < 0)
    fail(fmt::format("touch {} pulls: normal_n_per_m = {} must be positive, or 0 for no touch", row,
                     touch.normal_n_per_m));
  if (touch.normal_n_per_m == 0 && touch.tangential_n_per_m != 0)
    fail(fmt::format("touch {} has tangential_n_per_m = {} without a normal load; both are 0 for no touch",
                     row, touch.tangential_n_per_m));
}

void requireWithinScale(const config::Gauges& gauges, const Eigen::MatrixXd& readings) {
  for (Eigen::Index row = 0; row < readings.rows(); ++row)
    for (Eigen::Index gauge = 0; gauge < readings.cols(); ++gauge)
      if (!(std::abs(readings(row, gauge)) < gauges.full_scale_strain))
        fail(fmt::format("row {}: gauge {} reads {}, at or beyond gauges.full_scale_strain = {}: press less",
                         row + 1, gauge, readings(row, gauge), gauges.full_scale_strain));
}

}  // namespace

void requireRows(const config::Gauges& gauges, std::span<const KnownTouch> touches,
                 const Eigen::MatrixXd& readings) {
  if (touches.empty()) fail("no touches: give at least one that is felt by every gauge");
  if (static_cast<std::size_t>(readings.rows()) != touches.size())
    fail(fmt::format("{} rows of strains and {} touches: each row needs its touch", readings.rows(),
                     touches.size()));
  if (readings.cols() != gauges.count)
    fail(fmt::format("{} strains in a row; there must be one a gauge, gauges.count = {}", readings.cols(),
                     gauges.count));
  for (std::size_t i = 0; i < touches.size(); ++i) requireTouch(touches[i], i + 1);
  requireWithinScale(gauges, readings);
}

void failUndetermined(const config::Gauges& gauges, const std::vector<int>& unknown,
                      const NeededTouch& needed) {
  std::string names;
  for (const int gauge : unknown)
    names += fmt::format("{}{} (at {:.6g} deg)", names.empty() ? "" : ", ", gauge, gauges.angle_deg(gauge));
  const std::string place =
      needed.offset_deg == 0 ? "over" : fmt::format("{:.1f} deg beside", needed.offset_deg);
  fail(
      fmt::format("the touches don't tell the gain to {:g} % of gauge {}: add touches {} each of these, of "
                  "{:.2g} N/m or more, or several of less",
                  100 * kMostGainSigma, names, place, needed.normal_n_per_m));
}

void requireExplained(const Eigen::MatrixXd& expected, const Eigen::MatrixXd& residuals, double excess) {
  const double share = residuals.norm() / expected.norm();
  if (excess <= kMostExcess || share <= kMostUnexplained) return;
  Eigen::Index row = 0, gauge = 0;
  residuals.cwiseAbs().maxCoeff(&row, &gauge);
  fail(fmt::format(
      "the touches don't explain the strains: {:.0f} % of them are left over, most of gauge {} in "
      "row {}; check the order of rows and gauges, the sense of angles, gauges.first_angle_deg",
      100 * share, gauge, row + 1));
}

void requireGains(const CalibrationFit& fit) {
  const auto keys = config::keys();
  const auto key = std::find_if(keys.begin(), keys.end(),
                                [](const config::Key& k) { return k.dotted() == "calibration.gain"; });
  for (std::size_t i = 0; i < fit.gauges.size(); ++i)
    if (const double gain = fit.gauges[i].gain.value; !key->domain.contains(gain))
      fail(
          fmt::format("gauge {} has a gain of {:.4g}; it must be {}: is it dead or its wires crossed, or is "
                      "[finger] another finger's?",
                      i, gain, key->domain.text()));
}

}  // namespace strainfinger::calibration
