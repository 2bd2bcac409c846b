#include "host/calibration/findings.hpp"

#include <cmath>
#include <string>
#include <vector>

#include "host/calibration/report.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::calibration;

TEST_GROUP(Findings) {
  strainfinger::config::FingerConfig config;
  const Drawing drawing{config, ZeroOfAngle::kKnown};
  const bool isLoadKnown = true;
  Eigen::VectorXd deviations = Eigen::VectorXd::Zero(drawing.unknowns());
  Eigen::MatrixXd covariance = 1e-4 * Eigen::MatrixXd::Identity(drawing.unknowns(), drawing.unknowns());
  std::vector<RowResult> rows;

  CalibrationResult result() const { return {drawing, deviations, covariance, rows, {0, 0}, isLoadKnown}; }
  /// A row whose only residual is that of gauge 3.
  RowResult row(RowUse use, double strain) const {
    RowResult result{use, {1, 20, 5, 1e-3}, 0, Eigen::VectorXd::Zero(drawing.gauges())};
    result.residual_strain[3] = strain;
    return result;
  }
};

TEST(Findings, ThatAFitWasStoppedIsSaid) {
  const std::string stopped = "The fit was stopped before it had settled";
  CHECK_TRUE(textReport(result()).find(stopped) == std::string::npos);
  const CalibrationResult early{drawing, deviations, covariance, rows, {0, 0}, isLoadKnown, {}, false};
  STRCMP_CONTAINS(stopped.c_str(), textReport(early).c_str());
  STRCMP_CONTAINS(stopped.c_str(), whatIsUntold(early).front().c_str());
}

TEST(Findings, OnlyStrongCorrelationsAreWorthKnowing) {
  LONGS_EQUAL(0, correlationsWorthKnowing(result()).size());
  const Eigen::Index core = drawing.at(kCoreRadius), poisson = drawing.at(kPoissonRatio);
  covariance(core, poisson) = covariance(poisson, core) = -0.95e-4;
  const auto found = correlationsWorthKnowing(result());
  LONGS_EQUAL(1, found.size());
  STRCMP_EQUAL("core radius", found.front().one.c_str());
  STRCMP_EQUAL("Poisson's ratio", found.front().other.c_str());
  DOUBLES_EQUAL(-0.95, found.front().value, 1e-12);
}

TEST(Findings, AGaugeThatIsUntoldIsNamedWithTheTouchesThatTell) {
  LONGS_EQUAL(0, whatIsUntold(result()).size());
  const Eigen::Index depth = Drawing::at(7, kDepthOffset);
  covariance(depth, depth) = 0.8;
  const auto sentences = whatIsUntold(result());
  LONGS_EQUAL(1, sentences.size());
  STRCMP_CONTAINS("hardly determine the depth of gauges 7 (at 157.5 deg): ", sentences.front().c_str());
  STRCMP_CONTAINS("Touches over these gauges", sentences.front().c_str());
}

TEST(Findings, WhatIsUntoldOfGaugesIsNamedUnknownByUnknown) {
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge)
    covariance(Drawing::at(gauge, kGain), Drawing::at(gauge, kGain)) = 0.33;  // 0.57 of its tolerance
  for (const int gauge : {2, 9})  // of one alone it would be the turn of the ring, which is given
    covariance(Drawing::at(gauge, kAngleOffset), Drawing::at(gauge, kAngleOffset)) = 0.8;
  const auto sentences = whatIsUntold(result());
  LONGS_EQUAL(2, sentences.size());
  STRCMP_CONTAINS("hardly determine the gain of all gauges: ", sentences[0].c_str());
  STRCMP_CONTAINS("More and firmer touches determine it better", sentences[0].c_str());
  STRCMP_CONTAINS("hardly determine the angle of gauges 2 (at 45 deg), 9 (at 202.5 deg): ",
                  sentences[1].c_str());
}

TEST(Findings, WhatIsFarOffTheDrawingIsToldWithWhatToLookAt) {
  LONGS_EQUAL(0, whatIsFarOff(result()).size());
  deviations[Drawing::at(6, kGain)] = -10;
  deviations[Drawing::at(2, kDepthOffset)] = 3.9;
  deviations[drawing.at(kShearModulus)] =
      -std::log(2) / config.tolerance.shear_modulus;  // known loads half of what they are
  const auto sentences = whatIsFarOff(result());
  LONGS_EQUAL(2, sentences.size());
  STRCMP_EQUAL(
      "Gauge 6 (at 135 deg): gain 0.7, 10.0 tolerances off the drawing: look at its joint and wires.",
      sentences[0].c_str());
  STRCMP_CONTAINS("kPa, 3.5 tolerances off the drawing: check finger.length_m, the known loads",
                  sentences[1].c_str());
  STRCMP_CONTAINS(sentences[0].c_str(), textReport(result()).c_str());
}

TEST(Findings, LoadsThatLookLikeGramsAreSaidToDo) {
  const double grams = drawing.config().finger.length_m / 9.81e-3;
  deviations[drawing.at(kShearModulus)] = std::log(grams) / config.tolerance.shear_modulus;
  STRCMP_CONTAINS("the known loads (as large as if they were grams)", whatIsFarOff(result()).at(0).c_str());
}

TEST(Findings, WhatIsFarOffAtMostGaugesIsTheDrawings) {
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge) deviations[Drawing::at(gauge, kDepthOffset)] = 6;
  const auto sentences = whatIsFarOff(result());
  LONGS_EQUAL(1, sentences.size());
  STRCMP_CONTAINS(
      "16 gauges of 16, gauge 0 most: too deep by 300 um, 6.0 tolerances off the drawing: check "
      "gauges.radius_m.",
      sentences[0].c_str());
}

TEST(Findings, WhichWayAGaugeIsOffIsSaidInWords) {
  deviations[Drawing::at(6, kDepthOffset)] = -6;
  deviations[Drawing::at(7, kAngleOffset)] = -8;
  const auto sentences = whatIsFarOff(result());
  LONGS_EQUAL(2, sentences.size());
  // the ring as a whole is turned by a sixteenth of that
  STRCMP_CONTAINS("Gauge 7 (at 157.5 deg): angle off by -3.75 deg from where the ring as a whole lies",
                  sentences[0].c_str());
  STRCMP_CONTAINS("Gauge 6 (at 135 deg): too shallow by 300 um, 6.0 tolerances", sentences[1].c_str());
}

TEST(Findings, ATurnOfTheWholeRingIsNotFarOff) {
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge) deviations[Drawing::at(gauge, kAngleOffset)] = 9;
  LONGS_EQUAL(0, whatIsFarOff(result()).size());
}

// 16 gauges, one of which is off by 40 microstrain: 10 RMS.
TEST(Findings, ResidualsAreThoseOfRowsThatWereFitted) {
  rows = {row(RowUse::kFitted, 40e-6), row(RowUse::kWeak, 1), row(RowUse::kFitted, -40e-6)};
  const Residuals residuals = residualsOf(result());
  DOUBLES_EQUAL(10e-6, residuals.rows[0].after_strain, 1e-12);
  CHECK_TRUE(std::isnan(residuals.rows[1].after_strain));
  DOUBLES_EQUAL(40e-6, residuals.gauges[3].after_strain, 1e-12);
  DOUBLES_EQUAL(0, residuals.gauges[4].after_strain, 1e-12);
  // as drawn is as found here, and touches that suit are fitted anew
  CHECK_COMPARE(residuals.rows[0].before_strain, <, 10.1e-6);
}

TEST(Findings, RowsThatWereLeftOutAreListedByReason) {
  rows = {row(RowUse::kFitted, 0), row(RowUse::kWide, 0), row(RowUse::kOverRange, 0), row(RowUse::kWide, 0)};
  const auto left = rowsLeftOut(result());
  LONGS_EQUAL(2, left.size());
  CHECK_TRUE(left.front().rows == (std::vector<std::size_t>{2, 4}));
  STRCMP_CONTAINS("slip", left.front().reason.c_str());
}

TEST(Findings, WeakRowsAreSaidToTellLittleBesideStrongOnes) {
  rows = {row(RowUse::kFitted, 0), row(RowUse::kWeak, 0)};
  STRCMP_CONTAINS("less than a sixtieth of what strong ones tell",
                  rowsLeftOut(result()).front().reason.c_str());
}

TEST(Findings, UntouchedRowsOfOtherZerosAreToldForTheDrift) {
  RowResult drifted = row(RowUse::kContradicted, 1e-4);
  drifted.touch = {0, 1e-9, 0, 0};
  rows = {row(RowUse::kFitted, 0), drifted, drifted};
  STRCMP_CONTAINS("the zeros drifted; tare", rowsLeftOut(result()).front().reason.c_str());
  rows.push_back(row(RowUse::kContradicted, 0));
  STRCMP_CONTAINS("look at their angles and loads", rowsLeftOut(result()).front().reason.c_str());
}

TEST(Findings, ZerosThatMovedAreToldWithRowsAndShifts) {
  STRCMP_EQUAL("", movedZeroText(result()).c_str());
  const CalibrationResult moved(drawing, deviations, covariance, rows, {0, 0}, isLoadKnown,
                                {{3, 1, 10, -1e-4}, {5, 301, 456, 8e-5}});
  STRCMP_CONTAINS(
      "Zeros moved during the session: gauge 3 reads 100 microstrain less in rows 1 to 10; gauge 5 reads 80 "
      "microstrain more in rows 301 to 456 than in the others.",
      movedZeroText(moved).c_str());
}
