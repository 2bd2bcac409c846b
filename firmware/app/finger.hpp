#pragma once
// The finger: the stages run against a board's converter, CAN port, clock and watchdog.

#include <cstdint>

#include "common/frames.hpp"
#include "firmware/core/pipeline.hpp"
#include "firmware/core/report.hpp"
#include "hal/can_port.hpp"
#include "hal/clock.hpp"
#include "hal/gauge_adc.hpp"
#include "hal/watchdog.hpp"

namespace strainfinger::firmware {

struct FingerSettings {
  std::uint8_t node = 1;               ///< 1 .. 63
  std::uint16_t contactRate_hz = 500;  ///< 20 .. 1000
  FitMode mode = FitMode::kRefined;
  FingerFlags standingFlags{};  ///< simulated, uncalibrated
};

/// Counts of what could not be returned. They only grow.
struct FingerCounters {
  std::uint32_t sampleSets = 0;
  std::uint32_t fits = 0;
  std::uint32_t touchesSent = 0;  ///< pairs of CONTACT and FORCE
  std::uint32_t touchesBusy = 0;  ///< pairs the port couldn't take at once; a newer one replaced them
  std::uint32_t forcesLost =
      0;  ///< FORCE frames whose CONTACT went out but which the port didn't take in time
};

/// Runs one finger. `tables` must have passed checkTableImage(); everything is held by reference.
template <hal::GaugeAdc Adc, hal::CanPort Can, hal::Clock Clock, hal::Watchdog Watchdog>
class Finger {
 public:
  Finger(const TableImage& tables, const FingerSettings& settings, Adc& adc, Can& can, const Clock& clock,
         Watchdog& watchdog)
      : settings_(settings),
        pipeline_(tables, settings.mode),
        reporter_(1'000'000u / settings.contactRate_hz, settings.standingFlags),
        adc_(adc),
        can_(can),
        clock_(clock),
        watchdog_(watchdog),
        tableCrc_(static_cast<std::uint8_t>(tables.crc32)),
        steppedAt_us_(clock.now_us()),
        sampledAt_us_(steppedAt_us_),
        heartbeatAt_us_(steppedAt_us_ - kHeartbeatPeriod_us) {}

  /// One turn of the main loop: takes at most one sample set, sends what is due. Never blocks. The watchdog
  /// is fed only by sample sets that went all the way through. True: there was a sample set.
  bool step() {
    const std::uint32_t now_us = clock_.now_us();
    countUptime(now_us);
    if (forceOwed_) sendForce(now_us);
    const bool sampled = adc_.read(codes_);
    if (sampled) {
      take(now_us);
    } else if (isConverterSilent(now_us)) {
      sampledAt_us_ = now_us - kSilentConverter_us;  // no younger when the clock has gone round
    }
    beat(now_us);
    return sampled;
  }

  FingerState state() const { return state_; }
  const FingerCounters& counters() const { return counters_; }
  const Observation& lastObservation() const { return pipeline_.observation(); }
  const Readings& readings() const { return pipeline_.readings(); }  ///< of the last observation

 private:
  static constexpr std::uint32_t kHeartbeatPeriod_us = std::uint32_t{kHeartbeatPeriod_ms} * 1000;
  static constexpr std::uint32_t kSilentConverter_us = 100'000;
  static constexpr std::uint32_t kLongestUptime_s = kNotKnown<std::uint16_t> - 1;

  Codes codes() const { return Codes(codes_).first(pipeline_.constants().gauge_count); }

  void countUptime(std::uint32_t now_us) {
    sinceSecond_us_ += now_us - steppedAt_us_;
    steppedAt_us_ = now_us;
    for (; sinceSecond_us_ >= 1'000'000; sinceSecond_us_ -= 1'000'000) ++uptime_s_;
  }

  bool isConverterSilent(std::uint32_t now_us) const { return now_us - sampledAt_us_ >= kSilentConverter_us; }

  void take(std::uint32_t now_us) {
    sampledAt_us_ = now_us;
    ++counters_.sampleSets;
    if (state_ == FingerState::kRun) {
      observe(now_us);
    } else {
      zero();
    }
    watchdog_.feed();
  }

  void zero() {
    state_ = FingerState::kZeroing;
    if (!zero_.add(codes())) return;
    pipeline_.takeZero(zero_);
    state_ = FingerState::kRun;
  }

  void observe(std::uint32_t now_us) {
    if (pipeline_.process(codes()).fit) ++counters_.fits;
    report(now_us);
  }

  /// Not inlined, so that its frames aren't on the stack while the locator, which needs it most, runs.
  [[gnu::noinline]] void report(std::uint32_t now_us) {
    if (forceOwed_) return;
    const auto frames = reporter_.frames(pipeline_.constants(), pipeline_.observation(), now_us);
    if (!frames) return;
    if (!can_.send(encode(frames->contact, settings_.node))) {
      ++counters_.touchesBusy;
      return;
    }
    reporter_.sent(*frames, now_us);
    force_ = frames->force;
    forceOwed_ = true;
    contactAt_us_ = now_us;
    sendForce(now_us);
  }

  /// A FORCE that the port can't take waits for its CONTACT's sake, but never until it is old.
  void sendForce(std::uint32_t now_us) {
    if (now_us - contactAt_us_ >= std::uint32_t{kContactPeriod_ms} * 1000) {
      ++counters_.forcesLost;
      forceOwed_ = false;
    } else if (can_.send(encode(force_, settings_.node))) {
      ++counters_.touchesSent;
      forceOwed_ = false;
    }
  }

  void beat(std::uint32_t now_us) {
    if (now_us - heartbeatAt_us_ < kHeartbeatPeriod_us) return;
    if (can_.send(encode(heartbeat(now_us), settings_.node))) heartbeatAt_us_ = now_us;
  }

  HeartbeatFrame heartbeat(std::uint32_t now_us) const {
    const hal::CanStatus status = can_.status();
    HeartbeatFrame frame;
    frame.state = state_;
    frame.faults.set(FingerFault::kConverter, isConverterSilent(now_us));
    frame.faults.set(FingerFault::kCan, status.dropped != 0 || counters_.forcesLost != 0);
    frame.faults.set(FingerFault::kWatchdogReset, watchdog_.resetCause() == hal::ResetCause::kWatchdog);
    frame.uptime_s = saturate<std::uint16_t>(uptime_s_ < kLongestUptime_s ? uptime_s_ : kLongestUptime_s);
    if (status.txErrors) frame.tx_errors = *status.txErrors;
    if (status.rxErrors) frame.rx_errors = *status.rxErrors;
    frame.table_crc = tableCrc_;
    return frame;
  }

  FingerSettings settings_;
  Pipeline pipeline_;
  TouchReporter reporter_;
  ZeroAverage zero_;
  Adc& adc_;
  Can& can_;
  const Clock& clock_;
  Watchdog& watchdog_;
  std::uint8_t tableCrc_;
  FingerState state_ = FingerState::kBoot;
  hal::SampleSet codes_{};
  ForceFrame force_{};
  bool forceOwed_ = false;
  FingerCounters counters_{};
  std::uint32_t uptime_s_ = 0;
  std::uint32_t sinceSecond_us_ = 0;
  std::uint32_t steppedAt_us_;
  std::uint32_t sampledAt_us_;
  std::uint32_t heartbeatAt_us_;
  std::uint32_t contactAt_us_ = 0;
};

}  // namespace strainfinger::firmware
