#include "host/calibration/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host/base/no_value.hpp"
#include "host/calibration/complaints.hpp"
#include "host/calibration/expected_error.hpp"
#include "host/calibration/touch_fit.hpp"

namespace strainfinger::calibration {
namespace {

/// Of its tolerance: what is known no better was not told by the touches.
constexpr double kUntold = 0.5;
/// Two unknowns whose correlation is beyond this are told as a pair: their sum or their difference.
constexpr double kRemarkable = 0.9;

std::string reasonOf(RowUse use) {
  switch (use) {
    case RowUse::kWeak:
      return "too weak to tell anything";
    case RowUse::kAmbiguous:
      return "explained by touches at two places or of two widths";
    case RowUse::kWide:
      return "as wide as a slip or two contacts look: press with an edge";
    case RowUse::kOverRange:
      return "over range: press less";
    case RowUse::kContradicted:
      return "not as touches.csv has them: look at their angles and loads";
    case RowUse::kUnexplained:
      return "explained by no single touch (two contacts, a slip, a zero that moved)";
    default:
      return "";
  }
}

}  // namespace

std::vector<std::string> whatIsUntold(const CalibrationResult& result) {
  std::vector<std::string> sentences;
  if (!result.isDirectionKnown())
    sentences.emplace_back(
        "No direction is known of the fitted rows: angles count from where the drawing has the gauges on "
        "average. One touch with a known angle_deg mends that.");
  if (!result.isLoadKnown())
    sentences.emplace_back(
        "No load is known of the fitted rows: forces are right as far as finger.shear_modulus_pa is. Some "
        "touches on a scale, with a known normal_n_per_m, mend that.");
  const std::string names = untoldGauges(result, {kGain, kAngleOffset, kDepthOffset}, kUntold);
  if (!names.empty())
    sentences.push_back(
        fmt::format("Little is told of gauges {}: what isn't is the drawing's. Touches over them and beside "
                    "them tell more.",
                    names));
  return sentences;
}

std::vector<Correlation> correlationsWorthKnowing(const CalibrationResult& result) {
  const Drawing& drawing = result.drawing();
  const Eigen::VectorXd sigma = result.covariance().diagonal().cwiseSqrt();
  const std::array rubber{std::pair{kCoreRadius, "core radius"}, std::pair{kPoissonRatio, "Poisson's ratio"},
                          std::pair{kShearModulus, "shear modulus"}};
  const std::array gauge{std::pair{kGain, "gains"}, std::pair{kDepthOffset, "depths"}};
  std::vector<Correlation> correlations;
  const auto add = [&](const char* a, const char* b, double correlation) {
    if (std::abs(correlation) > kRemarkable) correlations.push_back({a, b, correlation});
  };
  const auto between = [&](Eigen::Index a, Eigen::Index b) {
    return result.covariance()(a, b) / (sigma[a] * sigma[b]);
  };
  for (std::size_t a = 0; a < rubber.size(); ++a)
    for (std::size_t b = a + 1; b < rubber.size(); ++b)
      add(rubber[a].second, rubber[b].second,
          between(drawing.at(rubber[a].first), drawing.at(rubber[b].first)));
  double ofOneGauge = 0;
  for (int i = 0; i < drawing.gauges(); ++i)
    ofOneGauge += between(Drawing::at(i, kGain), Drawing::at(i, kDepthOffset)) / drawing.gauges();
  add("gains", "depths of the same gauges", ofOneGauge);
  for (const auto& [unknown, name] : rubber)
    for (const auto& [of, gauges] : gauge) {
      double sum = 0;
      for (int i = 0; i < drawing.gauges(); ++i) sum += between(drawing.at(unknown), Drawing::at(i, of));
      add(name, gauges, sum / drawing.gauges());
    }
  return correlations;
}

std::vector<LeftOut> rowsLeftOut(const CalibrationResult& result) {
  std::vector<LeftOut> all;
  for (const RowUse use : {RowUse::kWeak, RowUse::kAmbiguous, RowUse::kWide, RowUse::kOverRange,
                           RowUse::kContradicted, RowUse::kUnexplained}) {
    LeftOut left{use, reasonOf(use), {}};
    for (std::size_t row = 0; row < result.rows().size(); ++row)
      if (result.rows()[row].use == use) left.rows.push_back(row + 1);
    if (!left.rows.empty()) all.push_back(std::move(left));
  }
  return all;
}

std::string movedZeroText(const CalibrationResult& result) {
  const auto& moved = result.movedZeros();
  if (moved.empty()) return "";
  return fmt::format(
      "{} moved during the session: {} than in the others. These rows are left out. Tare, and touch the "
      "finger anew, all around.",
      moved.size() == 1 ? "A zero" : "Zeros", textOf(moved));
}

std::string turnText(const CalibrationResult& result) {
  const double turn_deg = result.drawnTurn_deg();
  if (turn_deg == 0) return "";
  return fmt::format(
      "The known angles turn the ring by {:.2f} deg (counter-clockwise positive): the config has that in "
      "gauges.{}, and in [calibration] what each gauge is off besides.",
      turn_deg, result.drawing().config().gauges.isEven() ? "first_angle_deg" : "angle_deg");
}

Residuals residualsOf(const CalibrationResult& result) {
  const Drawing& drawing = result.drawing();
  const int last = RingResponse::lastHarmonic(drawing);
  const RingResponse fitted(drawing, result.deviations(), last);
  const RingResponse drawn(drawing, Eigen::VectorXd::Zero(drawing.unknowns()), last);
  const double noise_strain = drawing.config().gauges.noise_strain;
  const auto gauges = static_cast<std::size_t>(drawing.gauges());
  const auto rms = [](double squares, std::size_t count) {
    return std::sqrt(squares / static_cast<double>(std::max<std::size_t>(1, count)));
  };
  Residuals residuals{std::vector<Residuals::Of>(gauges), {}};
  std::size_t rows = 0;
  for (const RowResult& row : result.rows()) {
    if (row.use != RowUse::kFitted && row.use != RowUse::kUntouched) {
      residuals.rows.push_back({kNoValue, kNoValue});
      continue;
    }
    ++rows;
    const Eigen::VectorXd readings = fitted.readings(row.touch) + row.residual_strain;
    const TouchState suits = refineTouch(drawn, {readings, noise_strain, {}}, row.touch).touch;
    const Eigen::VectorXd before = readings - drawn.readings(suits);
    for (std::size_t gauge = 0; gauge < gauges; ++gauge) {
      const auto at = static_cast<Eigen::Index>(gauge);
      residuals.gauges[gauge].before_strain += before[at] * before[at];
      residuals.gauges[gauge].after_strain += row.residual_strain[at] * row.residual_strain[at];
    }
    residuals.rows.push_back(
        {rms(before.squaredNorm(), gauges), rms(row.residual_strain.squaredNorm(), gauges)});
  }
  for (Residuals::Of& gauge : residuals.gauges)
    gauge = {rms(gauge.before_strain, rows), rms(gauge.after_strain, rows)};
  return residuals;
}

}  // namespace strainfinger::calibration
