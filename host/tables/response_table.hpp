#pragma once
// The responses of a gauge to unit loads, as patches over angle and width.

#include <array>
#include <vector>

#include "common/table_image.hpp"
#include "host/config/finger_config.hpp"

namespace strainfinger::tables {

struct ResponseTable {
  int nodes;
  int cells;
  std::array<std::uint16_t, kMostCells + 1> cell_edge_q15{};
  std::array<std::uint16_t, kMostCells> cell_rate_q8{};
  double strainPerUnit;     ///< strain per N/m of response 2^15
  double largestMoment_m2;  ///< second moment of the widest pressure
  int peakSign;             ///< of what a pressing load makes the gauge under it read
  std::vector<PatchPair> patches;
};

/// Least-squares fits to the elastic model at Chebyshev points of each patch. The pressure is a semi-ellipse,
/// so is the tangential traction, up to twice as large in second moment (Mindlin). Throws what
/// ImpulseResponse throws.
ResponseTable responseTable(const config::FingerConfig& config);

}  // namespace strainfinger::tables
