#pragma once
// A calibration as one page for a browser, with pictures; nothing in it comes from elsewhere.

#include <string>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::calibration {

/// Where a calibration comes from, besides the config.
struct ResultSource {
  std::string strainsPath;  ///< the rows' file; empty: stdin
  std::string touchesPath;  ///< what is known of them; empty: nothing
  std::string time;         ///< when it was made, as people read it
};

/// HTML that is XML as well. Every number is a <data> element whose value has all its digits, in the units of
/// the tables that `calibrate` prints, and whose class is the table's column. Throws Failure(kFailure)
/// without gnuplot. Costs 1 s.
std::string htmlPage(const CalibrationResult& result, const ResultSource& source);

}  // namespace strainfinger::calibration
