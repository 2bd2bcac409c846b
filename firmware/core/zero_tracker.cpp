#include "firmware/core/zero_tracker.hpp"

#include <algorithm>
#include <bit>

#include "firmware/core/detect.hpp"

namespace strainfinger::firmware {
namespace {

constexpr int kTakenBits = 7;  ///< [log2] sample sets averaged in an interval
static_assert(ZeroTracker::kInterval == ZeroTracker::kEvery << kTakenBits);

/// [log2] Averages are taken for a contact's if one contact leaves less than this part of their energy.
constexpr int kContactBits = 4;
/// Averages whose energy is below so many of a reading's variances are left alone: their shape says too
/// little.
constexpr int kWorthFollowing = 3;
/// A gauge reads nothing if its average is within so many standard deviations of a reading: a zero that is so
/// far off makes no contact by itself, and is followed.
constexpr Number kCalm = 2;
/// [log2] Contacts rest while they turn by no more than this part of a pitch and their loads change by no
/// more than this part of the normal load.
constexpr int kTurnBits = 2;
constexpr int kLoadBits = 2;

/// [log2] What far gauges change by in common is followed from this part of a reading's standard deviation
/// on, almost three times the error of such a change of eight gauges. Less would add up to a walk of the
/// zeros.
constexpr int kCommonBits = 3;
/// Fewer far gauges than this don't say what all have in common.
constexpr int kLeastFar = 3;

/// A difference of strains as one of codes * 2^15.
std::int32_t codeOf(std::int32_t strain_q32, std::int32_t gain) {
  return gain > 0 ? static_cast<std::int32_t>((std::int64_t{strain_q32} << 32) / gain) : 0;
}

}  // namespace

void ZeroTracker::begin(bool touched) {
  sum_.fill(0);
  sets_ = 0;
  leftOut_ = 0;
  starts_ = 0;
  isFitNext_ = false;
  touched_ = touched;
}

bool ZeroTracker::rests(const TableConstants& constants, const Answer& answer) const {
  if (answer.solution.hypothesis.contacts != rest_.contacts) return false;
  const std::uint32_t near_q32 = pitch_q32(constants) >> kTurnBits;
  const ContactStates before = rescaled(rest_.contact, rest_.shift, answer.shift);
  for (int k = 0; k < rest_.contacts; ++k) {
    const ContactState &was = before[index(k)], &is = answer.solution.contact[index(k)];
    if (apart_q32(is.angle_q32, was.angle_q32) > near_q32) return false;
    const Number most = was.normal >> kLoadBits;
    if (magnitude(is.normal - was.normal) > most || magnitude(is.tangential - was.tangential) > most)
      return false;
  }
  return true;
}

ScaledReadings ZeroTracker::averages(const TableConstants& constants, GaugeSet gauges) const {
  ScaledReadings readings = scaledReadings(constants, std::span(sum_).first(constants.gauge_count), gauges);
  readings.weight_q14 = kAllAlike;  // drift is no error of the model
  return readings;
}

/// The averages have so much energy that their shape says where it comes from.
bool ZeroTracker::isWorthFollowing(const TableConstants& constants, GaugeSet gauges) const {
  constexpr int kDown = 4;  // keeps the sum below 2^63
  const Number noise = readingNoise_q32(constants) >> kDown;
  Wide energy = 0;
  for (int i = 0; i < constants.gauge_count; ++i)
    if (contains(gauges, i)) energy += squareOf(sum_[index(i)] >> kDown);
  return energy > kWorthFollowing * squareOf(noise);
}

GaugeSet ZeroTracker::calmGauges(const TableConstants& constants) const {
  const Number most = kCalm * readingNoise_q32(constants);
  GaugeSet calm = 0;
  for (int i = 0; i < constants.gauge_count; ++i)
    if (magnitude(sum_[index(i)]) <= most) calm |= GaugeSet{1} << i;
  return calm;
}

void ZeroTracker::findStart(const TableImage& tables, GaugeSet gauges, Linearisation& scratch) {
  const Hypothesis hypothesis = oneContact(tables.constants, gauges);
  std::optional<std::uint32_t> otherStart_q32;
  if (starts_ > 0) otherStart_q32 = start_.angle_q32;
  start_ = initialGuess(tables, hypothesis, averages(tables.constants, gauges), scratch, otherStart_q32)[0];
  ++starts_;
}

bool ZeroTracker::looksLikeAContact(const TableImage& tables, GaugeSet gauges, Linearisation& scratch) const {
  const ScaledReadings readings = averages(tables.constants, gauges);
  Wide energy = 0;
  for (int i = 0; i < tables.constants.gauge_count; ++i)
    if (contains(gauges, i)) energy += squareOf(readings.value[index(i)]);
  const Solution solution =
      fit(tables, oneContact(tables.constants, gauges), {start_}, readings, kMostSteps, scratch);
  return isAdmissible(tables.constants, solution) && solution.residualEnergy < energy >> kContactBits;
}

/// Gauges that no contact reaches.
GaugeSet ZeroTracker::farGauges(const TableImage& tables) const {
  GaugeSet far = 0;
  for (int i = 0; i < tables.constants.gauge_count; ++i) {
    const bool isReached =
        std::any_of(rest_.contact.begin(), rest_.contact.begin() + rest_.contacts,
                    [&](const ContactState& contact) { return isInReach(tables, contact, i); });
    if (!isReached) far |= GaugeSet{1} << i;
  }
  return far;
}

/// By how much far gauges changed, in the mean, since the contacts came to rest, without what the contacts
/// themselves make them read.
std::int32_t ZeroTracker::commonChange_q32(GaugeSet far) {
  const GaugeSet both = far & known_;
  Wide sum = 0;
  for (int i = 0; i < kMaxGauges; ++i) {
    if (contains(both, i)) {
      sum += Wide{sum_[index(i)]} - before_[index(i)];
    } else if (contains(far, i)) {
      before_[index(i)] = sum_[index(i)];
    }
  }
  known_ |= far;
  return std::popcount(both) < kLeastFar
             ? 0
             : limited(sum / std::popcount(both), std::numeric_limits<Number>::max());
}

/// All zeros follow by the same part of their changes, so that what is left keeps its shape: that of no
/// contact.
void ZeroTracker::follow(const TableConstants& constants, const Strains& changes_q32, GaugeSet gauges,
                         Calibration& calibration) {
  const Number limit = readingNoise_q32(constants);
  Number most = 0;
  for (int i = 0; i < constants.gauge_count; ++i)
    if (contains(gauges, i)) most = larger(most, magnitude(changes_q32[index(i)]));
  const Number part_q15 = limit < most ? static_cast<Number>((Wide{limit} << 15) / most) : 1 << 15;
  for (int i = 0; i < constants.gauge_count; ++i) {
    if (!contains(gauges, i)) continue;
    const auto change = static_cast<std::int32_t>(Wide{changes_q32[index(i)]} * part_q15 >> 15);
    std::int32_t& zero = calibration.zero_q15[index(i)];
    zero = static_cast<std::int32_t>(
        std::clamp<std::int64_t>(std::int64_t{zero} + codeOf(change, calibration.gain[index(i)]), 0,
                                 std::numeric_limits<std::int32_t>::max()));
  }
  lastChange_q32_ = std::min(most, limit);
}

/// Returns false if the rest has to wait for a later sample set.
bool ZeroTracker::finish(const TableImage& tables, bool touched, Calibration& calibration,
                         Linearisation& scratch) {
  const GaugeSet gauges = allGauges(tables.constants.gauge_count) & ~leftOut_;
  if (touched) {
    const std::int32_t change_q32 = commonChange_q32(farGauges(tables) & gauges);
    const Number least = readingNoise_q32(tables.constants) >> kCommonBits;
    Strains changes;
    changes.fill(magnitude(change_q32) < least ? 0 : change_q32);
    follow(tables.constants, changes, allGauges(tables.constants.gauge_count), calibration);
    calm_ = 0;
    return true;
  }
  if (isWorthFollowing(tables.constants, gauges)) {
    isFitNext_ = !isFitNext_;
    if (isFitNext_) {
      findStart(tables, gauges, scratch);
      return false;
    }
    calm_ = 0;
    if (looksLikeAContact(tables, gauges, scratch)) return true;
    if (starts_ < kMostStarts) return false;
    follow(tables.constants, sum_, gauges, calibration);
  }
  calm_ = calmGauges(tables.constants);
  age_sets_ = 0;
  return true;
}

void ZeroTracker::interrupt(bool touched) {
  begin(touched);
  rest_ = {};
}

/// While touched, each set's residual: the loads may change within an interval.
void ZeroTracker::add(std::span<const std::int32_t> strains_q32, const Locator* locator) {
  constexpr std::int32_t kHalf = 1 << (kTakenBits - 1);
  if (locator == nullptr) {
    for (std::size_t i = 0; i < strains_q32.size(); ++i) sum_[i] += (strains_q32[i] + kHalf) >> kTakenBits;
    return;
  }
  constexpr Number kMost = (1 << (31 - kTakenBits)) - 1;  // keeps the sum below 2^31
  const auto& predicted = locator->linearisation().predicted;
  const int shift = locator->answer().shift;
  const Number half = 1 << shift >> 1;
  for (std::size_t i = 0; i < strains_q32.size(); ++i)
    sum_[i] += shifted(((strains_q32[i] + half) >> shift) - predicted[i], shift - kTakenBits, kMost);
}

bool ZeroTracker::average(const TableImage& tables, std::span<const std::int32_t> strains_q32,
                          const Locator* locator, Calibration& calibration, Linearisation& scratch) {
  const bool touched = locator != nullptr;
  if (touched && !rests(tables.constants, locator->answer())) {
    const Answer& answer = locator->answer();
    begin(true);
    known_ = 0;
    rest_ = {answer.solution.hypothesis.contacts, answer.shift, answer.solution.contact};
    return false;
  }
  if (sets_ <= kInterval) add(strains_q32, locator);
  if (sets_ < kInterval || !finish(tables, touched, calibration, scratch)) return false;
  begin(touched);
  return true;
}

}  // namespace strainfinger::firmware
