#pragma once
// Rows of readings on their way through a calibration.

#include <Eigen/Core>
#include <limits>
#include <span>
#include <vector>

#include "host/calibration/calibrate.hpp"
#include "host/calibration/touch_fit.hpp"

namespace strainfinger::calibration {

struct Row {
  KnownTouch known;
  TouchData data;
  RowResult result;
  /// The touch that explains the row second best, and by how much chi-squared; infinite: there is none.
  double rivalGap = std::numeric_limits<double>::infinity();
  TouchState rival = TouchState::Zero();
  bool isMoved = false;  ///< of a zero that moved

  bool isDirectionKnown() const { return known.angle_deg.has_value(); }
  bool isLoadKnown() const { return known.normal_n_per_m || known.tangential_n_per_m; }
  bool isKnown() const { return isDirectionKnown() || isLoadKnown(); }
  /// It tells of the finger as a touch does.
  bool isFitted() const { return !isMoved && result.use == RowUse::kFitted; }
  /// It tells of the finger as a touch does, or as an untouched finger.
  bool isUsable() const { return isFitted() || (!isMoved && result.use == RowUse::kUntouched); }
  double peak_strain() const { return data.readings.cwiseAbs().maxCoeff(); }
};

/// Of a touch of which nothing is known but what the config says of all.
TouchPrior priorOfAny(const config::FingerConfig& config);

/// Each with what is known of its touch as a prior, and used or left out as its readings alone say: over
/// range or weak. Domain: as calibrate(), of rows that pair.
std::vector<Row> rowsOf(const config::FingerConfig& config, std::span<const KnownTouch> known,
                        const Eigen::MatrixXd& readings, const KnownErrors& errors);

}  // namespace strainfinger::calibration
