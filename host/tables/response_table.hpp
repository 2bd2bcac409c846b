#pragma once
// What a gauge reads of unit loads, as quadratic patches over the angle to the contact and the second moment
// of its pressure.

#include <array>
#include <vector>

#include "common/table_image.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::tables {

struct ResponseTable {
  int nodes;
  int cells;
  std::array<std::uint16_t, kMostCells + 1> cell_edge_q15{};  ///< as in TableConstants
  double largestMoment_m2;    ///< second moment of the widest pressure, of which the edges are fractions
  double strainPerUnit;       ///< strain per N/m of a response of 2^15
  int peakSign;               ///< of the largest reading that a pressing load makes
  double interpolationError;  ///< largest error of a patch before rounding, of a response of 2^15
  std::vector<PatchPair> patches;
};

/// Second moment of the widest pressure that a table holds: of that of a known width, or of the largest one.
double largestMoment_m2(const config::FingerConfig& config);

/// Least-squares fits to the elastic model. The pressure is a semi-ellipse with the second moment of a
/// uniform pressure of the contact's width, and so is the shear, up to twice as large in second moment
/// (Mindlin, see model::shearMoment_rad2()). Where contact.width_m is known its pressure has the largest
/// moment, and patches for less than half of that, which no load has, don't count in the error. A response of
/// 2^15 is larger than the largest by `growth`, for gauges that read more than the drawn one. Throws what
/// ImpulseResponse throws. Cost: 1 ms for the default finger, 9 ms for 300 harmonics.
ResponseTable responseTable(const config::FingerConfig& config, double growth = 0);

}  // namespace strainfinger::tables
