#pragma once
// The readings of one contact as the locator works with them.

#include <cstdint>
#include <span>

#include "common/table_image.hpp"
#include "firmware/core/window_fit.hpp"

namespace strainfinger::firmware {

/// Which gauges a fit looks at once the neighbours have decided where it starts.
enum class FitMode : std::uint8_t {
  kThreePoint,  ///< three well-conditioned readings, as the paper concludes
  kRefined,     ///< all seven of the window
};

/// Energies here are sums of squares of strains / 2^shift, divided by 4 (see signal.hpp).
struct Problem {
  const TableImage& tables;
  std::span<const std::int32_t> strains;  ///< [* 2^32], one a gauge
  FitMode mode;
  int shift;                ///< brings the ring's norm just below 2^14.5
  std::int32_t ringEnergy;  ///< of all gauges

  /// The tables of the mode, by FitSense.
  FitTables fitTables() const;
  int mirrorSign() const { return tables.constants.mirror_sign; }
  int gauges() const { return tables.constants.gauge_count; }

  /// The most that a contact with so much energy in its window leaves outside.
  std::int32_t tail(std::int32_t window) const {
    return static_cast<std::int32_t>((std::int64_t{window} * tables.constants.tail_q16) >> 16);
  }

  /// So many variances of a reading as an energy; at least 1. Differences of explained energies are
  /// differences of log-likelihood, in units of half a variance.
  std::int32_t noise(std::uint32_t variances) const;
};

/// `energy`: gateEnergy() of the strains.
Problem problemOf(const TableImage& tables, FitMode mode, std::span<const std::int32_t> strains_q32,
                  std::uint32_t energy);

}  // namespace strainfinger::firmware
