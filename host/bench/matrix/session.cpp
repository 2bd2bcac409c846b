#include "host/bench/matrix/session.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "common/fixed_real.hpp"
#include "firmware/core/estimate.hpp"
#include "host/base/angles.hpp"
#include "host/evidence/accuracy.hpp"
#include "host/evidence/uniform.hpp"
#include "host/simulation/built_finger.hpp"
#include "host/simulation/gauge_fault.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::bench {
namespace {

constexpr double kSetsPerSecond = 1000, kHum_hz = 50;
constexpr double kGluedTo = 0.3;     ///< part of its neighbour that a badly glued gauge feels
constexpr double kRail_strain = 10;  ///< beyond every converter's range
constexpr int kSpikeEvery = 20;      ///< sample sets
constexpr double kNear_pitch = 2;    ///< touches are within so much of a failed gauge
constexpr std::uint64_t kSetsPerSession = std::uint64_t{1} << 24, kTouchesPerSession = 64;

/// What is drawn of a session: by gauge, by touch (kPlace, kTremblePhase), by sample set (kNoise).
enum Drawn : std::uint32_t {
  kGain,
  kZero,
  kDrift,
  kHumShare,
  kHumPhase,
  kFailed,
  kPlace,
  kSpike,
  kNoise,
  kTremblePhase
};
constexpr std::uint64_t kDraws = 16;

config::FingerConfig fingerOf(const Disturbance& disturbance, std::uint64_t number) {
  return disturbance.isBuiltAnew ? fingerAsBuilt(static_cast<int>(number) + 1) : disturbance.actual;
}

/// What a calibration by thousands of touches comes near: the finger's own core, Poisson's ratio, and each
/// gauge's angle, depth and gain. What the tables can't tell of depths they add to the model error.
config::FingerConfig calibrated(const config::FingerConfig& finger) {
  constexpr double kModelError = 0.0005;  // at most what `calibrate` writes for such fingers (host/study)
  const simulation::BuiltFinger built = simulation::builtFinger(finger);
  config::FingerConfig told = perfectFinger();
  told.gauges.model_error = kModelError;
  told.finger.core_radius_m = built.annulus.core_radius_m;
  told.finger.poisson_ratio = built.annulus.poisson_ratio;
  for (int i = 0; i < told.gauges.count; ++i) {
    const model::PlacedGauge drawn = told.drawn(i), real = built.gauges[static_cast<std::size_t>(i)];
    told.calibration.angle_offset_deg.push_back((real.angle_rad - drawn.angle_rad) / kRadPerDeg);
    told.calibration.depth_offset_m.push_back(drawn.radius_m - real.radius_m);
    told.calibration.gain.push_back(real.gain);
  }
  return told;
}

struct ToldContact {
  double angle_rad, sigmaAngle_rad;
  double normal, sigmaNormal, tangential, sigmaTangential;
};

ToldContact toldContact(const Contact& contact) {
  constexpr double kTurn = 2 * std::numbers::pi;
  return {toReal(contact.angle) * kTurn, toReal(contact.sigmaAngle) * kTurn, toReal(contact.normal),
          toReal(contact.sigmaNormal),   toReal(contact.tangential),         toReal(contact.sigmaTangential)};
}

double apart_rad(const ToldContact& told, const simulation::Touch& truth) {
  return std::abs(shortWay_rad(told.angle_rad, truth.angle_rad));
}

bool isBeyond(const ToldContact& told, const simulation::Touch& truth) {
  constexpr double kSigmas = evidence::Accuracy::kFarSigmas;
  return apart_rad(told, truth) > kSigmas * told.sigmaAngle_rad ||
         std::abs(told.normal - truth.normal_n_per_m) > kSigmas * told.sigmaNormal ||
         std::abs(told.tangential - truth.tangential_n_per_m) > kSigmas * told.sigmaTangential;
}

}  // namespace

Session::Session(const Disturbance& disturbance, const TableImage& tables, std::uint64_t seed,
                 std::uint64_t number)
    : disturbance_(disturbance),
      finger_(fingerOf(disturbance, number)),
      ring_(finger_, seed),
      touches_(finger_.gauges, disturbance.touches, seed),
      draws_(seed + 1),
      number_(number),
      pipeline_(tables, firmware::FitMode::kRefined),
      failed_(static_cast<int>((draw(kFailed) + 0.5) * finger_.gauges.count) % finger_.gauges.count) {}

/// Even in -1/2 .. 1/2.
double Session::draw(std::uint32_t what, int gauge) const {
  return evidence::uniform(draws_, number_ * kDraws + what, 2 * static_cast<std::uint32_t>(gauge % 16));
}

void Session::rest(int sets) {
  for (int i = 0; i < sets; ++i) sample({}, i);
}

void Session::leaveUntouched(Tally& tally) {
  ++tally.touches;
  tally.ghosts += ghost_;
}

Session::Pressing Session::pressing(const simulation::Touch& touch, int start_set) const {
  return {touch, ring_.exact(touch), start_set};
}

std::vector<Session::Pressing> Session::drawTouch() {
  simulation::Touch touch = touches_.at(number_ * kTouchesPerSession + static_cast<std::uint64_t>(touched_));
  const double pitch_rad = 2 * std::numbers::pi / finger_.gauges.count;
  if (disturbance_.failure != Failure::kNone)
    touch.angle_rad =
        finger_.gauges.angle_rad(failed_) + 2 * kNear_pitch * pitch_rad * draw(kPlace, touched_);
  if (!disturbance_.second) return {pressing(touch, 0)};
  const SecondContact& second = *disturbance_.second;
  simulation::Touch other = touch;
  other.angle_rad += second.apart_pitch * pitch_rad;
  other.normal_n_per_m *= second.ratio;
  other.tangential_n_per_m *= second.ratio;
  return {pressing(touch, std::max(-second.later_sets, 0)), pressing(other, std::max(second.later_sets, 0))};
}

Eigen::VectorXd Session::pressed(Pressings pressings, int set) const {
  Eigen::VectorXd readings = Eigen::VectorXd::Zero(finger_.gauges.count);
  const bool isMoving = disturbance_.motion.slides_m_per_s != 0;
  for (const Pressing& each : pressings)
    readings += isMoving ? ring_.exact(movedTouch(each, set)) : loadShare(each, set) * each.exact;
  return readings;
}

/// Of its mean loads, in this sample set.
double Session::loadShare(const Pressing& pressing, int set) const {
  const Motion& motion = disturbance_.motion;
  const double turns = motion.trembles_hz * set / kSetsPerSecond + draw(kTremblePhase, touched_);
  return std::clamp((set + 1.0 - pressing.start_set) / disturbance_.rise_sets, 0.0, 1.0) *
         (1 + motion.trembling * std::sin(2 * std::numbers::pi * turns));
}

simulation::Touch Session::movedTouch(const Pressing& pressing, int set) const {
  simulation::Touch touch = pressing.touch;
  touch.angle_rad +=
      disturbance_.motion.slides_m_per_s * set / kSetsPerSecond / finger_.finger.outer_radius_m;
  touch.normal_n_per_m *= loadShare(pressing, set);
  touch.tangential_n_per_m *= loadShare(pressing, set);
  return touch;
}

void Session::disturb(Eigen::VectorXd& readings) const {
  const double time_s = static_cast<double>(set_) / kSetsPerSecond;
  const double hum = disturbance_.hum.amplitude_strain *
                     std::sin(2 * std::numbers::pi * (kHum_hz * time_s + draw(kHumPhase)));
  const auto normal = [&](Drawn what, Eigen::Index gauge) {
    return draws_.at(number_ * kDraws + what, static_cast<std::uint32_t>(gauge));
  };
  for (Eigen::Index i = 0; i < readings.size(); ++i) {
    const double share = disturbance_.hum.isEven ? 1 : draw(kHumShare, static_cast<int>(i)) + 0.5;
    readings[i] *= 1 + disturbance_.gainSpread * normal(kGain, i);
    readings[i] += disturbance_.zeroSpread_strain * normal(kZero, i) +
                   disturbance_.drift_strain_per_s * time_s * normal(kDrift, i) +
                   disturbance_.commonDrift_strain_per_s * time_s + share * hum;
  }
  if (disturbance_.spike_strain != 0 && set_ % kSpikeEvery == 0) {
    const auto spiked = static_cast<Eigen::Index>(set_ / kSpikeEvery) * 7 % readings.size();
    readings[spiked] += disturbance_.spike_strain;
  }
}

void Session::fail(Eigen::VectorXd& readings) const {
  const Eigen::Index next = (failed_ + 1) % readings.size();
  switch (disturbance_.failure) {
    case Failure::kTwoDead:
      readings[next] = 0;
      [[fallthrough]];
    case Failure::kDead:
      readings[failed_] = 0;
      return;
    case Failure::kOpen:
      readings[failed_] = kRail_strain;
      return;
    case Failure::kNoisy:
      readings[failed_] += simulation::GaugeFault::kNoisier * finger_.gauges.noise_strain *
                           draws_.at(number_ * kSetsPerSession + set_, kNoise);
      return;
    case Failure::kSwapped:
      std::swap(readings[failed_], readings[next]);
      return;
    case Failure::kBadGlue:
      readings[failed_] += kGluedTo * readings[next];
      return;
    case Failure::kGain:
      readings[failed_] *= disturbance_.failedGain;
      return;
    case Failure::kStuck:
    case Failure::kNone:
      return;
  }
}

bool Session::isHealthy(int gauge) const {
  if (disturbance_.failure == Failure::kNone) return true;
  const bool withNext =
      disturbance_.failure == Failure::kTwoDead || disturbance_.failure == Failure::kSwapped;
  return gauge != failed_ && !(withNext && gauge == (failed_ + 1) % finger_.gauges.count);
}

void Session::sample(Pressings pressings, int set) {
  Eigen::VectorXd readings = pressed(pressings, set);
  disturb(readings);
  fail(readings);
  std::vector<std::uint16_t> codes = ring_.codes(readings, number_ * kSetsPerSession + set_++);
  if (firstCodes_.empty()) firstCodes_ = codes;
  const auto failed = static_cast<std::size_t>(failed_);
  if (disturbance_.failure == Failure::kStuck) codes[failed] = firstCodes_[failed];
  const bool isTouched = pipeline_.process(codes).touched;
  if (pressings.empty() && set >= kSettled_sets) ghost_ |= isTouched;
}

void Session::touch(Tally& tally) {
  const std::vector<Pressing> pressings = drawTouch();
  ++touched_;
  tally.ghosts += ghost_;
  for (int set = 0; set < disturbance_.touched_sets; ++set) sample(pressings, set);
  std::vector<simulation::Touch> truths;
  for (const Pressing& each : pressings) truths.push_back(movedTouch(each, disturbance_.touched_sets - 1));
  judge(truths, tally);
  ghost_ = false;
}

void Session::judge(std::span<const simulation::Touch> truths, Tally& tally) const {
  ++tally.touches;
  const firmware::Observation& seen = pipeline_.observation();
  bool blamed = false;
  for (int i = 0; i < finger_.gauges.count; ++i)
    blamed |= firmware::contains(seen.outOfUse, i) && isHealthy(i);
  tally.blamed += blamed;
  if (!seen.touched) {
    ++tally.missed;
    return;
  }
  const int contacts = pipeline_.answer().solution.hypothesis.contacts;
  bool isFlagged = seen.tooFewGauges || (seen.several && contacts == 1);
  bool isFar = false, isBeyondSigmas = false;
  std::vector<bool> found(truths.size());
  const double half_rad = std::numbers::pi / finger_.gauges.count;
  for (int i = 0; i < contacts; ++i) {
    const Contact contact = estimate(pipeline_.constants(), pipeline_.answer(),
                                     firmware::unitErrors(pipeline_.linearisation()), i);
    isFlagged |= contact.uncertain;
    const ToldContact told = toldContact(contact);
    const auto nearest =
        std::ranges::min_element(truths, {}, [&](const auto& truth) { return apart_rad(told, truth); });
    isFar |= apart_rad(told, *nearest) > half_rad;
    isBeyondSigmas |= isBeyond(told, *nearest);
    if (apart_rad(told, *nearest) <= half_rad)
      found[static_cast<std::size_t>(nearest - truths.begin())] = true;
  }
  const bool all = std::all_of(found.begin(), found.end(), [](bool each) { return each; });
  tally.flagged += isFlagged;
  tally.silent += isFar && !isFlagged;
  tally.beyond += isBeyondSigmas && !isFlagged;
  tally.located += all && contacts == static_cast<int>(truths.size()) && !isFlagged;
}

Tally tallyOf(const Disturbance& disturbance, int touches, std::uint64_t seed) {
  Tally tally;
  const TableImage shared = tables::buildTableImage(disturbance.told);
  const int wanted = std::max(touches / disturbance.rarer, 1);
  for (std::uint64_t number = 0; tally.touches < wanted; ++number) {
    std::optional<TableImage> own;
    if (disturbance.isCalibrated) own = tables::buildTableImage(calibrated(fingerOf(disturbance, number)));
    Session session(disturbance, own ? *own : shared, seed, number);
    session.rest(Session::kFirstRest_sets);
    if (disturbance.isUntouched) {
      session.rest(disturbance.touched_sets);
      session.leaveUntouched(tally);
      continue;
    }
    for (int i = 0; i < Session::kTouches && tally.touches < wanted; ++i) {
      session.touch(tally);
      session.rest(disturbance.rest_sets);
    }
  }
  return tally;
}

}  // namespace strainfinger::bench
