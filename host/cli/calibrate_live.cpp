#include "host/cli/calibrate_live.hpp"

#include <fmt/format.h>

#include <chrono>
#include <cstdio>
#include <memory>
#include <thread>
#include <utility>

#include "host/base/failure.hpp"
#include "host/base/line_reader.hpp"
#include "host/base/notice.hpp"
#include "host/can/open_bus.hpp"
#include "host/can/strain_receiver.hpp"
#include "host/cli/raw_stream.hpp"
#include "host/live/terminal.hpp"
#include "host/session/session.hpp"
#include "host/session/session_files.hpp"
#include "host/session/session_view.hpp"
#include "host/session/zero_watch.hpp"
#include "host/system/stop_signal.hpp"

namespace strainfinger::cli {
namespace {

using SessionClock = std::chrono::steady_clock;
using namespace std::chrono_literals;

constexpr auto kSessionRedraw = 100ms;  ///< between pictures
constexpr auto kSessionWait = 20ms;     ///< for frames, before keys are looked at
constexpr auto kSessionSilence = 3s;    ///< then the finger is asked again: it may have been off
constexpr auto kSessionLine = 1s, kSessionSameLine = 10s;  ///< between lines: at least; when nothing is new

double secondsSince(SessionClock::time_point then) {
  return std::chrono::duration<double>(SessionClock::now() - then).count();
}

/// What the user says and sees.
class SessionFace {
 public:
  virtual ~SessionFace() = default;
  /// A command, if one was given.
  virtual std::optional<session::Command> readCommand() = 0;
  /// Whether the last command was obeyed.
  virtual void answer(bool) {}
  /// Nobody can give a command any more.
  virtual bool isOver() const { return false; }
  /// A load or an angle is about to be entered; `isHeld`: of what the session holds.
  virtual bool isEntering(bool isHeld) const = 0;
  virtual void show(const session::SessionView& view) = 0;
  /// What became of a command, or of the finger, at once.
  virtual void say(const std::string& message) = 0;
};

class SessionScreen : public SessionFace {
 public:
  explicit SessionScreen(const config::FingerConfig& config)
      : gauges_(config.gauges), keys_(config.finger.length_m) {}

  std::optional<session::Command> readCommand() override {
    while (const auto key = terminal_.key())
      if (auto command = keys_.press(*key)) return command;
    return std::nullopt;
  }
  void answer(bool isObeyed) override { keys_.answer(isObeyed); }
  /// What Escape dropped is held on, but nobody enters it.
  bool isEntering(bool) const override { return !keys_.prompt().empty(); }
  void show(const session::SessionView& view) override {
    if (SessionClock::now() - drawn_ < kSessionRedraw) return;
    drawn_ = SessionClock::now();
    session::SessionView prompted = view;
    prompted.prompt = keys_.prompt();
    terminal_.show(session::drawSession(prompted, gauges_, live::terminalForm()));
  }
  void say(const std::string&) override {}  // the view has it

 private:
  const config::Gauges& gauges_;
  live::Terminal terminal_;
  session::KeyReader keys_;
  SessionClock::time_point drawn_{};
};

/// Lines on stderr: stdout is for the table at the end. Commands are lines on stdin.
class SessionLines : public SessionFace {
 public:
  explicit SessionLines(double length_m) : length_m_(length_m) {}

  std::optional<session::Command> readCommand() override {
    if (const auto line = stdin_.next()) return session::parseCommand(*line, length_m_);
    if (!isOver_) isOver_ = stdin_.read(0ms) == LineReader::Got::kEnd;
    if (const auto line = stdin_.next()) return session::parseCommand(*line, length_m_);
    if (const auto last = isOver_ ? stdin_.rest() : std::nullopt)
      return session::parseCommand(*last, length_m_);
    return std::nullopt;
  }
  bool isOver() const override { return isOver_; }
  bool isEntering(bool isHeld) const override { return isHeld && !isOver_; }
  void show(const session::SessionView& view) override {
    const auto since = SessionClock::now() - printed_;
    const std::string news =
        fmt::format("{}|{}|{}", view.next, view.complaint, view.assessment ? view.assessment->rows : 0);
    if (since < kSessionLine || (news == news_ && since < kSessionSameLine)) return;
    printed_ = SessionClock::now();
    news_ = news;
    tell("{}\n", session::sessionLine(view));
  }
  void say(const std::string& message) override { tell("calibrate: {}\n", message); }

 private:
  double length_m_;
  LineReader stdin_{"-"};
  bool isOver_ = false;
  std::string news_;
  SessionClock::time_point printed_{};
};

/// Bus, files and fit around a session.
class LiveSession {
 public:
  LiveSession(const config::FingerConfig& config, const LiveCalibration& options)
      : config_(config),
        options_(options),
        port_(can::openBus(options.bus, config.can.bitrate)),
        files_(options.outputPath, config),
        session_(config, files_.rows(), options.errors),
        fit_(config, options.errors),
        receiver_(options.node, config.gauges.count, config.gauges.full_scale_strain),
        zeroWatch_(config.gauges) {}

  LiveResult run() {
    bool interrupted = false;
    try {
      interrupted = collect();
    } catch (const Failure& failure) {
      throw Failure(failure.code(), fmt::format("{}; {}", failure.what(), kept()));
    }
    return conclude(interrupted);
  }

 private:
  /// Whether it was interrupted.
  bool collect() {
    const system::StopSignal stop;
    RawStream stream(*port_, options_.node, options_.rate_hz, stop);
    missedBefore_ = port_->status().missed;
    heard_ = SessionClock::now();
    face_ = makeFace();
    while (!stop.asked() && !quit_ && !isDone()) {
      if (port_->waitReadable(kSessionWait)) std::this_thread::sleep_for(can::BusPort::kGather);
      takeFrames();
      followFit();
      while (const auto command = face_->readCommand()) obey(*command);
      if (face_->isOver()) skipEntry();
      if (SessionClock::now() - heard_ > kSessionSilence) askAgain(stream);
      face_->show(view());
    }
    face_.reset();  // what is said from now on stays to be read, and Ctrl-Z stops the fit
    return stop.asked();
  }

  /// Nothing is left to gain, and nothing is being entered.
  bool isDone() const {
    return session_.advice().kind == session::Advice::Kind::kDone && !face_->isEntering(session_.isHolding());
  }

  std::unique_ptr<SessionFace> makeFace() const {
    if (!options_.plain && live::hasTerminal()) return std::make_unique<SessionScreen>(config_);
    return std::make_unique<SessionLines>(config_.finger.length_m);
  }

  void takeFrames() {
    while (const auto frame = port_->receiveTimed()) {
      const auto set = receiver_.take(frame->frame);
      receiver_.requireAllGauges();
      requireZeros();
      if (!set) continue;
      heard_ = SessionClock::now();
      if (set->zeroing) continue;
      ++sets_;
      const session::Sample sample{
          1e-9 * static_cast<double>(frame->time_ns),
          Eigen::Map<const Eigen::VectorXd>(set->strains.data(), config_.gauges.count)};
      for (const session::NewRow& row : session_.take(sample)) files_.add(row.time_s, row.strains, row.known);
    }
  }

  /// Rows of two zeros don't go together. That a zero is being taken says nothing: it may be refused, be what
  /// it was, or not be seen.
  void requireZeros() {
    if (!zeroWatch_.haveMoved(receiver_.zeros()) || session_.rows().size() == 0) return;
    rowsUse_ = session::RowsUse::kOfOldZero;
    throw Failure(ExitCode::kFailure,
                  fmt::format("{} node {} has taken another zero, by another program's `tare` or at a start: "
                              "readings from now on don't go with the rows so far",
                              port_->name(), options_.node));
  }

  void takeFit(session::FitOutcome outcome) {
    outcome.complaint = files_.named(outcome.complaint);
    session_.takeFit(std::move(outcome));
  }

  void followFit() {
    if (auto outcome = fit_.poll()) takeFit(std::move(*outcome));
    if (!fit_.isRunning() && session_.wantsFit()) fit_.start(session_.beginFit());
  }

  void obey(const session::Command& command) {
    const session::Obeyed obeyed = session_.obey(command);
    if (obeyed.row) files_.add(obeyed.row->time_s, obeyed.row->strains, obeyed.row->known);
    if (obeyed.takenBack) takeBack();
    face_->answer(!obeyed.isRefused);
    tell(obeyed.message);
    quit_ |= obeyed.quit;
    if (obeyed.tare) tare();
  }

  /// What is to be entered and cannot be would be asked for without end; nor does a finger get mended.
  void skipEntry() {
    const auto kind = session_.advice().kind;
    quit_ |= kind == session::Advice::Kind::kMend;
    if (kind != session::Advice::Kind::kPress && kind != session::Advice::Kind::kMark) return;
    const session::Obeyed obeyed = session_.obey(session::Skip{});
    tell("stdin is at its end: skipped: " + obeyed.message);
  }

  void takeBack() {
    try {
      files_.rewriteTouches(session_.rows().known);
    } catch (const Failure& failure) {
      throw Failure(failure.code(), fmt::format("{}: what was taken back is still there: take it back again",
                                                failure.what()));
    }
  }

  void tell(const std::string& message) {
    message_ = message;
    if (!message.empty()) face_->say(message);
  }

  void tare() {
    const can::Reply reply = can::ask(*port_, options_.node, tareRequest(false));
    heard_ = SessionClock::now();
    tell(reply.response ? "tare: " + can::meaningOf(*reply.response)
                        : "tare: no answer: is the finger on the bus still?");
  }

  void askAgain(RawStream& stream) {
    const auto silence_s = secondsSince(heard_);
    stream.askAgain();
    heard_ = SessionClock::now();
    if (sets_ == 0) receiver_.requireEnoughGauges();
    if (++silences_ > kMostSilences || sets_ == 0)
      throw Failure(ExitCode::kNoNode,
                    fmt::format("{} node {}: no whole set of readings for {:.0f} s, though it answers: is "
                                "the bus free enough? A lower --rate may help",
                                port_->name(), options_.node, silence_s));
    tell("the finger sent nothing, and was asked again");
  }

  session::SessionView view() const {
    session::SessionView view{.bus = port_->name(), .node = options_.node};
    view.time_s = secondsSince(began_);
    view.sets = sets_;
    view.lost = port_->status().missed - missedBefore_ + receiver_.incomplete();
    view.rows = session_.rows().size();
    view.coverage = session_.coverage();
    view.now = session_.now();
    view.peakGauge = session_.peakGauge();
    view.silent_s = secondsSince(heard_);
    view.atRest_s = session_.atRest_s();
    view.next = nextText();
    if (session_.fit()) view.assessment = session_.fit()->assessment;
    view.isFitting = fit_.isRunning();
    view.complaint = session_.complaint();
    view.message = message_;
    return view;
  }

  std::string nextText() const {
    if (const auto gauge = session_.farGauge())
      return fmt::format(
          "Gauge {} is far from its zero though nothing moves. If nothing touches the finger, tare it{}.",
          *gauge, session_.rows().size() == 0 ? " (t)" : "");
    return session::textOf(session_.advice(), config_.gauges);
  }

  /// `fittedRows`: of the fit that is reported, if one is.
  std::string kept(std::optional<std::size_t> fittedRows = {}) const {
    const auto use = session_.isFaulty() ? session::RowsUse::kOfFaults : rowsUse_;
    return session::keptText(files_.kept(), fittedRows, use, files_.strainsPath(), files_.touchesPath());
  }

  /// A last fit of all rows, unless there is one or nobody waits for it.
  LiveResult conclude(bool interrupted) {
    if (fit_.isRunning()) {
      strainfinger::tell("calibrate: waiting for the fit that is being made{}\n",
                         interrupted ? "; Ctrl-C ends it at once" : "");
      takeFit(*fit_.wait());
    }
    const bool isNewest = session_.fit() && session_.fit()->rows == session_.rows().size();
    if (session_.rows().size() == 0)
      return {std::nullopt, "there is nothing to fit", "", "", kept(), interrupted};
    if (!interrupted && !isNewest) {
      strainfinger::tell("calibrate: fitting {} rows\n", session_.rows().size());
      takeFit(session::fitRows(config_, session_.beginFit(), options_.errors));
    }
    LiveResult ended{std::nullopt, session_.complaint(), files_.strainsPath(), files_.touchesPath(),
                     kept(),       interrupted};
    if (session_.fit() && (interrupted || session_.complaint().empty())) {
      ended.result = session_.fit()->result;
      ended.kept = kept(session_.fit()->rows);
    }
    if (ended.complaint.empty() && !ended.result) ended.complaint = "there is no fit of what is known now";
    return ended;
  }

  static constexpr int kMostSilences = 3;

  config::FingerConfig config_;
  LiveCalibration options_;
  std::unique_ptr<can::BusPort> port_;
  session::SessionFiles files_;
  session::Session session_;
  session::FitBeside fit_;
  can::StrainReceiver receiver_;
  session::ZeroWatch zeroWatch_;
  SessionClock::time_point began_ = SessionClock::now(), heard_ = began_;
  std::uint32_t missedBefore_ = 0;
  std::uint64_t sets_ = 0;
  int silences_ = 0;
  std::unique_ptr<SessionFace> face_;
  std::string message_;
  bool quit_ = false;
  session::RowsUse rowsUse_ = session::RowsUse::kToGoOn;
};

}  // namespace

LiveResult calibrateLive(const config::FingerConfig& config, const LiveCalibration& options) {
  return LiveSession(config, options).run();
}

}  // namespace strainfinger::cli
