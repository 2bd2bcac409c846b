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

/// Zeros follow what no contact can explain, by at most a standard deviation of a reading an interval.
///   - Untouched: the averages of all gauges, if they are large enough, unless one contact explains nearly
///     all of them: a touch that grows over minutes looks like a contact, drift does not. The fit
///     begins at the best point of a coarse grid and, if it finds no contact, once more elsewhere, because at
///     some places the first guess leads to another answer.
///   - Touched: while the contacts rest, what the residuals of the gauges out of their reach change by in
///     common, as by warmth. A gauge's own drift is not told from the touch.
/// How old the zeros are is told by stale().
class ZeroTracker {
 public:
  static constexpr int kInterval = 512;  ///< sample sets: half a second at 1 kHz
  static constexpr int kEvery = 4;       ///< one in this many is averaged
  /// Sample sets after which zeros have followed, if there was time: two initial guesses, each with its fit.
  static constexpr int kUntilFollowed = kInterval + 3 * kEvery;
  static constexpr std::uint32_t kStaleSets = 600'000;  ///< ten minutes

  /// Once a sample set, before take().
  void age() {
    if (age_sets_ != std::numeric_limits<std::uint32_t>::max()) ++age_sets_;
  }

  /// Takes one sample set, but none that may be a touch which has not been reported yet. `locator`: null if
  /// nothing touches the finger; else the set counts only if the locator's answer explains it. Averages of
  /// gauges in `leftOut` are not used; the zeros of these gauges follow only the drift that the others have
  /// in common. `scratch` is overwritten at the end of an untouched interval and in the sets up to
  /// kUntilFollowed. Returns true if zeros may have changed. Cost: a sum over the gauges in one of kEvery
  /// sets; after an untouched interval also a coarse grid or a fit of at most kMostSteps steps in one of
  /// kEvery sets. These wait for sets with `isTimeLeft`: others are needed for a look at a disturbance, or
  /// back at a touch. Counted in firmware/cost.md.
  bool take(const TableImage& tables, std::span<const std::int32_t> strains_q32, const Locator* locator,
            GaugeSet leftOut, Calibration& calibration, Linearisation& scratch, bool isTimeLeft = true) {
    const bool touched = locator != nullptr;
    if (touched != touched_) interrupt(touched);
    if (touched && !isExplained(locator->answer())) return false;
    leftOut_ |= leftOut;
    if (sets_ + 1 >= kInterval && !isTimeLeft) return false;
    return ++sets_ % kEvery == 0 && average(tables, strains_q32, locator, calibration, scratch);
  }

  /// Forgets the sets of the interval that has begun: a gauge has been at a rail in them.
  void beginAnew() { begin(touched_); }

  /// Sample sets since all zeros were last seen untouched; saturating.
  std::uint32_t age_sets() const { return age_sets_; }
  bool stale() const { return age_sets_ > kStaleSets; }
  /// When take() has returned true: the gauges that read nothing in the interval that has ended, whether or
  /// not they were left out; none if it was touched, or looked so.
  GaugeSet calm() const { return calm_; }
  /// The largest change of a zero in the last interval in which zeros followed [strain * 2^32]; none before
  /// the first one.
  std::optional<std::int32_t> lastChange_q32() const { return lastChange_q32_; }

 private:
  static constexpr int kMostSteps = 6;
  static constexpr int kMostStarts = 2;
  using Strains = std::array<std::int32_t, kMaxGauges>;  ///< [strain * 2^32]

  /// Contacts as they were when they came to rest.
  struct Rest {
    std::uint8_t contacts = 0;  ///< 0: they don't rest
    std::int8_t shift = 0;
    ContactStates contact{};
  };

  static bool isExplained(const Answer& answer) { return answer.accepted && !answer.searching; }
  void begin(bool touched);
  void interrupt(bool touched);
  bool average(const TableImage& tables, std::span<const std::int32_t> strains_q32, const Locator* locator,
               Calibration& calibration, Linearisation& scratch);
  void add(std::span<const std::int32_t> strains_q32, const Locator* locator);
  bool rests(const TableConstants& constants, const Answer& answer) const;
  bool finish(const TableImage& tables, bool touched, Calibration& calibration, Linearisation& scratch);
  GaugeSet farGauges(const TableImage& tables) const;
  std::int32_t commonChange_q32(GaugeSet far);
  GaugeSet calmGauges(const TableConstants& constants) const;
  bool isWorthFollowing(const TableConstants& constants, GaugeSet gauges) const;
  ScaledReadings averages(const TableConstants& constants, GaugeSet gauges) const;
  void findStart(const TableImage& tables, GaugeSet gauges, Linearisation& scratch);
  bool looksLikeAContact(const TableImage& tables, GaugeSet gauges, Linearisation& scratch) const;
  void follow(const TableConstants& constants, const Strains& changes_q32, GaugeSet gauges,
              Calibration& calibration);

  Strains sum_{};       ///< of strains, or while touched of residuals, * kEvery / kInterval
  Strains before_{};    ///< residuals of far gauges in the first interval of a rest
  GaugeSet known_ = 0;  ///< the gauges of before_
  Rest rest_;
  std::uint32_t age_sets_ = 0;
  std::optional<std::int32_t> lastChange_q32_;
  ContactState start_;       ///< initial guess of the last fit of these averages, or of the next
  std::uint8_t starts_ = 0;  ///< initial guesses for these averages
  bool isFitNext_ = false;   ///< next is a fit from start_
  std::uint16_t sets_ = 0;
  GaugeSet leftOut_ = 0;  ///< in any set of the interval
  GaugeSet calm_ = 0;
  bool touched_ = false;
};

}  // namespace strainfinger::firmware
