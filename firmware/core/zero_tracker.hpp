#pragma once
// Zeros that follow the gauges' drift, and only that.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "firmware/core/condition.hpp"
#include "firmware/core/left_out.hpp"

namespace strainfinger::firmware {

/// A contact can change the readings of its window in three ways (tangent.hpp): more or less of each load,
/// and moving. Drift mostly changes them otherwise: all gauges alike, or each as it likes. So while nothing
/// touches, zeros follow the averages of all gauges, by a standard deviation of a reading an interval at
/// most: a touch that grows slowly is faster. While something does, they follow what has changed since the
/// touch came to rest
///   - outside its window;
///   - in it, at right angles to the three ways;
///   - along the three ways, as much as a drift that all gauges share has there: all alike, or one side more
///     than the other, which is what heat does. The other changes tell how much that is.
/// Energy that would not have begun a touch holds none: or else what drift leaves behind could be taken for
/// one for ever. If the touch itself has changed, by more than a 64th, nothing is learnt, and it starts
/// again. What a held touch presses, and its slow changes, can therefore never become zero. Cost: sixteen
/// additions every sixteenth sample set; a fit every kInterval sets.
class ZeroTracker {
 public:
  static constexpr int kEvery = 16;
  static constexpr int kInterval = 4096;  ///< sample sets averaged: four seconds at a thousand a second
  static constexpr int kConvinced = 32;   ///< sets in a row that begin or end a touch: noise doesn't
  static constexpr std::uint32_t kStaleSets = 600'000;  ///< ten minutes

  /// One sample set, as conditioned and fitted with this calibration, and its gateEnergy(); gauges in
  /// `leftOut` learn nothing.
  void take(const TableImage& tables, std::span<const std::int32_t> strains_q32, std::uint32_t energy,
            const std::optional<Fit>& fit, GaugeSet leftOut, Calibration& calibration) {
    if (age_sets_ != std::numeric_limits<std::uint32_t>::max()) ++age_sets_;
    const bool touched = fit.has_value() && energy >= tables.constants.gate_on;
    if (touched != touched_) return doubt(touched);
    doubts_ = 0;
    leftOut_ |= leftOut;
    if (sets_ % kEvery == 0) add(strains_q32);
    if (++sets_ >= kInterval) finish(tables, fit, calibration);
  }

  /// Forgets everything: the zeros are new.
  void restart() {
    begin(false);
    resting_ = false;
    age_sets_ = 0;
    lastChange_q32_.reset();
  }

  /// Sample sets since all zeros were last seen untouched; saturating.
  std::uint32_t age_sets() const { return age_sets_; }
  bool stale() const { return age_sets_ > kStaleSets; }
  /// The most that a zero followed in the last interval that taught anything [strain * 2^32]; nothing before
  /// there was one.
  std::optional<std::int32_t> lastChange_q32() const { return lastChange_q32_; }

 private:
  using Averages = std::array<std::int32_t, kMaxGauges>;

  void begin(bool touched);
  void doubt(bool touched);
  void add(std::span<const std::int32_t> strains_q32);
  void finish(const TableImage& tables, const std::optional<Fit>& fit, Calibration& calibration);
  void followUntouched(const TableConstants& constants, GaugeSet leftOut, Calibration& calibration);
  void followTouched(const TableImage& tables, PitchQ20 position, GaugeSet leftOut, Calibration& calibration);
  void move(std::size_t gauge, std::int32_t by_q32, Calibration& calibration);

  Averages sum_{};
  Averages rest_{};  ///< averages when the touch had come to rest
  std::uint32_t age_sets_ = 0;
  std::optional<std::int32_t> lastChange_q32_;
  std::uint16_t sets_ = 0;
  std::uint16_t doubts_ = 0;  ///< sets in a row that say otherwise than touched_
  GaugeSet leftOut_ = 0;      ///< in any set of the interval
  GaugeSet restLeftOut_ = 0;  ///< .. of the one that rest_ is of
  bool touched_ = false;
  bool resting_ = false;  ///< rest_ holds
};

}  // namespace strainfinger::firmware
