#pragma once
// Tables of cos n angle and sin n angle.

#include <Eigen/Core>

#include "host/model/series.hpp"

namespace strainfinger::contact {

/// One row an angle, columns n = 0 .. harmonics - 1.
struct Multiples {
  Eigen::MatrixXd cosines, sines;

  Multiples(const Eigen::VectorXd& angles_rad, Eigen::Index harmonics)
      : cosines(angles_rad.size(), harmonics), sines(angles_rad.size(), harmonics) {
    for (Eigen::Index i = 0; i < angles_rad.size(); ++i)
      model::visitMultiples(angles_rad[i], static_cast<int>(harmonics) - 1, [&](int n, double c, double s) {
        cosines(i, n) = c;
        sines(i, n) = s;
      });
  }
};

}  // namespace strainfinger::contact
