#pragma once
// A zero that moved while the finger was being touched.

#include <optional>
#include <vector>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::calibration {

/// By what it leaves of the rows of the session's shorter part, of which no touch explains most.
struct MovedZero {
  int gauge;
  std::size_t firstRow, lastRow;  ///< where it was another one; counted from 1
  double strain;                  ///< how much more it read there
};

/// Empty where none moved. Domain: rows in the order of the session, unexplained ones with their residuals.
std::optional<MovedZero> movedZero(const std::vector<RowResult>& rows, const config::Gauges& gauges);

}  // namespace strainfinger::calibration
