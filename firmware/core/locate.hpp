#pragma once
// Where a contact is and how hard it presses, from one set of conditioned strains: integers only.

#include <array>
#include <cstdint>
#include <limits>
#include <span>

#include "common/quantities.hpp"
#include "common/table_image.hpp"
#include "firmware/core/answer.hpp"

namespace strainfinger::firmware {

/// Nowhere else is a contact that noise could take for the best.
inline constexpr std::int32_t kNoRival = std::numeric_limits<std::int32_t>::max();

/// What locate() found, in its own units; estimate.hpp turns it into quantities and errors.
struct Fit {
  Placement best;
  Placement alternative;      ///< the next best answer, or as far as a valley may lead; of use with a ..
  std::int32_t deficit;       ///< .. energy that it explains less, or counts for less, or kNoRival
  const FitRow* row;          ///< that the answer was found from ..
  Projections projection;     ///< .. with these: what the answer's errors depend on
  std::int32_t information;   ///< see FitStep
  std::int32_t unexplained;   ///< energy the fit leaves in its window ..
  std::int32_t windowEnergy;  ///< .. of so much
  std::int8_t up;             ///< readings were divided by 2^(16 - up)
  std::uint8_t centre;        ///< the window's middle gauge
  std::uint8_t anchor;        ///< where the readings said that it should be
  FitMode readings;           ///< that the answer rests on: seven, or three ..
  std::uint8_t triple;        ///< .. of this number in kTripleList
  bool reduced;               ///< gauges were left out (left_out.hpp)
  bool ambiguous;             ///< another answer explains the readings as well, within noise
  bool settled;  ///< the fit converged, presses, stays within the friction cone, and is no mere noise
  /// If reduced: covariance of what the readings say along the two loads and the offset (tangent.hpp), in
  /// variances of a reading * 2^12.
  std::array<std::int32_t, 6> covariance_q12;

  /// From the window's middle gauge.
  PitchQ20 offset(int gauges) const {
    const PitchQ20 ring = gauges * kOnePitch, apart = best.position - centre * kOnePitch;
    if (apart > ring / 2) return apart - ring;
    return apart < -ring / 2 ? apart + ring : apart;
  }
};

/// Fits one line contact to the strains of a ring that is touched; one strain a gauge, each within
/// +-2^(15 + gate_shift). `energy`: their gateEnergy().
/// Bounded time: one fit from a start that is told for most firm contacts, a part of a window scanned and one
/// fit for others, up to six windows and nine fits for those in doubt, every window and six fits for a touch
/// so weak that noise could win in a wrong one.
void locateBySeven(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32, std::uint32_t energy);

/// By the three readings around the deepest one where they tell (near_fit.hpp). Else the same, the answer
/// left to the row's three best conditioned readings if they lead where all seven do.
void locateByThree(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32, std::uint32_t energy);

inline Fit locate(const TableImage& tables, FitMode mode, std::span<const std::int32_t> strains_q32,
                  std::uint32_t energy) {
  Fit fit;
  mode == FitMode::kRefined ? locateBySeven(fit, tables, strains_q32.data(), energy)
                            : locateByThree(fit, tables, strains_q32.data(), energy);
  return fit;
}

}  // namespace strainfinger::firmware
