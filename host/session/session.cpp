#include "host/session/session.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <variant>

#include "host/base/angles.hpp"
#include "host/calibration/known_units.hpp"
#include "host/config/over_range.hpp"
#include "host/session/rules.hpp"

namespace strainfinger::session {

using calibration::KnownTouch;
using Eigen::VectorXd;

namespace {

/// Readings may still be those of a touch.
bool isOfTouch(const VectorXd& strains, const VectorXd& touch) {
  return (strains - touch).norm() < kHolds.stillHeld * touch.norm();
}

}  // namespace

Session::Session(const config::FingerConfig& config, Rows rows, const calibration::KnownErrors& errors)
    : config_(config),
      errors_(errors),
      rows_(std::move(rows)),
      thinner_(config),
      search_(calibration::drawnSearch(config)),
      coverage_(coverageOf(config.gauges, search_, rows_)),
      firstRow_(rows_.size()) {
  for (const VectorXd& strains : rows_.strains) thinner_.remember(strains);
}

void Session::keep(const NewRow& row) {
  rows_.add(row.strains, row.known);
  count(coverage_, config_.gauges, search_, row.strains, row.known);
}

std::vector<NewRow> Session::take(const Sample& sample) {
  recent_.push_back(sample);
  while (sample.time_s - recent_.front().time_s > kHolds.time_s) recent_.pop_front();
  now_ = coverage_.untouched > 0 ? thinner_.take(sample) : Verdict::kTooSoon;
  std::vector<NewRow> found = watchRest(sample);
  if (now_ == Verdict::kKept) found.push_back({sample.time_s, sample.strains, {}});
  for (const NewRow& row : found) keep(row);
  return found;
}

double Session::atRest_s() const {
  return resting_.empty() ? 0 : resting_.back().time_s - resting_.front().time_s;
}

/// Rows of the untouched finger, each the mean over a part of the time that it was left alone, once that was
/// asked for and is over.
std::vector<NewRow> Session::watchRest(const Sample& sample) {
  const double most = kGoals.atRest * config_.gauges.noise_strain;
  const auto far = [&] {
    return (sample.strains - restSum_ / static_cast<double>(resting_.size())).cwiseAbs().maxCoeff() > most;
  };
  if (!resting_.empty() && far()) {
    resting_.clear();
    farGauge_.reset();
  }
  if (resting_.empty()) restSum_ = VectorXd::Zero(sample.strains.size());
  resting_.push_back(sample);
  restSum_ += sample.strains;
  if (atRest_s() < kGoals.untouched_s) return {};
  const std::vector<Sample> rested = std::exchange(resting_, {});
  Eigen::Index worst = 0;
  const VectorXd mean = restSum_ / static_cast<double>(rested.size());
  const double off = mean.cwiseAbs().maxCoeff(&worst);
  if (off > kGoals.farZero * config_.tolerance.zero_strain) {
    farGauge_ = static_cast<int>(worst);
    return {};
  }
  if (advice().kind != Advice::Kind::kLeaveAlone) return {};
  std::vector<NewRow> rows;
  const auto parts = static_cast<std::size_t>(kGoals.untouchedRows);
  for (std::size_t part = 0; part < parts; ++part) {
    const std::size_t begin = part * rested.size() / parts, end = (part + 1) * rested.size() / parts;
    if (begin == end) continue;
    VectorXd sum = VectorXd::Zero(sample.strains.size());
    for (std::size_t i = begin; i < end; ++i) sum += rested[i].strains;
    rows.push_back({rested[begin].time_s, sum / static_cast<double>(end - begin), {std::nullopt, 0, 0}});
  }
  return rows;
}

/// The mean of what is held; else why there is none.
std::optional<Sample> Session::nowHeld(std::string& why) const {
  const config::Gauges& gauges = config_.gauges;
  if (recent_.size() < static_cast<std::size_t>(kHolds.leastSets)) {
    why = "no readings come";
    return std::nullopt;
  }
  VectorXd mean = VectorXd::Zero(gauges.count), squares = VectorXd::Zero(gauges.count);
  for (const Sample& sample : recent_) mean += sample.strains / static_cast<double>(recent_.size());
  for (const Sample& sample : recent_)
    squares += (sample.strains - mean).cwiseAbs2() / static_cast<double>(recent_.size());
  const double peak = mean.cwiseAbs().maxCoeff();
  if (peak < kThinning.weakest * gauges.noise_strain)
    why = "nothing presses the finger, or too little";
  else if (config::isOverRange(gauges, peak))
    why = "it is pressed beyond its range";
  else if (std::sqrt(squares.maxCoeff()) > std::max(kHolds.noise * gauges.noise_strain, kHolds.share * peak))
    why = "it is not held still";
  return why.empty() ? std::optional(Sample{recent_.back().time_s, mean}) : std::nullopt;
}

int Session::peakGauge() const {
  Eigen::Index gauge = 0;
  if (!recent_.empty()) recent_.back().strains.cwiseAbs().maxCoeff(&gauge);
  return static_cast<int>(gauge);
}

std::optional<int> Session::farGauge() const {
  const Advice::Kind kind = advice().kind;
  const bool isAskedFor = kind == Advice::Kind::kPress || kind == Advice::Kind::kMark;
  return isFaulty_ || isAskedFor || isPressed() ? std::nullopt : farGauge_;
}

/// What was held last still is.
bool Session::isPressed() const {
  return pressed_ && !recent_.empty() && isOfTouch(recent_.back().strains, *pressed_);
}

/// Why what was entered can hardly be meant; empty where it can, as what is entered twice of one touch.
std::string Session::doubtOf(const KnownTouch& known, const VectorXd& strains) const {
  const KnownTouch doubted =
      doubted_ && isOfTouch(strains, doubted_->strains) ? doubted_->known : KnownTouch{};
  if (known.normal_n_per_m && known.normal_n_per_m != doubted.normal_n_per_m)
    return doubtOfLoad(*known.normal_n_per_m, strains);
  if (known.angle_deg && known.angle_deg != doubted.angle_deg) return doubtOfAngle(*known.angle_deg, strains);
  return {};
}

std::string Session::doubtOfLoad(double said_n_per_m, const VectorXd& strains) const {
  if (!calibration::isOfAnotherUnit(search_, strains, said_n_per_m)) return {};
  return fmt::format(
      "a finger as in the config reads so under about {:.3g} N/m. Look at the load's unit, finger.length_m "
      "and finger.shear_modulus_pa, and enter it again; the same load is taken then",
      search_.guess(strains)[calibration::kNormalLoad]);
}

/// As the ring is turned by the newest fit.
std::string Session::doubtOfAngle(double said_deg, const VectorXd& strains) const {
  const auto drawn_deg = calibration::placeRead_deg(search_, strains);
  if (!drawn_deg) return {};
  const double read_deg = *drawn_deg + (fit_ ? fit_->result->turn_deg() : 0);
  const double most_deg = std::max(kHolds.elsewhere_deg, kHolds.elsewhere * errors_.angle_deg);
  if (std::abs(std::remainder(said_deg - read_deg, 360)) <= most_deg) return {};
  return fmt::format(
      "the readings say about {:.0f} deg. Look at the mark, gauges.first_angle_deg and the order of the "
      "gauges, and enter it again; the same angle is taken then",
      withinATurn_deg(read_deg));
}

Obeyed Session::keepHeld(const KnownTouch& known, const std::string& what) {
  std::string why;
  const bool wasHeld = held_.has_value();
  const auto sample = wasHeld ? std::exchange(held_, std::nullopt) : nowHeld(why);
  if (!sample)
    return {.message = fmt::format("{} was not taken: {}. Press, hold still, and enter it again", what, why),
            .isRefused = true};
  if (const std::string doubt = doubtOf(known, sample->strains); !doubt.empty()) {
    doubted_ = {sample->time_s, sample->strains, known};
    if (wasHeld) held_ = sample;
    return {.message = what + " was not taken: " + doubt, .isRefused = true};
  }
  doubted_.reset();
  pressed_ = sample->strains;
  const NewRow row{sample->time_s, sample->strains, known};
  keep(row);
  knowsOther_ = true;
  return {.row = row, .message = what + " is taken"};
}

Obeyed Session::obeyLoad(double normal_n_per_m) {
  return keepHeld({std::nullopt, normal_n_per_m, std::nullopt},
                  fmt::format("the load of {:.4g} N/m", normal_n_per_m));
}

Obeyed Session::obeyAngle(double angle_deg) {
  return keepHeld({angle_deg, std::nullopt, std::nullopt}, fmt::format("the angle of {:.4g} deg", angle_deg));
}

Obeyed Session::obeyHold() {
  std::string why;
  held_ = nowHeld(why);
  doubted_.reset();
  if (held_) pressed_ = held_->strains;
  return {.message = held_ ? "held" : why + ": press the finger, hold it still and repeat the command",
          .isRefused = !held_.has_value()};
}

Obeyed Session::obeySkip() {
  const Advice::Kind kind = advice().kind;
  if (kind == Advice::Kind::kPress) {
    unavailable_.loads = true;
    return {.message = coverage_.loads > 0 ? "the unit of force is what the loads tell that were taken"
                                           : "without known loads the unit of force is the drawing's"};
  }
  if (kind == Advice::Kind::kMark) {
    unavailable_.directions = true;
    return {.message = coverage_.directions_deg.empty()
                           ? "without known directions a ring that is turned or reversed is not noticed"
                           : "the zero of the angle is what the marks tell that were taken"};
  }
  return {.message = "this cannot be skipped: q ends the session", .isRefused = true};
}

/// What the user said last, by the row that it is of.
Obeyed Session::obeyUndo() {
  for (std::size_t row = rows_.size(); row-- > 0;) {
    KnownTouch& known = rows_.known[row];
    const bool wasSaid = known.angle_deg || (known.normal_n_per_m && !known.isUntouched());
    if (!wasSaid) continue;
    std::string what = known.angle_deg ? fmt::format("the angle of {:.4g} deg", *known.angle_deg) : "";
    if (known.normal_n_per_m)
      what += fmt::format("{}the load of {:.4g} N/m", what.empty() ? "" : " and ", *known.normal_n_per_m);
    if (row < firstRow_) what += ", of an earlier session,";
    known = {};
    coverage_ = coverageOf(config_.gauges, search_, rows_);
    fit_.reset();
    complaint_.clear();
    isFaulty_ = false;
    knowsOther_ = isFitOutdated_ = true;
    return {.message = what + " is taken back", .takenBack = true};
  }
  return {.message = "no load and no angle was entered yet", .isRefused = true};
}

/// Rows that are there were read with the zero that the finger had then.
Obeyed Session::obeyMayTare() const {
  if (rows_.size() == 0) return {};
  return {.message =
              "not zeroed: the rows that were collected have the old zero. To begin anew, quit, "
              "`strainfinger tare`, and give another -o",
          .isRefused = true};
}

Obeyed Session::obeyTare() {
  Obeyed obeyed = obeyMayTare();
  if (!obeyed.isRefused) obeyed = {.message = "zeroing", .tare = true};
  return obeyed;
}

Obeyed Session::obey(const Command& command) {
  struct Visitor {
    Session& session;
    Obeyed operator()(const LoadIs& load) const { return session.obeyLoad(load.normal_n_per_m); }
    Obeyed operator()(const AngleIs& angle) const { return session.obeyAngle(angle.angle_deg); }
    Obeyed operator()(const Hold&) const { return session.obeyHold(); }
    Obeyed operator()(const Tare&) const { return session.obeyTare(); }
    Obeyed operator()(const MayTare&) const { return session.obeyMayTare(); }
    Obeyed operator()(const Skip&) const { return session.obeySkip(); }
    Obeyed operator()(const Undo&) const { return session.obeyUndo(); }
    Obeyed operator()(const Quit&) const { return {.quit = true}; }
    Obeyed operator()(const Unclear& unclear) const { return {.message = unclear.why, .isRefused = true}; }
  };
  return std::visit(Visitor{*this}, command);
}

bool Session::wantsFit() const {
  const auto touches = rows_.size() - static_cast<std::size_t>(coverage_.untouched);
  const bool isCovered =
      std::ranges::all_of(coverage_.touches, [this](int of) { return of >= kGoals.leastPerArc; });
  const int perGauge = isCovered || tried_ > 0 ? kFits.firstPerGauge : kFits.uncoveredPerGauge;
  const auto least = static_cast<std::size_t>(perGauge * config_.gauges.count);
  if (touches < least) return false;
  return tried_ == 0 || knowsOther_ ||
         static_cast<double>(rows_.size()) >= kFits.growth * static_cast<double>(tried_);
}

const Rows& Session::beginFit() {
  tried_ = rows_.size();
  knowsOther_ = isFitOutdated_ = false;
  return rows_;
}

void Session::takeFit(FitOutcome outcome) {
  if (isFitOutdated_) return;
  complaint_ = outcome.complaint;
  isFaulty_ = outcome.isOfFaults;
  if (isFaulty_) fit_.reset();
  if (outcome.result) fit_ = std::move(outcome);
}

Advice Session::advice() const {
  if (isFaulty_) return {Advice::Kind::kMend};
  return nextAdvice(config_.gauges, coverage_, fit_ ? fit_->assessment : std::nullopt, unavailable_);
}

}  // namespace strainfinger::session
