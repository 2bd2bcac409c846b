#pragma once
// The firmware, run against simulated gauges.

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <utility>
#include <vector>

#include "common/frames.hpp"
#include "common/table_image.hpp"
#include "firmware/app/announce.hpp"
#include "firmware/app/finger.hpp"
#include "firmware/app/whole_tables.hpp"
#include "firmware/app/without_tables.hpp"
#include "host/can/tapped_port.hpp"
#include "host/can/touch_receiver.hpp"
#include "host/config/bus_load.hpp"
#include "host/config/finger_config.hpp"
#include "host/simulation/simulated_clock.hpp"
#include "host/simulation/simulated_gauges.hpp"
#include "host/system/memory_store.hpp"
#include "host/system/no_watchdog.hpp"

namespace strainfinger::simulation {

/// The firmware takes the first sample sets for its zero; with this much time untouched there are enough of
/// them even when a machine is late.
inline constexpr double kUntouched_s = 0.1;
static_assert(firmware::ZeroAverage::kSamples * SimulatedGauges::kSamplePeriod_us * 1e-6 < kUntouched_s);

/// Throws Failure(kUsage) when the scenario touches the finger before kUntouched_s: every answer would be
/// wrong. `name`: what to call the scenario.
void requireUntouchedStart(const Scenario& scenario, std::string_view name = "the scenario");

/// What a finger on this machine says of itself at start: the program's version and no board.
InfoFrame simulatedInfo(ResetCause cause);

/// What the finger reported, and what was true when its gauges were read.
struct ComparedTouch {
  double time_s = 0;
  std::vector<Touch> truth;
  can::TouchReport report;
};

/// One sample set gone through the firmware.
struct Moment {
  double time_s = 0;
  std::vector<Touch> truth;
  std::optional<ComparedTouch> compared;  ///< a report that was complete on the bus with this set
  bool isZeroing = false;                 ///< the set went into the zero: there are no readings of it
};

inline firmware::FingerCounters operator+(const firmware::FingerCounters& a,
                                          const firmware::FingerCounters& b) {
  return {a.sampleSets + b.sampleSets, a.fits + b.fits, a.touchesSent + b.touchesSent,
          a.touchesBusy + b.touchesBusy, a.touchesIncomplete + b.touchesIncomplete};
}

struct RunCounts {
  firmware::FingerCounters finger;  ///< of all its starts
  std::uint32_t overruns = 0;       ///< sample sets lost because the machine was late
  std::uint64_t frames = 0;         ///< all that went to the bus
  std::uint64_t heartbeats = 0;     ///< of these
  firmware::GaugeSet outOfUse = 0;
};

/// A finger on `port`, which must outlive it like `tables`. Its gauges' zeros are off by `kZeroSpread` of
/// full scale, so that they need the zero which the firmware takes; their gains are the
/// config's, and reports of a finger that is not as drawn are flagged uncalibrated when `tables` don't have
/// them. Tables that it is sent take the place of `tables` from its next start on.
template <hal::CanPort Port>
class SimulatedFinger {
 public:
  static constexpr double kZeroSpread = 0.01;
  static constexpr std::size_t kTablePages = 12;  ///< as many as the board has

  /// Throws Failure(kUsage) where SimulatedGauges and requireUntouchedStart() do.
  SimulatedFinger(const config::FingerConfig& config, Scenario scenario, const TableImage& tables,
                  firmware::FitMode mode, std::uint64_t seed, Port& port, std::vector<GaugeFault> faults = {})
      : gauges_(config, checked(std::move(scenario)), clock_,
                {.seed = seed,
                 .zeroSpread_strain = kZeroSpread * config.gauges.full_scale_strain,
                 .faults = std::move(faults)}),
        port_(port),
        tables_(tables),
        settings_(settingsOf(config, mode)),
        receiver_(settings_.node) {
    start(&tables_, ResetCause::kPowerOn);
  }
  SimulatedFinger(const SimulatedFinger&) = delete;
  SimulatedFinger& operator=(const SimulatedFinger&) = delete;

  /// Lets so many sample periods pass and the firmware work until nothing is left to do; visit(const Moment&)
  /// after each sample set. Of more than two periods the gauges keep the newest two sets.
  template <typename Visit>
  void pass(std::uint64_t periods, Visit visit) {
    clock_.advance_us(periods * SimulatedGauges::kSamplePeriod_us);
    for (bool sampled = true; sampled;) {
      const bool isZeroing = !finger_ || finger_->state() != FingerState::kRun;
      sampled = step();
      info_->step(port_, clock_.now_us());
      Moment moment{gauges_.sampleTime_s(), gauges_.truth(), std::nullopt, isZeroing};
      listen(moment);
      if (sampled) visit(std::as_const(moment));
    }
  }

  double elapsed_s() const { return static_cast<double>(clock_.elapsed_us()) * 1e-6; }
  std::uint64_t elapsed_us() const { return clock_.elapsed_us(); }
  RunCounts counts() const {
    if (!finger_) return {counted_, gauges_.overruns(), frames_, heartbeats_, 0};
    return {counted_ + finger_->counters(), gauges_.overruns(), frames_, heartbeats_,
            finger_->lastObservation().outOfUse};
  }
  const GaugeStrains& strains() const { return gauges_.strains(); }
  /// The last sample set as the firmware's stages see it.
  const firmware::Readings& readings() const { return finger_ ? finger_->readings() : noReadings_; }

 private:
  static Scenario checked(Scenario scenario) {
    requireUntouchedStart(scenario);
    return scenario;
  }

  static firmware::FingerSettings settingsOf(const config::FingerConfig& config, firmware::FitMode mode) {
    const bool isAsDrawn = config.calibration.isEmpty() && config.as_built.isAsDrawn();
    return {.node = static_cast<std::uint8_t>(config.can.node),
            .contactRate_hz = config::contactRate_hz(config.can),
            .samplePeriod_us = SimulatedGauges::kSamplePeriod_us,
            .bitrate = static_cast<std::uint32_t>(config.can.bitrate),
            .mode = mode,
            .standingFlags = isAsDrawn ? FingerFlags{FingerFlag::kSimulated}
                                       : FingerFlags{FingerFlag::kSimulated, FingerFlag::kUncalibrated},
            .takesTables = true};
  }

  /// nullptr: without tables.
  void start(const TableImage* tables, ResetCause cause) {
    info_.emplace(simulatedInfo(cause), settings_.node, clock_.now_us());
    waiting_.reset();
    endFinger();
    watchdog_ = system::NoWatchdog(cause);
    if (tables != nullptr) finger_.emplace(*tables, settings_, gauges_, port_, clock_, watchdog_);
    if (tables == nullptr) waitForTables({settings_.node, false, firmware::EraseBudget::after(cause), 0});
  }

  void endFinger() {
    if (finger_) counted_ = counted_ + finger_->counters();
    finger_.reset();
  }

  void waitForTables(const firmware::NoTables& from) {
    endFinger();
    waiting_.emplace(from, port_, tableStore_, clock_.now_us());
  }

  /// As runFinger() does. True: there was a sample set.
  bool step() {
    const bool sampled = finger_ ? finger_->step() : gauges_.read(unused_);
    if (waiting_) waiting_->step(clock_.now_us());
    if (finger_ && finger_->leaving() == firmware::Leaving::kLoads)
      waitForTables({settings_.node, true, finger_->eraseBudget(), finger_->uptime_s()});
    if (finger_ ? finger_->leaving() == firmware::Leaving::kRestarts : waiting_->isLeaving()) restart();
    return sampled;
  }

  void restart() {
    static_cast<void>(tableStore_.read(0, std::as_writable_bytes(std::span(sent_.get(), 1))));
    start(firmware::ifWhole(firmware::tablesOf(*sent_, tables_), tables_.constants.gauge_count),
          ResetCause::kSoftware);
  }

  /// As a receiver on the bus would. A touch is compared with the truth of the set that its CONTACT is of,
  /// whenever its last frame follows.
  void listen(Moment& moment) {
    for (const CanFrame& frame : port_.fetchSent()) {
      ++frames_;
      if (decode<HeartbeatFrame>(frame)) ++heartbeats_;
      if (decode<ContactFrame>(frame)) reported_ = {moment.time_s, moment.truth, {}};
      const auto report = receiver_.take(frame);
      if (!report) continue;
      moment.compared = reported_;
      moment.compared->report = *report;
    }
  }

  SimulatedClock clock_;
  SimulatedGauges gauges_;
  can::TappedPort<Port> port_;
  system::NoWatchdog watchdog_;
  const TableImage& tables_;
  firmware::FingerSettings settings_;
  can::TouchReceiver receiver_;
  system::MemoryStore tableStore_{kTablePages};
  std::unique_ptr<TableImage> sent_ = std::make_unique<TableImage>();  ///< on the heap, for its size
  std::optional<firmware::Finger<SimulatedGauges, can::TappedPort<Port>, SimulatedClock, system::NoWatchdog>>
      finger_;
  std::optional<firmware::WithoutTables<can::TappedPort<Port>, system::MemoryStore>>
      waiting_;  ///< or this one
  hal::SampleSet unused_{};
  firmware::Readings noReadings_;
  std::optional<firmware::Announcement<InfoFrame>> info_;
  ComparedTouch reported_;
  firmware::FingerCounters counted_;  ///< of the starts before
  std::uint64_t frames_ = 0;
  std::uint64_t heartbeats_ = 0;
};

}  // namespace strainfinger::simulation
