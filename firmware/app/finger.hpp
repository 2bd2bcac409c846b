#pragma once
// The finger: the stages run against a board's converter, CAN port, clock and watchdog.

#include <algorithm>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "common/commands.hpp"
#include "common/frames.hpp"
#include "common/raw_share.hpp"
#include "firmware/app/next_request.hpp"
#include "firmware/app/owed_frames.hpp"
#include "firmware/app/raw_sender.hpp"
#include "firmware/app/stored_settings.hpp"
#include "firmware/core/pipeline.hpp"
#include "firmware/core/report.hpp"
#include "hal/can_port.hpp"
#include "hal/clock.hpp"
#include "hal/gauge_adc.hpp"
#include "hal/watchdog.hpp"

namespace strainfinger::firmware {

struct FingerSettings {
  std::uint8_t node = 1;               ///< 1 .. 63
  std::uint16_t contactRate_hz = 500;  ///< kSlowestContactRate_hz .. kFastestContactRate_hz
  std::uint16_t samplePeriod_us = 1000;
  std::uint32_t bitrate = 1'000'000;  ///< [bit/s]
  FitMode mode = FitMode::kRefined;
  FingerFlags standingFlags{};    ///< simulated, uncalibrated: that one unless the tables have gains
  FingerFaults standingFaults{};  ///< configuration, clock
  std::uint8_t board = 0;         ///< tells boards apart; 0: not known
  bool takesTables = false;       ///< there is memory for other tables
};

/// What a finger was told that it can't do while it runs.
enum class Leaving : std::uint8_t { kStays, kLoads, kRestarts };

/// Counters of what happened that no return value reports. They only grow.
struct FingerCounters {
  std::uint32_t sampleSets = 0;
  std::uint32_t fits = 0;               ///< touched sample sets
  std::uint32_t touchesSent = 0;        ///< with all their frames: CONTACT, FORCE, PATCH ..
  std::uint32_t touchesBusy = 0;        ///< the port couldn't take CONTACT at once; a newer one replaced it
  std::uint32_t touchesIncomplete = 0;  ///< CONTACT went out, but the port didn't take the others in time
};

/// Runs one finger. `tables` must have passed checkTableImage(); everything is held by reference.
template <hal::GaugeAdc Adc, hal::CanPort Can, hal::Clock Clock, hal::Watchdog Watchdog,
          hal::NonVolatile Store = hal::NoStore>
class Finger {
 public:
  Finger(const TableImage& tables, const FingerSettings& settings, Adc& adc, Can& can, const Clock& clock,
         Watchdog& watchdog, Store& store = hal::noStore)
      : settings_(settings),
        kept_{settings.node, settings.contactRate_hz},
        settingsStore_(store),
        eraseBudget_(EraseBudget::after(watchdog.resetCause())),
        tables_(tables),
        pipeline_(tables, settings.mode),
        reporter_(periodOf(settings.contactRate_hz), standingFlagsOf(settings, tables),
                  watchdog.resetCause() != ResetCause::kPowerOn),
        adc_(adc),
        can_(can),
        clock_(clock),
        watchdog_(watchdog),
        store_(store),
        steppedAt_us_(clock.now_us()),
        sampledAt_us_(steppedAt_us_),
        heartbeatAt_us_(steppedAt_us_ - kHeartbeatPeriod_us),
        gaugesAt_us_(steppedAt_us_) {}

  /// One turn of the main loop: takes at most one sample set and one request, sends what is due. Blocks only
  /// for `keep` and `node`, while the memory erases a page (25 ms on the finger board). The watchdog is fed
  /// only by sample sets that went all the way through. True: there was a sample set.
  bool step() {
    const std::uint32_t now_us = clock_.now_us();
    countUptime(now_us);
    if (owed_.any()) sendOwed(now_us);
    const bool sampled = adc_.read(codes_);
    if (sampled) {
      take(now_us);
    } else if (isConverterSilent(now_us)) {
      sampledAt_us_ = now_us - kSilentConverter_us;  // no younger when the clock has gone round
    }
    beat(now_us);
    if (areGaugesNews(now_us)) sayGauges(now_us);
    serve(now_us);
    if (raw_.any()) raw_.send(can_, settings_.node, pipeline_.calibration());
    return sampled;
  }

  FingerState state() const { return state_; }
  /// Once it has answered, or could not in kAnswerWithin_ms; then it is to be stepped no more.
  Leaving leaving() const { return response_ ? Leaving::kStays : leaving_; }
  const FingerCounters& counters() const { return counters_; }
  std::uint32_t uptime_s() const { return uptime_s_; }
  const EraseBudget& eraseBudget() const { return eraseBudget_; }  ///< at uptime_s()
  const Observation& lastObservation() const { return pipeline_.observation(); }
  const Answer& lastAnswer() const { return pipeline_.answer(); }    ///< while it is touched
  const Readings& readings() const { return pipeline_.readings(); }  ///< of the last observation

 private:
  static FingerFlags standingFlagsOf(const FingerSettings& settings, const TableImage& tables) {
    FingerFlags flags = settings.standingFlags;
    if (tables.gains.areKnown()) flags.set(FingerFlag::kUncalibrated, false);
    return flags;
  }

  static constexpr std::uint32_t kHeartbeatPeriod_us = std::uint32_t{kHeartbeatPeriod_ms} * 1000;
  static constexpr std::uint32_t kGaugesPeriod_us = std::uint32_t{kGaugesPeriod_ms} * 1000;
  static constexpr std::uint32_t kSilentConverter_us = 100'000;
  static constexpr std::uint32_t kTarePeriod_us = hal::kSecond_us;  ///< a zero is taken at most so often
  static constexpr std::uint32_t kAnswerWithin_us = std::uint32_t{kAnswerWithin_ms} * 1000;
  static constexpr std::uint32_t kLongestUptime_s = kNotKnown<std::uint16_t> - 1;

  Codes codes() const { return Codes(codes_).first(pipeline_.constants().gauge_count); }

  void countUptime(std::uint32_t now_us) {
    const std::uint32_t passed_us = now_us - steppedAt_us_;
    tareWait_us_ -= std::min(tareWait_us_, passed_us);
    sinceSecond_us_ += passed_us;
    steppedAt_us_ = now_us;
    for (; sinceSecond_us_ >= hal::kSecond_us; sinceSecond_us_ -= hal::kSecond_us) {
      ++uptime_s_;
      setsPerSecond_ = counters_.sampleSets - setsAtSecond_;
      setsAtSecond_ = counters_.sampleSets;
    }
  }

  bool isConverterSilent(std::uint32_t now_us) const { return now_us - sampledAt_us_ >= kSilentConverter_us; }

  void take(std::uint32_t now_us) {
    sampledAt_us_ = now_us;
    ++counters_.sampleSets;
    if (leaving_ != Leaving::kStays) {
      // A touch that began now would not be told to have ended.
    } else if (state_ == FingerState::kRun) {
      observe(now_us);
      sayRaw(RawKind::kReadings);
    } else {
      zero();
      sayRaw(RawKind::kZeroing);
    }
    watchdog_.feed();
  }

  void zero() {
    state_ = FingerState::kZeroing;
    if (!zero_.add(codes())) return;
    state_ = FingerState::kRun;
    if ((isTouchRefused_ || tareStatus_) && pipeline_.isTouchedDuring(zero_)) {
      if (tareStatus_) tareStatus_ = isTouchRefused_ ? CommandStatus::kTouched : CommandStatus::kDoneTouched;
      if (isTouchRefused_) return;
    }
    beginAnew();
  }

  /// With this zero, as after a start: what is said from here on follows from the sample sets alone.
  void beginAnew() {
    std::construct_at(&pipeline_, tables_, settings_.mode);
    pipeline_.takeZero(zero_);
    raw_.sayZeros();
  }

  void sayRaw(RawKind kind) { raw_.take(codes(), kind, sampleNumber(), settings_.samplePeriod_us); }

  /// Sample sets since the start, those that were lost included.
  std::uint32_t sampleNumber() const { return counters_.sampleSets + adc_.overruns(); }

  /// Time by the converter's clock: what is reported when doesn't depend on how late a set is fetched.
  std::uint32_t sampleTime_us() const { return sampleNumber() * settings_.samplePeriod_us; }

  void observe(std::uint32_t now_us) {
    if (pipeline_.process(codes()).touched) ++counters_.fits;
    report(now_us);
  }

  /// After the locator, which needs the stack most: were this inlined into what calls both, its frames would
  /// be on the stack as well. check_image.py shows if a compiler does that.
  void report(std::uint32_t now_us) {
    if (owed_.any()) return reporter_.missed();
    auto frames = reporter_.frames(pipeline_.constants(), pipeline_.observation(), pipeline_.answer(),
                                   pipeline_.linearisation(), sampleTime_us());
    if (!frames) return;
    const std::uint32_t busOffs = can_.status().busOffs;
    if (!can_.send(encode(frames->contact, settings_.node))) {
      ++counters_.touchesBusy;
      return;
    }
    reporter_.sent(*frames, sampleTime_us());
    releaseSecond(*frames);
    owed_.owe(*frames, settings_.node, now_us, busOffs);
    sendOwed(now_us);
  }

  /// A second contact that ends is said once more as well, without contact and with no force, until the port
  /// has taken it.
  void releaseSecond(TouchFrames& frames) {
    isSecond_ = frames.second.has_value();
    wasSecondEver_ |= isSecond_;
    if (isSecond_) maySecondStand_ = true;
    if (isSecond_ || !maySecondStand_) return;
    FingerFlags flags = frames.contact.flags;
    flags.set(FingerFlag::kContact, false);
    const TouchFrames released = releaseFrames(flags, frames.contact.sequence);
    frames.second = {{released.contact}, {released.force}};
  }

  void sendOwed(std::uint32_t now_us) {
    const OwedFrames::Outcome outcome = owed_.send(can_, now_us);
    if (outcome == OwedFrames::Outcome::kAllSent) {
      ++counters_.touchesSent;
      maySecondStand_ = isSecond_;
    }
    if (outcome == OwedFrames::Outcome::kDropped) {
      ++counters_.touchesIncomplete;
      reporter_.lost();
    }
  }

  void beat(std::uint32_t now_us) {
    if (now_us - heartbeatAt_us_ < kHeartbeatPeriod_us) return;
    const hal::CanStatus status = can_.status();
    repeatAfter(status.busOffs);
    if (can_.send(encode(heartbeat(status, now_us), settings_.node))) heartbeatAt_us_ = now_us;
  }

  /// What the port had taken when the node left the bus is lost, perhaps the end of a touch.
  void repeatAfter(std::uint32_t busOffs) {
    if (std::exchange(busOffs_, busOffs) == busOffs) return;
    reporter_.lost();
    maySecondStand_ = wasSecondEver_;
  }

  HeartbeatFrame heartbeat(const hal::CanStatus& status, std::uint32_t now_us) const {
    HeartbeatFrame frame;
    frame.state = state_;
    frame.faults = settings_.standingFaults;
    frame.faults.set(FingerFault::kGauges, pipeline_.observation().tooFewGauges);
    frame.faults.set(FingerFault::kNoisy, pipeline_.observation().noisy);
    frame.faults.set(FingerFault::kConverter, isConverterSilent(now_us));
    frame.faults.set(FingerFault::kCan,
                     status.dropped != 0 || status.missed != 0 || counters_.touchesIncomplete != 0);
    frame.faults.set(FingerFault::kWatchdogReset, watchdog_.resetCause() == hal::ResetCause::kWatchdog);
    frame.faults.set(FingerFault::kSamples, adc_.overruns() != 0);
    frame.uptime_s = saturate<std::uint16_t>(uptime_s_ < kLongestUptime_s ? uptime_s_ : kLongestUptime_s);
    if (status.txErrors) frame.tx_error_steps = errorSteps(*status.txErrors);
    if (status.rxErrors) frame.rx_error_steps = errorSteps(*status.rxErrors);
    frame.table_crc = tableCrcByte(tables_.crc32);
    return frame;
  }

  /// Once in a while, and at once when a gauge has failed or works again.
  bool areGaugesNews(std::uint32_t now_us) const {
    return now_us - gaugesAt_us_ >= kGaugesPeriod_us || pipeline_.observation().outOfUse != saidOutOfUse_;
  }

  void sayGauges(std::uint32_t now_us) {
    const GaugeSet outOfUse = pipeline_.observation().outOfUse;
    const GaugesFrame frame = gaugesFrame(outOfUse, pipeline_.zeroTracker(), setsPerSecond_);
    if (!can_.send(encode(frame, settings_.node))) return;
    gaugesAt_us_ = now_us;
    saidOutOfUse_ = outOfUse;
  }

  static constexpr std::uint32_t periodOf(std::uint32_t rate_hz) { return hal::kSecond_us / rate_hz; }

  /// Answers the request that has arrived, at once or when its work is done; while an answer waits for the
  /// port, the next request does.
  void serve(std::uint32_t now_us) {
    if ((response_ || tareStatus_) && now_us - requestedAt_us_ >= kAnswerWithin_us) {
      response_.reset();
      tareStatus_.reset();
    }
    if (!response_) response_ = nextResponse(now_us);
    if (response_ && can_.send(encode(*response_, settings_.node))) response_.reset();
  }

  std::optional<ResponseFrame> nextResponse(std::uint32_t now_us) {
    if (tareStatus_ && state_ == FingerState::kRun)
      return responseTo(Command::kTare, *std::exchange(tareStatus_, std::nullopt));
    const auto request = nextRequest(can_, settings_.node);
    if (!request) return std::nullopt;
    if (!tareStatus_) requestedAt_us_ = now_us;  // the answer to a tare is to be in time, too
    return obey(*request, now_us);
  }

  /// Nothing: it will be answered when it is done.
  std::optional<ResponseFrame> obey(const RequestFrame& request, std::uint32_t now_us) {
    const Command command = request.command;
    const CommandStatus fault = checkRequest(request);
    if (fault != CommandStatus::kDone) return responseTo(command, fault);
    switch (command) {
      case Command::kTare:
        return tare(request.argument != 0, now_us);
      case Command::kContactRate:
        settings_.contactRate_hz = request.argument;
        reporter_.setShortestPeriod(periodOf(request.argument));
        return responseTo(command, CommandStatus::kDone);
      case Command::kKeep:
        return keep(command, {kept_.node, settings_.contactRate_hz}, request.argument != 0);
      case Command::kNode:
        return keep(command, {static_cast<std::uint8_t>(request.argument), kept_.contactRate_hz},
                    (request.argument & kNodeEvenWhileTouched) != 0);
      case Command::kCount:
        return responseTo(command, CommandStatus::kDone, countOf(static_cast<Count>(request.argument)));
      case Command::kRaw:
        return startRaw(request.argument);
      case Command::kLoad:
        return load(request.argument != 0);
      case Command::kWord:
        return responseTo(command, CommandStatus::kOutOfTurn);
      case Command::kRestart:
        return leave(command, Leaving::kRestarts, request.argument != 0);
    }
    return responseTo(command, CommandStatus::kUnknownCommand);
  }

  bool isTouched() const { return pipeline_.observation().touched; }

  /// Refused while listeners would go on to take the last CONTACT for a touch, unless that is meant: then the
  /// end of the touch is said after the restart. Refused, too, while the answer to a tare is due.
  ResponseFrame leave(Command command, Leaving where, bool evenWhileTouched) {
    if (isTouched() && !evenWhileTouched) return responseTo(command, CommandStatus::kTouched);
    const bool isEndOwed = owed_.any() || reporter_.owesEnd();
    if (tareStatus_ || (isEndOwed && !evenWhileTouched)) return responseTo(command, CommandStatus::kBusy);
    leaving_ = where;
    return responseTo(command, CommandStatus::kDone);
  }

  ResponseFrame load(bool evenWhileTouched) {
    if (!settings_.takesTables) return responseTo(Command::kLoad, CommandStatus::kNotKept);
    if (const std::uint32_t wait_s = eraseBudget_.wait_s(uptime_s_); wait_s > 0)
      return responseTo(Command::kLoad, CommandStatus::kWait, wait_s);
    const ResponseFrame response = leave(Command::kLoad, Leaving::kLoads, evenWhileTouched);
    if (leaving_ == Leaving::kLoads) eraseBudget_.spend(uptime_s_);
    return response;
  }

  /// Memory that is erased stops the board, and with it the touch: only untouched, or if that is meant.
  ResponseFrame keep(Command command, const StoredSettings& settings, bool evenWhileTouched) {
    if (isTouched() && !evenWhileTouched && !settingsStore_.has(settings))
      return responseTo(command, CommandStatus::kTouched);
    const SaveResult result = settingsStore_.save(settings, eraseBudget_, uptime_s_);
    if (result == SaveResult::kWait)
      return responseTo(command, CommandStatus::kWait, eraseBudget_.wait_s(uptime_s_));
    if (result == SaveResult::kFailed) return responseTo(command, CommandStatus::kNotKept);
    kept_ = settings;
    return responseTo(command, CommandStatus::kDone);
  }

  ResponseFrame startRaw(std::uint16_t rate_hz) {
    const std::uint16_t fastest_hz = fastestRaw_hz(pipeline_.constants().gauge_count, settings_.bitrate);
    if (rate_hz > fastest_hz) return responseTo(Command::kRaw, CommandStatus::kTooFast, fastest_hz);
    raw_.setRate(rate_hz);
    return responseTo(Command::kRaw, CommandStatus::kDone);
  }

  std::uint32_t countOf(Count count) const {
    switch (count) {
      case Count::kErases:
        return settingsStore_.erases();
      case Count::kCorrected:
        return store_.errors().corrected;
      case Count::kUnreadable:
        return store_.errors().unreadable;
      case Count::kLostSets:
        return adc_.overruns();
      case Count::kResynchronised:
        return adc_.resynchronisations();
    }
    return 0;
  }

  std::optional<ResponseFrame> tare(bool evenWhileTouched, std::uint32_t now_us) {
    const auto refused = [](CommandStatus status) { return responseTo(Command::kTare, status); };
    if (state_ != FingerState::kRun || isConverterSilent(now_us)) return refused(CommandStatus::kBusy);
    if (tareWait_us_ != 0) return responseTo(Command::kTare, CommandStatus::kWait, 1);
    if (isTouched() && !evenWhileTouched) return refused(CommandStatus::kTouched);
    isTouchRefused_ = !evenWhileTouched;
    tareStatus_ = isTouched() ? CommandStatus::kDoneTouched : CommandStatus::kDone;
    tareWait_us_ = kTarePeriod_us;
    zero_ = {};
    state_ = FingerState::kZeroing;
    return std::nullopt;
  }

  FingerSettings settings_;
  StoredSettings kept_;  ///< for the next start
  SettingsStore<Store> settingsStore_;
  EraseBudget eraseBudget_;
  const TableImage& tables_;
  Pipeline pipeline_;
  TouchReporter reporter_;
  ZeroAverage zero_;
  Adc& adc_;
  Can& can_;
  const Clock& clock_;
  Watchdog& watchdog_;
  Store& store_;
  FingerState state_ = FingerState::kBoot;
  alignas(4) hal::SampleSet codes_{};  ///< compared and copied by words
  OwedFrames owed_;
  bool isSecond_ = false;        ///< there is a second contact in the last touch that was said
  bool maySecondStand_ = false;  ///< the last that was said of a second contact may be that there is one
  bool wasSecondEver_ = false;
  std::uint32_t busOffs_ = 0;  ///< of the port, at the last heartbeat
  RawSender raw_;
  std::optional<CommandStatus> tareStatus_;  ///< to answer when the zero is taken
  /// The zero that is being taken is refused if a touch shows in it; holds after the answer has timed out,
  /// too.
  bool isTouchRefused_ = false;
  Leaving leaving_ = Leaving::kStays;
  std::optional<ResponseFrame> response_;  ///< that the port hasn't taken yet
  FingerCounters counters_{};
  std::uint32_t uptime_s_ = 0;
  std::uint32_t sinceSecond_us_ = 0;
  std::uint32_t steppedAt_us_;
  std::uint32_t sampledAt_us_;
  std::uint32_t heartbeatAt_us_;
  std::uint32_t gaugesAt_us_;
  std::uint32_t setsPerSecond_ = 0;  ///< sample sets of the last whole second
  std::uint32_t setsAtSecond_ = 0;
  GaugeSet saidOutOfUse_ = 0;
  std::uint32_t requestedAt_us_ = 0;
  std::uint32_t tareWait_us_ = 0;  ///< until the zero may be taken again
};

}  // namespace strainfinger::firmware
