#pragma once
// How good a method's answers are.

#include <Eigen/Core>
#include <span>
#include <vector>

#include "common/table_image.hpp"
#include "host/bench/methods/catalogue.hpp"
#include "host/bench/readings.hpp"

namespace strainfinger::bench {

Place<double> placeOf(const TableImage& tables, const Contact& contact);
Place<double> placeOf(const TableImage& tables, const OwnLocator& locator);
Place<double> placeOf(const TableImage& tables, const Place<float>& place);
Place<double> placeOf(const TableImage& tables, const Place<double>& place);

/// Over many readings. An answer more than half a pitch off is gross; the figures of errors are of the
/// others, but for arcOfAll_um. NaN: not told by the method, or not defined without noise.
struct Score {
  int readings = 0;
  int gross = 0;
  Eigen::Vector3d overBound;  ///< RMS of error / Cramer-Rao bound: place, normal, tangential
  double arc_um = 0;          ///< RMS
  double arcWorst_um = 0;
  double arcBound_um = 0;     ///< RMS of the bounds of all readings
  double arcOfAll_um = 0;     ///< RMS, gross errors included; an answer that is no number counts half a ring
  double normal_n_per_m = 0;  ///< RMS
  double tangential_n_per_m = 0;  ///< RMS
};

/// One answer a reading.
Score scoreOf(const BenchFinger& finger, std::span<const Reading> readings,
              std::span<const Place<double>> answers);

}  // namespace strainfinger::bench
