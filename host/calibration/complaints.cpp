#include "host/calibration/complaints.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <string_view>
#include <utility>

#include "host/base/failure.hpp"
#include "host/base/text_parts.hpp"
#include "host/calibration/expected_error.hpp"
#include "host/calibration/row_use.hpp"
#include "host/config/keys.hpp"
#include "host/config/read_config.hpp"
#include "host/config/write_config.hpp"

namespace strainfinger::calibration {
namespace {

/// A touch has four unknowns; a gauge as many again, that eight touches in its sight tell.
constexpr int kLeastTouchesPerGauge = 2;
/// Of the largest reading. Healthy fingers leave 0.05 %; every other gauge of the wrong sign, which no single
/// mend of the wiring explains, leaves 4 to 5 % where depths and Poisson's ratio follow it.
constexpr double kMostUnexplained = 0.03;
/// Of all rows; junk is a tenth of a careless session.
constexpr double kMostRowsUnexplained = 0.4;
/// Of its tolerance: what is known of a gauge no better than that was not told by the touches.
constexpr double kMostUntold = 0.7;

/// A known angle; beyond it another unit or a slip of the keyboard.
constexpr double kMostAngle_deg = 360;

/// Rows that a message names, at most.
constexpr std::size_t kMostNamed = 10;

constexpr const char* kTouchesToAdd =
    "add touches at ten places or more over each of them and between it and its neighbours, of various "
    "loads, some rubbed to either side";

[[noreturn]] void fail(const std::string& message) { throw Failure(ExitCode::kFailure, message); }

/// All of them.
template <typename Fault>
std::string textOfAll(const std::vector<Fault>& faults) {
  std::string text;
  for (const Fault& fault : faults) text += (text.empty() ? "" : "; ") + textOf(fault);
  return text;
}

std::string rowNames(const std::vector<std::size_t>& rows) {
  const auto named = rows.begin() + static_cast<std::ptrdiff_t>(std::min(kMostNamed, rows.size()));
  return fmt::format("{}{}", fmt::join(rows.begin(), named, ", "), named == rows.end() ? "" : ", ..");
}

/// "3 (at 67.5 deg)".
std::string placed(const config::Gauges& gauges, int gauge) {
  return fmt::format("{} (at {:.6g} deg)", gauge, gauges.angle_deg(gauge));
}

/// Of a list with a number a gauge, that each is what a config may say.
void requireWithin(const config::Gauges& gauges, const char* key, const std::vector<double>& values,
                   const char* what, const char* lookAt) {
  const config::Domain& domain = config::keyOf(key).domain;
  std::string text;
  for (int gauge = 0; gauge < gauges.count; ++gauge) {
    const double value = values[static_cast<std::size_t>(gauge)];
    if (domain.contains(value)) continue;
    text +=
        fmt::format("{}gauge {}: {} {:.4g}", text.empty() ? "" : "; ", placed(gauges, gauge), what, value);
  }
  if (!text.empty()) fail(fmt::format("{}; {} must be {}: look at {}", text, key, domain.text(), lookAt));
}

/// "of 300 rows 200 are wide, 9 untouched: press with an edge; "; empty where no row is left out.
std::string leftOutText(std::span<const RowResult> rows) {
  std::vector<std::pair<std::ptrdiff_t, RowUse>> counts;
  for (const RowUseWords& words : kRowUses)
    if (const auto count = std::ranges::count(rows, words.use, &RowResult::use);
        count > 0 && words.use != RowUse::kFitted)
      counts.emplace_back(count, words.use);
  if (counts.empty()) return {};
  std::ranges::stable_sort(counts, std::ranges::greater{}, &std::pair<std::ptrdiff_t, RowUse>::first);
  std::string text;
  for (const auto& [count, use] : counts)
    text += fmt::format("{}{} {}", text.empty() ? "" : ", ", count, nameOf(use));
  return fmt::format("of {} rows are {}: {}; ", rows.size(), text, mendOf(counts.front().second, rows));
}

bool isFinite(const std::optional<double>& value) { return std::isfinite(value.value_or(0)); }

}  // namespace

std::string ofFile(std::string message, const std::string& touchesPath) {
  return replacedAll(std::move(message), "touches.csv", touchesPath);
}

void requireTouch(const KnownTouch& touch, const std::string& place) {
  if (!isFinite(touch.angle_deg) || !isFinite(touch.normal_n_per_m) || !isFinite(touch.tangential_n_per_m))
    fail(fmt::format("{}: its angle and loads must be finite numbers, or empty if they are unknown", place));
  if (std::abs(touch.angle_deg.value_or(0)) > kMostAngle_deg)
    fail(fmt::format("{}: angle_deg = {} must be within +-{}", place, *touch.angle_deg, kMostAngle_deg));
  if (touch.normal_n_per_m.value_or(0) < 0)
    fail(fmt::format("{} pulls: normal_n_per_m = {} must be positive, or 0 for no touch", place,
                     *touch.normal_n_per_m));
  if (touch.normal_n_per_m == 0.0 && !touch.isUntouched())
    fail(
        fmt::format("{} has normal_n_per_m = 0: then tangential_n_per_m must be 0 too, for no touch", place));
}

void requireRows(const config::Gauges& gauges, std::span<const KnownTouch> known,
                 const Eigen::MatrixXd& readings) {
  if (!known.empty() && static_cast<std::size_t>(readings.rows()) != known.size())
    fail(
        fmt::format("{} rows of strains and {} touches: each row needs its touch, with empty cells for what "
                    "is not known",
                    readings.rows(), known.size()));
  if (readings.rows() == 0)
    fail(
        "there are no rows of strains: none were collected, or the file holds none; record them while the "
        "finger is touched");
  if (readings.cols() != gauges.count)
    fail(fmt::format("{} strains in a row; there must be one a gauge, gauges.count = {}", readings.cols(),
                     gauges.count));
  for (std::size_t i = 0; i < known.size(); ++i) requireTouch(known[i], fmt::format("touch {}", i + 1));
  for (Eigen::Index row = 0; row < readings.rows(); ++row)
    if (!readings.row(row).allFinite()) fail(fmt::format("row {}: a strain is no finite number", row + 1));
}

void requireWorking(const std::vector<FailedGauge>& failed) {
  if (!failed.empty()) throw FaultyFinger(textOfAll(failed));
}

void requireTouches(const config::Gauges& gauges, std::span<const RowResult> rows) {
  const std::ptrdiff_t least = kLeastTouchesPerGauge * gauges.count;
  const auto touches = std::ranges::count(rows, RowUse::kFitted, &RowResult::use);
  if (touches >= least) return;
  fail(
      fmt::format("{} rows with a touch are too few: at least {}, all around the ring, tell anything, 300 "
                  "tell it well; {}roll the finger along an edge while `strains` records",
                  touches, least, leftOutText(rows)));
}

void requireAllAround(const config::Gauges& gauges, const std::vector<int>& untouched) {
  if (untouched.empty()) return;
  fail(fmt::format(
      "no touches, or hardly any, are near these gauges: {}; {}. Where the finger was touched there, "
      "press less if they read beyond full scale, else look for open wires: they and the gauges beside them "
      "read most in no row",
      placesOf(gauges, untouched), kTouchesToAdd));
}

void requireWiring(const std::vector<WiringFault>& faults) {
  if (faults.empty()) return;
  if (std::ranges::any_of(faults, isOfFinger)) throw FaultyFinger(textOfAll(faults));
  fail(textOfAll(faults));
}

void requireExplained(double modelError, double shareOfRowsUnexplained) {
  const char* const hint =
      "check the order and signs of the gauges, [finger], gauges.radius_m and what is known of touches";
  if (modelError > kMostUnexplained)
    fail(fmt::format(
        "the model of this finger doesn't explain the readings: residuals are {:.0f} % of a touch's largest "
        "reading; {}",
        100 * modelError, hint));
  if (shareOfRowsUnexplained > kMostRowsUnexplained)
    fail(
        fmt::format("the model of this finger doesn't explain {:.0f} % of the rows; {}, and touch the finger "
                    "in one place at a time",
                    100 * shareOfRowsUnexplained, hint));
}

void requireStill(const std::vector<MovedZero>& moved, double shareOfRowsUnexplained) {
  if (moved.empty() || shareOfRowsUnexplained <= kMostRowsUnexplained) return;
  fail(fmt::format(
      "zeros moved during the session: {} than in the others; {:.0f} % of the rows are left out, too "
      "many to know which the zeros are: tare, and touch the finger anew",
      textOf(moved), 100 * shareOfRowsUnexplained));
}

void refuseContradicted(const std::vector<std::size_t>& rows, std::size_t borneOut, const char* what,
                        const char* lookAt) {
  const std::string others =
      borneOut == 0 ? "none of the others is"
                    : fmt::format("of the others only {} {}", borneOut, borneOut == 1 ? "is" : "are");
  fail(fmt::format(
      "in {} rows ({}) the readings contradict the {} of touches.csv, and {} fitted; check {}; check also "
      "that each value is in the column that its header names, and each touch in its row of strains",
      rows.size(), rowNames(rows), what, others, lookAt));
}

std::vector<int> untoldGauges(const CalibrationResult& result, GaugeUnknown unknown, double most) {
  const Eigen::MatrixXd covariance = withoutConventions(result.drawing(), result.covariance());
  std::vector<int> untold;
  for (int gauge = 0; gauge < result.drawing().gauges(); ++gauge) {
    const Eigen::Index at = Drawing::at(gauge, unknown);
    if (std::sqrt(covariance(at, at)) > most) untold.push_back(gauge);
  }
  return untold;
}

std::string placesOf(const config::Gauges& gauges, const std::vector<int>& which) {
  std::string names;
  for (const int gauge : which) names += (names.empty() ? "" : ", ") + placed(gauges, gauge);
  return names;
}

void requireTold(const CalibrationResult& result) {
  const std::vector<int> untold = untoldGauges(result, kAngleOffset, kMostUntold);
  if (untold.empty()) return;
  fail(
      fmt::format("the touches don't determine the angles of these gauges: {}; {}. Where there are such "
                  "touches, check the order in which these gauges are connected",
                  placesOf(result.drawing().config().gauges, untold), kTouchesToAdd));
}

void requireReadable(const CalibrationResult& result) {
  const config::FingerConfig config = result.applied();
  const config::Calibration& found = config.calibration;
  const config::Gauges& drawn = result.drawing().config().gauges;
  requireWithin(drawn, "calibration.gain", found.gain, "gain", "its joint and its wires");
  requireWithin(drawn, "calibration.angle_offset_deg", found.angle_offset_deg,
                "angle less the drawing's [deg]",
                "how it is glued, or draw the ring as it is, gauges.angle_deg");
  try {
    config::readConfig(config::writeConfig(config), "the config");
  } catch (const Failure& failure) {
    fail(
        fmt::format("what was found can't be written as a config: {}; look at [finger], gauges.radius_m and "
                    "the known loads",
                    failure.what()));
  }
}

}  // namespace strainfinger::calibration
