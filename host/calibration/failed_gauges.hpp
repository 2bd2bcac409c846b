#pragma once
// Gauges that read nothing of the finger, whatever touches it. They are told before anything else is blamed:
// beside a column that tells nothing, touches look as if they were missing, and neighbours as if they were
// glued askew.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "host/config/finger_config.hpp"

namespace strainfinger::calibration {

struct FailedGauge {
  enum class Kind {
    kConstant,  ///< reads the same in all rows
    kNoise,     ///< the same but for noise, though gauges to either side read touches
    kAtEnd,     ///< over range in half of the rows or more
  };
  Kind kind;
  int gauge = 0;
  double strain = 0;      ///< what it reads: the mean of the rows that it is told by
  Eigen::Index rows = 0;  ///< that it is told by

  bool operator==(const FailedGauge&) const = default;
};

/// By gauge; empty where fewer than 20 rows tell it, and where no gauge reads anything else. Cost: two looks
/// at each row.
std::vector<FailedGauge> findFailedGauges(const config::Gauges& gauges, const Eigen::MatrixXd& readings);

/// What it is and what to look at.
std::string textOf(const FailedGauge& failed);

}  // namespace strainfinger::calibration
