#pragma once
// Is the finger touched?

#include <cstdint>
#include <span>

#include "common/table_image.hpp"

namespace strainfinger::firmware {

/// Energy of a ring's strains as the gate sees it: sum of (strain >> gate_shift)^2, saturating at 2^32 - 1.
std::uint32_t gateEnergy(const TableConstants& constants, std::span<const std::int32_t> strains_q32);

/// Standard deviation of a reading [strain * 2^32], within 0.1 %.
std::int32_t noiseOf(const TableConstants& constants);

/// A contact begins where noise alone would raise the energy once in 10^9 samples, and ends where it would
/// once in a thousand: the hysteresis keeps a weak touch from flickering.
class ContactGate {
 public:
  bool touched() const { return touched_; }
  bool update(const TableConstants& constants, std::uint32_t energy) {
    touched_ = energy >= (touched_ ? constants.gate_off : constants.gate_on);
    return touched_;
  }

 private:
  bool touched_ = false;
};

}  // namespace strainfinger::firmware
