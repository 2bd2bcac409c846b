#pragma once
// What can be wrong with touches and readings, in words. Rows are counted from 1, gauges from 0.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::calibration {

/// One touch that would tell a gauge's gain.
struct NeededTouch {
  double offset_deg;  ///< from the gauge, to either side
  double normal_n_per_m;
};

/// As many rows as touches, at least one; a column a gauge; readings within full scale; touches that can be.
void requireRows(const config::Gauges& gauges, std::span<const KnownTouch> touches,
                 const Eigen::MatrixXd& readings);

/// Names the gauges and what to add.
[[noreturn]] void failUndetermined(const config::Gauges& gauges, const std::vector<int>& unknown,
                                   const NeededTouch& needed);

/// Residuals may be many times the noise, as touches by hand leave them, but not most of what was read; names
/// the worst of them.
void requireExplained(const Eigen::MatrixXd& expected, const Eigen::MatrixXd& residuals, double excess);

/// Gains in the domain of calibration.gain.
void requireGains(const CalibrationFit& fit);

}  // namespace strainfinger::calibration
