#pragma once
// A guided session: sample sets and what the user says go in, rows to keep and what to do next come out. It
// knows no bus, no clock and no terminal.

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "host/session/advice.hpp"
#include "host/session/commands.hpp"
#include "host/session/fit_beside.hpp"
#include "host/session/thinning.hpp"

namespace strainfinger::session {

/// A row to keep.
struct NewRow {
  double time_s = 0;
  Eigen::VectorXd strains;
  calibration::KnownTouch known;
};

/// What comes of a command.
struct Obeyed {
  std::optional<NewRow> row{};
  std::string message{};   ///< for the user
  bool isRefused = false;  ///< nothing came of it; the message says why
  bool takenBack = false;  ///< what was known of a row is known no more
  bool tare = false;       ///< the finger is to be asked for a new zero
  bool quit = false;
};

class Session {
 public:
  /// Goes on with `rows`.
  Session(const config::FingerConfig& config, Rows rows, const calibration::KnownErrors& errors = {});

  /// The next sample set; the rows that come of it.
  std::vector<NewRow> take(const Sample& sample);

  Obeyed obey(const Command& command);

  /// There is enough new for a fit.
  bool wantsFit() const;
  /// What it is of.
  const Rows& beginFit();
  const Rows& rows() const { return rows_; }
  void takeFit(FitOutcome outcome);

  /// What the last set was.
  Verdict now() const { return now_; }
  /// The gauge that read most in it, of either sign; 0 before the first.
  int peakGauge() const;
  const Coverage& coverage() const { return coverage_; }
  /// Of the newest fit that succeeded and knew nothing that was taken back since; none once a newer one found
  /// that the finger is to be mended.
  const std::optional<FitOutcome>& fit() const { return fit_; }
  /// Of the newest fit, where it failed.
  const std::string& complaint() const { return complaint_; }
  /// It failed as the finger is to be mended.
  bool isFaulty() const { return isFaulty_; }
  Advice advice() const;
  /// A gauge that is far from its zero though the finger is at rest; none while a press is asked for, nor
  /// while one that was entered is still held, nor where the finger is to be mended.
  std::optional<int> farGauge() const;
  /// What the next load or angle is of was said by a Hold.
  bool isHolding() const { return held_.has_value(); }
  /// Seconds for which the finger has been at rest.
  double atRest_s() const;

 private:
  void keep(const NewRow& row);
  std::vector<NewRow> watchRest(const Sample& sample);
  std::optional<Sample> nowHeld(std::string& why) const;
  Obeyed obeyLoad(double normal_n_per_m);
  Obeyed obeyAngle(double angle_deg);
  bool isPressed() const;
  std::string doubtOf(const calibration::KnownTouch& known, const Eigen::VectorXd& strains) const;
  std::string doubtOfLoad(double said_n_per_m, const Eigen::VectorXd& strains) const;
  std::string doubtOfAngle(double said_deg, const Eigen::VectorXd& strains) const;
  Obeyed keepHeld(const calibration::KnownTouch& known, const std::string& what);
  Obeyed obeyHold();
  Obeyed obeySkip();
  Obeyed obeyUndo();
  Obeyed obeyTare();
  Obeyed obeyMayTare() const;

  config::FingerConfig config_;
  calibration::KnownErrors errors_;
  Rows rows_;
  Thinner thinner_;
  calibration::TouchSearch search_;
  Coverage coverage_;
  std::size_t firstRow_;  ///< of this session
  Verdict now_ = Verdict::kTooSoon;
  Unavailable unavailable_;
  std::optional<FitOutcome> fit_;
  std::string complaint_;
  bool isFaulty_ = false;
  std::size_t tried_ = 0;                   ///< rows of the last fit
  bool knowsOther_ = false;                 ///< than at the last fit, of a touch
  bool isFitOutdated_ = false;              ///< the one that is being made: it knows what was taken back
  std::deque<Sample> recent_;               ///< of the last HoldRules::time_s
  std::optional<Sample> held_;              ///< what the next load or angle is of, if that was said
  std::optional<Eigen::VectorXd> pressed_;  ///< the strains of what was held, or entered, last
  /// What was refused last, a load or an angle, and of which touch.
  std::optional<NewRow> doubted_;
  std::vector<Sample> resting_;  ///< since the finger came to rest
  Eigen::VectorXd restSum_;
  std::optional<int> farGauge_;
};

}  // namespace strainfinger::session
