#include "host/calibration/findings.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "host/base/angles.hpp"
#include "host/base/no_value.hpp"
#include "host/calibration/complaints.hpp"
#include "host/calibration/expected_error.hpp"
#include "host/calibration/noise_found.hpp"
#include "host/calibration/row_use.hpp"
#include "host/calibration/touch_fit.hpp"

namespace strainfinger::calibration {
namespace {

/// Of its tolerance: what is known no better was not told by the touches.
constexpr double kUntold = 0.5;
/// Two unknowns whose correlation is beyond this are told as a pair: their sum or their difference.
constexpr double kRemarkable = 0.9;

/// A load that is known to be none is fitted within 1e-6 N/m; the weakest touch that tells anything has some
/// tenths of 1 N/m.
constexpr double kTrace_n_per_m = 1e-3;
constexpr const char* kZerosDrifted =
    "known to be untouched, with other zeros than the rest of the session has: the zeros drifted; tare, and "
    "touch the finger anew";
constexpr const char* kNoisy = "known to be untouched, and noisier than gauges.noise_strain has it";

/// Of its tolerance: of 67 unknowns one is further off the drawing in 4 fingers of 1,000 by chance.
constexpr double kFarOff = 4;
/// The same of the modulus alone, in one finger of 20: a full scale or known loads that are off by a factor
/// of 1.5 make it 2.
constexpr double kFarOffModulus = 2;

/// An unknown of gauges, in people's units: what to look at where it is far off at a gauge, and where it is
/// at most of them.
struct GaugeWords {
  GaugeUnknown unknown;
  const char* name;
  const char* nameBelow0;  ///< then the value is told without its sign; empty: with it
  const char* unit;
  double perUnit;
  const char* lookAt;
  const char* lookAtIfMost;
};
constexpr std::array kGaugeWords{
    GaugeWords{kGain, "gain", "", "", 1, "look at its joint and wires",
               "check gauges.full_scale_strain and finger.outer_radius_m"},
    GaugeWords{kZero, "zero", "", " microstrain", 1e-6, "tare", "tare"},
    GaugeWords{kAngleOffset, "angle off by", "", " deg from where the ring as a whole lies", kRadPerDeg,
               "look at how it is glued", "check gauges.angle_deg"},
    GaugeWords{kDepthOffset, "too deep by", "too shallow by", " um", 1e-6, "look at how it is glued",
               "check gauges.radius_m"}};

/// In tolerances, and in the words' unit.
struct Off {
  int gauge;
  double tolerances, value;
};

Off offOf(const CalibrationResult& result, const GaugeWords& words, int gauge) {
  const Drawing& drawing = result.drawing();
  const double tolerance = drawing.tolerance(words.unknown);
  double deviation = result.deviations()[Drawing::at(gauge, words.unknown)];
  if (words.unknown == kAngleOffset) deviation -= result.turn_deg() * kRadPerDeg / tolerance;
  const double nominal = words.unknown == kGain ? 1 : 0;
  return {gauge, std::abs(deviation), (nominal + tolerance * deviation) / words.perUnit};
}

void addFarOff(const CalibrationResult& result, const GaugeWords& words,
               std::vector<std::string>& sentences) {
  const config::Gauges& gauges = result.drawing().config().gauges;
  std::vector<Off> far;
  for (int gauge = 0; gauge < gauges.count; ++gauge)
    if (const Off off = offOf(result, words, gauge); off.tolerances > kFarOff) far.push_back(off);
  const auto text = [&](const std::string& whose, const Off& off, const char* lookAt) {
    const bool isBelow = off.value < 0 && *words.nameBelow0 != 0;
    sentences.push_back(fmt::format("{}: {} {:.3g}{}, {:.1f} tolerances off the drawing: {}.", whose,
                                    isBelow ? words.nameBelow0 : words.name, isBelow ? -off.value : off.value,
                                    words.unit, off.tolerances, lookAt));
  };
  if (2 * far.size() <= static_cast<std::size_t>(gauges.count)) {
    for (const Off& off : far)
      text(fmt::format("Gauge {} (at {:.6g} deg)", off.gauge, gauges.angle_deg(off.gauge)), off,
           words.lookAt);
    return;
  }
  const Off& worst = *std::ranges::max_element(far, {}, &Off::tolerances);
  text(fmt::format("{} gauges of {}, gauge {} most", far.size(), gauges.count, worst.gauge), worst,
       words.lookAtIfMost);
}

/// An unknown of gauges that the touches may tell little of, and the touches that tell more: measured, a
/// gain's sigma is less after more or firmer touches, wherever they are and however wide.
struct UntoldWords {
  GaugeUnknown unknown;
  const char* name;
  const char* whatTellsMore;
};
constexpr const char* kTouchesAbout = "Touches over these gauges and beside them determine it better";
constexpr std::array kUntoldWords{
    UntoldWords{kGain, "gain", "More and firmer touches determine it better; gain and depth are correlated"},
    UntoldWords{kAngleOffset, "angle", kTouchesAbout}, UntoldWords{kDepthOffset, "depth", kTouchesAbout}};

void addUntold(const CalibrationResult& result, const UntoldWords& words,
               std::vector<std::string>& sentences) {
  const config::Gauges& gauges = result.drawing().config().gauges;
  const std::vector<int> untold = untoldGauges(result, words.unknown, kUntold);
  if (untold.empty()) return;
  const bool isAll = untold.size() == static_cast<std::size_t>(gauges.count);
  sentences.push_back(fmt::format(
      "The touches hardly determine the {} of {}: its value is mostly the drawing's. {}.", words.name,
      isAll ? "all gauges" : "gauges " + placesOf(gauges, untold), words.whatTellsMore));
}

/// The modulus is off by as much as it would be if loads [N/m] had been given in grams.
bool lookLikeGrams(const CalibrationResult& result) {
  constexpr double kWeightOfAGram_n = 9.81e-3;
  const config::Finger& finger = result.drawing().config().finger;
  const double ratio = result.shearModulus_pa().value / finger.shear_modulus_pa;
  return result.isLoadKnown() && std::abs(ratio * kWeightOfAGram_n / finger.length_m - 1) < 0.2;
}

}  // namespace

bool isDriftedZero(const CalibrationResult& result, const RowResult& row) {
  const double most_strain = kWeakestTouch * result.drawing().config().gauges.noise_strain;
  return row.use == RowUse::kContradicted && !isTouch(row) && row.residual_strain.size() > 0 &&
         row.residual_strain.cwiseAbs().maxCoeff() < most_strain;
}

bool isTouch(const RowResult& row) { return std::abs(row.touch[kNormalLoad]) > kTrace_n_per_m; }

std::vector<std::string> whatIsFarOff(const CalibrationResult& result) {
  std::vector<std::string> sentences;
  if (const std::string noise = noiseText(result); !noise.empty()) sentences.push_back(noise);
  for (const GaugeWords& words : kGaugeWords) addFarOff(result, words, sentences);
  const auto add = [&](RubberUnknown unknown, const char* name, const Estimate& found, double perUnit,
                       const char* unit, const std::string& lookAt, double most = kFarOff) {
    const double tolerances = std::abs(result.deviations()[result.drawing().at(unknown)]);
    if (tolerances > most)
      sentences.push_back(fmt::format("{} {:.4g}{}, {:.1f} tolerances off the drawing: {}.", name,
                                      found.value / perUnit, unit, tolerances, lookAt));
  };
  add(kCoreRadius, "Core radius", result.coreRadius_m(), 1e-3, " mm", "check finger.core_radius_m");
  add(kPoissonRatio, "Poisson's ratio", result.poissonRatio(), 1, "", "check finger.poisson_ratio");
  add(kShearModulus, "Shear modulus", result.shearModulus_pa(), 1e3, " kPa",
      fmt::format("check finger.length_m, the known loads{}, gauges.full_scale_strain and "
                  "finger.shear_modulus_pa",
                  lookLikeGrams(result) ? " (as large as if they were grams)" : ""),
      kFarOffModulus);
  return sentences;
}

std::vector<std::string> whatIsUntold(const CalibrationResult& result) {
  std::vector<std::string> sentences;
  if (!result.hasSettled())
    sentences.emplace_back(
        "The fit was stopped before it had settled: the values may be further off than their sigmas say. "
        "More touches, of other places and loads, let it settle.");
  if (!result.isDirectionKnown())
    sentences.emplace_back(
        "No direction is known of the fitted rows: angles count from where the drawing has the gauges on "
        "average. One touch with a known angle_deg mends that.");
  if (!result.isLoadKnown())
    sentences.emplace_back(
        "No load is known of the fitted rows: forces are right as far as finger.shear_modulus_pa is. Some "
        "touches on a scale, with a known normal_n_per_m, mend that.");
  for (const UntoldWords& words : kUntoldWords) addUntold(result, words, sentences);
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
  const auto noise = noiseFound(result);
  const bool isNoisy = noise && noise->isNoisier();
  for (const RowUseWords& words : kRowUses) {
    const RowUse use = words.use;
    LeftOut left{use, reasonOf(use, result.rows()), {}};
    if (left.reason.empty()) continue;
    bool isDrifted = use == RowUse::kContradicted;
    for (std::size_t row = 0; row < result.rows().size(); ++row)
      if (result.rows()[row].use == use) {
        left.rows.push_back(row + 1);
        isDrifted &= isDriftedZero(result, result.rows()[row]);
      }
    if (isDrifted) left.reason = isNoisy ? kNoisy : kZerosDrifted;
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
