#pragma once
// What is worth telling of a calibration, for all who tell it: the text, the tables, the page.

#include <string>
#include <vector>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::calibration {

/// Two unknowns that touches determine only in combination, their correlation beyond 0.9: two of the rubber;
/// one of the rubber and the gauges' gains or depths; or gains and depths of the same gauges. Of gauges it is
/// the mean of their correlations.
struct Correlation {
  std::string one, other;
  double value;
};
std::vector<Correlation> correlationsWorthKnowing(const CalibrationResult& result);

/// What the touches left untold, and which touches would tell it: sentences.
std::vector<std::string> whatIsUntold(const CalibrationResult& result);

/// What is more than four tolerances off the drawing, of the modulus more than two, and noise that is another
/// than the config's, each with what to look at: sentences. Of angles the ring's own turn is left out.
std::vector<std::string> whatIsFarOff(const CalibrationResult& result);

/// Of a row that isn't what is known of it: nothing pressed, and what it reads is too little for a touch.
bool isDriftedZero(const CalibrationResult& result, const RowResult& row);

/// Whether the row's touch is one: the fit leaves a trace of a load where nothing is known to have pressed.
bool isTouch(const RowResult& row);

/// Rows that were left out for one reason, counted from 1.
struct LeftOut {
  RowUse use;
  std::string reason;
  std::vector<std::size_t> rows;
};
std::vector<LeftOut> rowsLeftOut(const CalibrationResult& result);

/// The zeros that moved, each with its rows and its shift, in a sentence; empty where none did.
std::string movedZeroText(const CalibrationResult& result);

/// That the known angles turn the ring, and where the config has that; empty where [gauges] stays as drawn.
std::string turnText(const CalibrationResult& result);

/// RMS of what the fitted finger leaves, and what the drawn one does of the same rows, each with the touches
/// that suit it best. Costs 0.2 ms a row.
struct Residuals {
  struct Of {
    double before_strain = 0, after_strain = 0;
  };
  std::vector<Of> gauges;
  std::vector<Of> rows;  ///< NaN for rows that were left out
};
Residuals residualsOf(const CalibrationResult& result);

}  // namespace strainfinger::calibration
