#pragma once
// Where a contact is and how hard it presses, from one set of conditioned strains: integers only.

#include <cstdint>
#include <span>

#include "common/quantities.hpp"
#include "common/table_image.hpp"
#include "firmware/core/answer.hpp"

namespace strainfinger::firmware {

/// What locate() found, in its own units; estimate.hpp turns it into quantities and errors.
struct Fit {
  Placement best;
  Placement alternative;   ///< the next best answer; meaningful when ambiguous
  bool ambiguous = false;  ///< another answer explains the readings as well, within noise
  bool settled = false;  ///< the fit converged, presses, stays within the friction cone, and is no mere noise
  std::int32_t normalSlope = 0;  ///< change of the amplitudes per row spacing of offset
  std::int32_t tangentialSlope = 0;
  std::int32_t information = 0;  ///< see FitStep
  std::int8_t informationExponent = 0;
  std::array<std::int16_t, 3> load{};  ///< FitRow::load of the row: the amplitudes' own errors
  std::int8_t shift = 0;               ///< readings were divided by 2^shift
  std::uint8_t centre = 0;             ///< the window's middle gauge
  std::int32_t unexplained = 0;        ///< energy the fit leaves in its window
  std::int32_t expected = 0;           ///< what noise and rounding may leave there
  std::int8_t side = 1;                ///< that offset and slopes count towards
  bool reduced = false;                ///< gauges were left out (left_out.hpp)
  /// Then: covariance of what the readings say along the two loads and the offset (tangent.hpp), in variances
  /// of a reading * 2^12.
  std::array<std::int32_t, 6> covariance_q12{};
};

/// Fits one line contact to the strains of a ring that is touched; one strain a gauge, each within
/// +-2^(15 + gate_shift). `energy`: their gateEnergy().
/// Bounded time: scans one window, five if that one leaves doubts, all for a weak touch; at most six steps
/// for each of four starts.
Fit locate(const TableImage& tables, FitMode mode, std::span<const std::int32_t> strains_q32,
           std::uint32_t energy);

}  // namespace strainfinger::firmware
