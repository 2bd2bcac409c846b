#include "host/calibration/report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "host/calibration/expected_error.hpp"
#include "host/calibration/findings.hpp"

namespace strainfinger::calibration {
namespace {

constexpr std::size_t kMostListed = 20;  ///< rows of a kind

std::string estimateText(const char* name, const Estimate& estimate, double scale, const char* unit,
                         double drawn) {
  return fmt::format("{:<18}{:>11.5g} +- {:.2g} {} (drawn {:.5g})\n", name, scale * estimate.value,
                     scale * estimate.sigma, unit, scale * drawn);
}

std::string rubberText(const CalibrationResult& result) {
  const config::Finger& drawn = result.drawing().config().finger;
  return estimateText("core radius", result.coreRadius_m(), 1e3, "mm", drawn.core_radius_m) +
         estimateText("Poisson's ratio", result.poissonRatio(), 1, "", drawn.poisson_ratio) +
         estimateText("shear modulus", result.shearModulus_pa(), 1e-3, "kPa", drawn.shear_modulus_pa) +
         fmt::format("{:<18}{:>10.2g} % +- {:.2g} % of a touch's largest reading\n", "model error",
                     100 * result.modelError().value, 100 * result.modelError().sigma);
}

std::string worthText(const CalibrationResult& result) {
  const ExpectedErrors errors = expectedErrors(result);
  const auto line = [](const char* name, const Eigen::Vector3d& error) {
    return fmt::format("{:<26}{:>9.4f}{:>12.3f}{:>12.3f}\n", name, 1e3 * error[0], error[1], error[2]);
  };
  return fmt::format("\nErrors to expect of {} (RMS over the ring):\n", judgedTouchesText()) +
         fmt::format("{:<26}{:>9}{:>12}{:>12}\n", "", "place mm", "normal N/m", "tang. N/m") +
         line("before, as drawn", errors.before) + line("after", errors.after) +
         line("by the noise alone", errors.bound);
}

std::string untoldText(const CalibrationResult& result) {
  std::string text;
  for (const auto& sentences : {whatIsFarOff(result), whatIsUntold(result)})
    for (const std::string& sentence : sentences) text += sentence + "\n";
  const std::string turn = turnText(result);
  return turn.empty() ? text : text + turn + "\n";
}

std::string correlationText(const CalibrationResult& result) {
  std::string text;
  for (const Correlation& each : correlationsWorthKnowing(result))
    text += fmt::format("{} and {} are correlated: {:.2f}\n", each.one, each.other, each.value);
  return text;
}

/// Before and after, of the gauge and of the touch that are typical and worst after.
std::string residualText(const CalibrationResult& result) {
  constexpr double kMicro = 1e6;
  const auto line = [](const std::string& what, const Residuals::Of& of) {
    return fmt::format("{:<26}{:>9.1f}{:>12.1f}\n", what, kMicro * of.before_strain,
                       kMicro * of.after_strain);
  };
  const auto text = [&](const char* what, const std::vector<Residuals::Of>& all, std::size_t first) {
    std::vector<std::size_t> fitted;
    for (std::size_t i = 0; i < all.size(); ++i)
      if (!std::isnan(all[i].after_strain)) fitted.push_back(i);
    if (fitted.empty()) return std::string();
    std::sort(fitted.begin(), fitted.end(),
              [&](std::size_t a, std::size_t b) { return all[a].after_strain < all[b].after_strain; });
    const std::size_t median = fitted[fitted.size() / 2], worst = fitted.back();
    return line(fmt::format("median {}, {}", what, median + first), all[median]) +
           line(fmt::format("worst {}, {}", what, worst + first), all[worst]);
  };
  const Residuals residuals = residualsOf(result);
  return fmt::format("\nLeft over of readings, microstrain (RMS)\n{:<26}{:>9}{:>12}\n", "", "as drawn",
                     "after") +
         text("gauge", residuals.gauges, 0) + text("row", residuals.rows, 1);
}

std::string rowsText(const CalibrationResult& result) {
  std::string text = fmt::format("\n{} rows: {} fitted, {} untouched\n", result.rows().size(),
                                 result.count(RowUse::kFitted), result.count(RowUse::kUntouched));
  for (const LeftOut& left : rowsLeftOut(result)) {
    text += fmt::format("left out, {}: {} rows:", left.reason, left.rows.size());
    for (std::size_t i = 0; i < std::min(left.rows.size(), kMostListed); ++i)
      text += fmt::format(" {}", left.rows[i]);
    text += left.rows.size() > kMostListed ? " ..\n" : "\n";
  }
  const std::string moved = movedZeroText(result);
  if (!moved.empty()) text += moved + "\n";
  return text;
}

}  // namespace

std::string textReport(const CalibrationResult& result) {
  return rubberText(result) + correlationText(result) + worthText(result) + residualText(result) + "\n" +
         untoldText(result) + rowsText(result);
}

}  // namespace strainfinger::calibration
