#pragma once
// The model in 50 digits: what errors are measured against.

#include <Eigen/Core>
#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/eigen.hpp>
#include <span>

#include "host/config/finger_config.hpp"
#include "host/model/harmonic.hpp"
#include "host/model/surface_load.hpp"

namespace strainfinger::bench {

inline constexpr double kGauge_m = config::Gauges{}.radius_m;
inline model::Annulus<double> benchAnnulus() { return config::Finger{}.annulus(); }

using Precise =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;

/// benchAnnulus(), its numbers taken as exact.
model::Annulus<Precise> preciseAnnulus();

/// One row an angle, one column each of model::Row, under a line load at 0; by 400 harmonics, which leave out
/// 1e-52.
Eigen::MatrixXd preciseField(double radius_m, const model::SurfaceLoad& load,
                             std::span<const double> angles_rad);

/// Largest difference over the largest value, of all columns each.
double worstError(const Eigen::MatrixXd& found, const Eigen::MatrixXd& known);

}  // namespace strainfinger::bench
