#pragma once
// What a session has collected.

#include <Eigen/Core>
#include <vector>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::session {

/// A sample set: a strain a gauge, and when it came (any origin).
struct Sample {
  double time_s = 0;
  Eigen::VectorXd strains;
};

/// Rows of strains and what is known of their touches, as calibrate() takes them.
struct Rows {
  std::vector<Eigen::VectorXd> strains;
  std::vector<calibration::KnownTouch> known;

  std::size_t size() const { return strains.size(); }
  void add(const Eigen::VectorXd& row, const calibration::KnownTouch& touch) {
    strains.push_back(row);
    known.push_back(touch);
  }
  Eigen::MatrixXd matrix() const {
    Eigen::MatrixXd readings(static_cast<Eigen::Index>(size()), size() == 0 ? 0 : strains.front().size());
    for (std::size_t i = 0; i < size(); ++i) readings.row(static_cast<Eigen::Index>(i)) = strains[i];
    return readings;
  }
};

}  // namespace strainfinger::session
