#pragma once
// Zeros that follow the gauges' drift, and only that.

#include <array>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>

#include "firmware/core/condition.hpp"
#include "firmware/core/locator.hpp"

namespace strainfinger::firmware {

/// Zeros follow what no contact can explain, by half a standard deviation of a reading an interval at most.
///   - Untouched: the averages of all gauges, unless one contact explains nearly all of them: a touch that
///     grows over minutes looks like that, drift does not.
///   - Touched and explained: what the fit leaves, once the touch has rested for an interval.
/// Whatever the fit takes for the contact is not followed; how old the zeros are is told (stale()).
class ZeroTracker {
 public:
  static constexpr int kInterval = 1024;                ///< sample sets: a second at 1 kHz
  static constexpr int kEvery = 4;                      ///< which of them are averaged: each so many
  static constexpr std::uint32_t kStaleSets = 600'000;  ///< ten minutes

  /// One sample set. `answer`: what explains it; nothing where nothing touches the finger. Gauges in
  /// `leftOut` learn nothing. `scratch` is overwritten at the end of an interval.
  /// True: the zeros may have changed.
  bool take(const TableImage& tables, std::span<const std::int32_t> strains_q32, const Answer* answer,
            const Linearisation& fit, GaugeSet leftOut, Calibration& calibration, Linearisation& scratch);

  /// Forgets everything: the zeros are new.
  void restart() { *this = {}; }

  /// Sample sets since all zeros were last seen untouched; saturating.
  std::uint32_t age_sets() const { return age_sets_; }
  bool stale() const { return age_sets_ > kStaleSets; }
  /// The most that a zero followed in the last interval that taught anything [strain * 2^32]; nothing before
  /// there was one.
  std::optional<std::int32_t> lastChange_q32() const { return lastChange_q32_; }

 private:
  void begin(bool touched);
  void finish(const TableImage& tables, GaugeSet leftOut, Calibration& calibration, Linearisation& scratch);
  bool looksLikeAContact(const TableImage& tables, GaugeSet gauges, Linearisation& scratch) const;

  std::array<std::int32_t, kMaxGauges> sum_{};  ///< of strain * 2^32 * kEvery / kInterval
  std::uint32_t age_sets_ = 0;
  std::optional<std::int32_t> lastChange_q32_;
  std::uint16_t sets_ = 0;
  GaugeSet leftOut_ = 0;  ///< in any set of the interval
  bool touched_ = false;
};

}  // namespace strainfinger::firmware
