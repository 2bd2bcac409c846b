#pragma once
// One sample set through conditioning, detection and location.

#include <optional>

#include "firmware/core/condition.hpp"
#include "firmware/core/detect.hpp"
#include "firmware/core/gauge_watch.hpp"
#include "firmware/core/locate.hpp"
#include "firmware/core/zero_tracker.hpp"

namespace strainfinger::firmware {

/// What one sample set shows.
struct Observation {
  std::optional<Fit> fit;  ///< nothing when nothing touches the finger
  GaugeSet saturated = 0;  ///< at a rail
  GaugeSet outOfUse = 0;   ///< known not to work
  GaugeSet leftOut = 0;    ///< of this fit: these, and what this sample set speaks against
  bool several = false;    ///< the strains are not those of one contact
  bool staleZero = false;  ///< the finger has not been seen untouched for too long
};

class Pipeline {
 public:
  Pipeline(const TableImage& tables, FitMode mode)
      : tables_(&tables), calibration_(tabledCalibration(tables)), jumps_(tables.constants), mode_(mode) {}

  /// Costs conditioning and the gate when nothing touches; else a fit (see locate()).
  const Observation& process(Codes codes);

  /// What the last sample set showed.
  const Observation& observation() const { return observation_; }

  const TableConstants& constants() const { return tables_->constants; }
  Calibration& calibration() { return calibration_; }
  /// A new zero: what was learnt with the old one is forgotten, gauges out of use have another try.
  void takeZero(const ZeroAverage& zero);
  /// So few gauges work that nothing is said for sure.
  bool tooFewGauges() const { return tooManyOut(watch_.outOfUse(), constants().gauge_count); }
  const ZeroTracker& zeroTracker() const { return tracker_; }
  /// Of the last sample set; gauges that are left out have what the others say they should read, or 0.
  const Readings& readings() const { return readings_; }

 private:
  std::span<std::int32_t> strains() { return std::span(readings_.strain_q32).first(constants().gauge_count); }
  std::uint32_t energyAgain();
  void look();
  void lookWithout(GaugeSet gauges);
  GaugeSet culprits(Codes codes);
  void conclude(GaugeSet accused);
  GaugeSet implausiblySaturated(Codes codes) const;
  void reconsider(Codes codes);
  void convictStuck(Codes codes);

  const TableImage* tables_;
  Calibration calibration_;
  Readings readings_;
  Observation observation_;
  ContactGate gate_;
  GaugeWatch watch_;
  JumpWatch jumps_;
  ZeroTracker tracker_;
  std::uint32_t energy_ = 0;  ///< of the readings as the fit has them
  FitMode mode_;
};

}  // namespace strainfinger::firmware
