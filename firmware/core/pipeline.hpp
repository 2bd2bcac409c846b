#pragma once
// One sample set through conditioning, detection and location.

#include "firmware/core/condition.hpp"
#include "firmware/core/detect.hpp"
#include "firmware/core/gauge_watch.hpp"
#include "firmware/core/locator.hpp"
#include "firmware/core/zero_tracker.hpp"

namespace strainfinger::firmware {

/// What one sample set shows.
struct Observation {
  bool touched = false;
  bool unchanged = false;     ///< the codes are those of the set before, and so is the answer
  bool several = false;       ///< the readings are not those of one contact
  bool staleZero = false;     ///< the finger has not been seen untouched for too long
  bool tooFewGauges = false;  ///< fewer work than an answer needs to be sure
  bool noisy = false;         ///< the untouched ring is noisier than configured
  GaugeSet saturated = 0;     ///< at a rail
  GaugeSet outOfUse = 0;      ///< known not to work, or noisy by themselves
  GaugeSet leftOut = 0;       ///< not used by the answer
};

class Pipeline {
 public:
  Pipeline(const TableImage& tables, FitMode mode)
      : tables_(&tables), calibration_(tabledCalibration(tables)), locator_(mode) {}

  /// Cost: conditioning and the gate if nothing touches, else also an update of the locator.
  const Observation& process(Codes codes);

  /// What the last sample set showed, and the answer if it is touched.
  const Observation& observation() const { return observation_; }
  const Answer& answer() const { return locator_.answer(); }
  const Linearisation& linearisation() const { return locator_.linearisation(); }

  const TableConstants& constants() const { return tables_->constants; }
  Calibration& calibration() { return calibration_; }
  /// The first zero of a pipeline that is new. Gauges whose zero is at a rail are out of use.
  void takeZero(const ZeroAverage& zero);
  /// The strains changed while the zero was taken, as when a touch begins or ends.
  bool isTouchedDuring(const ZeroAverage& zero) const;
  const ZeroTracker& zeroTracker() const { return tracker_; }
  /// Of the last sample set.
  const Readings& readings() const { return readings_; }

 private:
  std::span<const std::int32_t> strains() const { return readings_.strains(constants().gauge_count); }
  GaugeSet outOfUse() const { return watch_.outOfUse() | noise_.noisyGauges(); }
  void locate(GaugeSet gauges);
  void watchGauges();
  bool isKnown(Codes codes) const;
  void observe(Codes codes);
  void noteOutOfUse();
  bool isDisturbance(GaugeSet gauges);

  const TableImage* tables_;
  Calibration calibration_;
  Readings readings_;
  std::array<std::uint16_t, kMaxGauges> codes_{};  ///< the last ones of a touch
  bool areZerosNew_ = false;                       ///< zeros may have changed since then
  Observation observation_;
  ContactGate gate_;
  bool isTouch_ = false;           ///< the readings are those of contacts, not of a disturbance
  bool mayBeDrift_ = false;        ///< the last disturbance
  std::uint8_t contrarySets_ = 0;  ///< sets in a row that contradict isTouch_
  NoiseMeter noise_;
  Locator locator_;
  GaugeWatch watch_;
  ZeroTracker tracker_;
};

}  // namespace strainfinger::firmware
