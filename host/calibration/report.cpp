#include "host/calibration/report.hpp"

#include <fmt/format.h>

#include <array>
#include <cmath>
#include <vector>

#include "host/calibration/complaints.hpp"
#include "host/calibration/expected_error.hpp"

namespace strainfinger::calibration {
namespace {

/// Of its tolerance: what is known no better was not told by the touches.
constexpr double kUntold = 0.5;
/// Two unknowns whose correlation is beyond this are told as a pair: their sum or their difference.
constexpr double kRemarkable = 0.9;
constexpr int kMostListed = 20;  ///< rows of a kind

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
         fmt::format("{:<18}{:>10.2g} % +- {:.2g} % of a touch's largest reading\n", "unexplained",
                     100 * result.modelError().value, 100 * result.modelError().sigma);
}

std::string worthText(const CalibrationResult& result) {
  const ExpectedErrors errors = expectedErrors(result);
  const auto line = [](const char* name, const Eigen::Vector3d& error) {
    return fmt::format("{:<26}{:>9.4f}{:>12.3f}{:>12.3f}\n", name, 1e3 * error[0], error[1], error[2]);
  };
  return "\nErrors to expect of touches of 30 N/m, 2 mm wide (RMS over the ring):\n" +
         fmt::format("{:<26}{:>9}{:>12}{:>12}\n", "", "place mm", "normal N/m", "tang. N/m") +
         line("before, as drawn", errors.before) + line("after", errors.after) +
         line("by the noise alone", errors.bound);
}

/// How well the touches tell a direction in which nothing is told by the strains themselves.
double sigmaOfMean(const CalibrationResult& result, GaugeUnknown unknown) {
  const int gauges = result.drawing().gauges();
  double variance = 0;
  for (int a = 0; a < gauges; ++a)
    for (int b = 0; b < gauges; ++b)
      variance += result.covariance()(Drawing::at(a, unknown), Drawing::at(b, unknown));
  return std::sqrt(variance) / gauges;
}

/// Gauges of which the drawing says as much as the touches.
std::string untoldText(const CalibrationResult& result) {
  const std::string names = untoldGauges(result, {kGain, kAngleOffset, kDepthOffset}, kUntold);
  if (names.empty()) return "";
  return fmt::format(
      "Little is told of gauges {}: what isn't is the drawing's. Touches over them and beside "
      "them tell more.\n",
      names);
}

/// What strains at unknown places under unknown loads can't tell.
std::string freedomText(const CalibrationResult& result) {
  const Drawing& drawing = result.drawing();
  const double alone = 1 / std::sqrt(static_cast<double>(drawing.gauges()));  // by the drawing alone
  std::string text;
  if (sigmaOfMean(result, kAngleOffset) > 0.9 * alone)
    text +=
        "No direction is known: angles count from where the drawing has the gauges on average. One touch "
        "with a known angle_deg mends that.\n";
  const Eigen::Index modulus = drawing.at(kShearModulus);
  if (std::sqrt(result.covariance()(modulus, modulus)) > kUntold)
    text +=
        "No load is known: forces are right as far as finger.shear_modulus_pa is. Some touches on a "
        "scale, with a known normal_n_per_m, mend that.\n";
  return text;
}

std::string correlationText(const CalibrationResult& result) {
  const Drawing& drawing = result.drawing();
  const Eigen::VectorXd sigma = result.covariance().diagonal().cwiseSqrt();
  const std::array rubber{std::pair{kCoreRadius, "core radius"}, std::pair{kPoissonRatio, "Poisson's ratio"},
                          std::pair{kShearModulus, "shear modulus"}};
  const std::array gauge{std::pair{kGain, "gains"}, std::pair{kDepthOffset, "depths"}};
  std::string text;
  const auto add = [&](const char* a, const char* b, double correlation) {
    if (std::abs(correlation) > kRemarkable)
      text += fmt::format("{} and {} are told together: correlation {:.2f}\n", a, b, correlation);
  };
  const auto between = [&](Eigen::Index a, Eigen::Index b) {
    return result.covariance()(a, b) / (sigma[a] * sigma[b]);
  };
  for (std::size_t a = 0; a < rubber.size(); ++a)
    for (std::size_t b = a + 1; b < rubber.size(); ++b)
      add(rubber[a].second, rubber[b].second,
          between(drawing.at(rubber[a].first), drawing.at(rubber[b].first)));
  for (const auto& [unknown, name] : rubber)
    for (const auto& [of, gauges] : gauge) {
      double sum = 0;
      for (int i = 0; i < drawing.gauges(); ++i) sum += between(drawing.at(unknown), Drawing::at(i, of));
      add(name, gauges, sum / drawing.gauges());
    }
  return text;
}

std::string reasonOf(RowUse use) {
  switch (use) {
    case RowUse::kWeak:
      return "too weak to tell anything";
    case RowUse::kAmbiguous:
      return "explained by touches at two places or of two widths";
    case RowUse::kOverRange:
      return "over range: press less";
    case RowUse::kUnexplained:
      return "explained by no single touch (two contacts, a slip, a zero that moved)";
    default:
      return "";
  }
}

std::string rowsText(const CalibrationResult& result) {
  std::string text = fmt::format("\n{} rows: {} fitted, {} untouched\n", result.rows().size(),
                                 result.count(RowUse::kFitted), result.count(RowUse::kUntouched));
  for (const RowUse use : {RowUse::kWeak, RowUse::kAmbiguous, RowUse::kOverRange, RowUse::kUnexplained}) {
    const int count = result.count(use);
    if (count == 0) continue;
    text += fmt::format("left out, {}: {} rows:", reasonOf(use), count);
    int listed = 0;
    for (std::size_t row = 0; row < result.rows().size() && listed < kMostListed; ++row)
      if (result.rows()[row].use == use) {
        text += fmt::format(" {}", row + 1);
        ++listed;
      }
    text += count > kMostListed ? " ..\n" : "\n";
  }
  return text;
}

}  // namespace

const char* nameOf(RowUse use) {
  switch (use) {
    case RowUse::kFitted:
      return "fitted";
    case RowUse::kUntouched:
      return "untouched";
    case RowUse::kWeak:
      return "weak";
    case RowUse::kAmbiguous:
      return "ambiguous";
    case RowUse::kOverRange:
      return "over-range";
    case RowUse::kUnexplained:
      break;
  }
  return "unexplained";
}

std::string textReport(const CalibrationResult& result) {
  return rubberText(result) + correlationText(result) + worthText(result) + freedomText(result) +
         untoldText(result) + rowsText(result);
}

}  // namespace strainfinger::calibration
