#include "firmware/core/zero_tracker.hpp"

#include <algorithm>
#include <cstdlib>

#include "firmware/core/detect.hpp"
#include "firmware/core/drift_products.hpp"

namespace strainfinger::firmware {
namespace {

static_assert(ZeroTracker::kInterval / ZeroTracker::kEvery == kAveraged);

/// A touch that changes by this part of itself, as a power of two, has moved.
constexpr int kMovedShift = 6;

GaugeSet windowOf(const Problem& problem, const View& view) {
  GaugeSet window = 0;
  for (int step = -kWindowReach; step <= kWindowReach; ++step) window |= 1u << gaugeAt(problem, view, step);
  return window;
}

/// Drift that all gauges share: alike, or one side more than the other. Three patterns round the ring
/// [* 2^14].
Three patternsAt(const TableConstants& constants, int gauge) {
  const auto turn = static_cast<std::uint32_t>(turnTo(gauge, constants.pitch_turn_q35));  // wraps
  const auto sine = [](std::uint32_t turn_q32) {
    return sine_q14(static_cast<std::int32_t>(turn_q32) >> 17);
  };
  return {1 << 14, sine(turn + (1u << 30)), sine(turn)};
}

/// The window of a contact, and its three ways of changing it.
struct Ways {
  const Problem& problem;
  View view;
  Tangent tangent;

  [[gnu::noinline]] std::int32_t weight(int step, std::size_t way) const {
    const int sign = view.side > 0 ? 1 : problem.mirrorSign();
    if (std::abs(step) <= kWindowReach) return sign * tangent.at[indexOf(step)][way];
    return (step > 0 ? sign : -sign) * overRootTwo(tangent.at[indexOf(kOuterReach)][way]);
  }
  int reach() const { return fitReach(problem.gauges()); }
  std::size_t gauge(int step) const { return static_cast<std::size_t>(gaugeAt(problem, view, step)); }

  /// Components along the ways of what `at(gauge)` gives.
  template <typename At>
  Three along(At at) const {
    AlongWays ways;
    for (int step = -reach(); step <= reach(); ++step)
      for (std::size_t way = 0; way < 3; ++way) ways.add(way, weight(step, way), at(gauge(step)));
    return ways.components();
  }
};

/// Least squares of changes in terms of the shared patterns, whatever a contact has changed: what lies along
/// its ways counts for nothing. Zero where the gauges don't tell.
Three sharedDrift(const Ways& ways, std::span<const std::int32_t> changes_q32, const Three& changeAlong,
                  const std::array<Three, 3>& patternAlong) {
  PatternSums sums;
  for (std::size_t gauge = 0; gauge < changes_q32.size(); ++gauge)
    sums.add(patternsAt(ways.problem.tables.constants, static_cast<int>(gauge)), changes_q32[gauge]);
  sums.takeOut(patternAlong, changeAlong);
  const int gauges = ways.problem.gauges();
  Symmetric inverse;
  if (!invert(sums.matrix_q24(gauges), inverse)) return {};
  return product_q12(inverse, sums.changes(gauges));
}

/// Splits changes into what a contact has done, which is taken out of them, and drift. Returns the squared
/// length of the contact's part.
std::int64_t takeOutContact(const Ways& ways, std::span<std::int32_t> changes_q32) {
  const auto patternOf = [&](std::size_t i) {
    return ways.along([&](std::size_t gauge) {
      return patternsAt(ways.problem.tables.constants, static_cast<int>(gauge))[i];
    });
  };
  const std::array patternAlong{patternOf(0), patternOf(1), patternOf(2)};
  Three contact = ways.along([&](std::size_t gauge) { return changes_q32[gauge]; });
  const Three shared = sharedDrift(ways, changes_q32, contact, patternAlong);
  std::int64_t square = 0;
  for (std::size_t way = 0; way < 3; ++way) {
    contact[way] = withoutDrift(contact[way], patternAlong, way, shared);
    square += squareOf(contact[way]);
  }
  for (int step = -ways.reach(); step <= ways.reach(); ++step) {
    std::int32_t& change = changes_q32[ways.gauge(step)];
    change =
        withoutContact(change, {ways.weight(step, 0), ways.weight(step, 1), ways.weight(step, 2)}, contact);
  }
  return square;
}

/// Squared length of the readings of a window.
std::int64_t squareIn(GaugeSet window, std::span<const std::int32_t> strains_q32) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < strains_q32.size(); ++i)
    if (contains(window, static_cast<int>(i))) sum += squareOf(strains_q32[i]);
  return sum;
}

}  // namespace

void ZeroTracker::begin(bool touched) {
  sum_.fill(0);
  sets_ = doubts_ = 0;
  leftOut_ = 0;
  if (touched != touched_) resting_ = false;
  touched_ = touched;
}

void ZeroTracker::add(std::span<const std::int32_t> strains_q32) {
  for (std::size_t i = 0; i < strains_q32.size(); ++i) sum_[i] += summand(strains_q32[i]);
}

void ZeroTracker::doubt(bool touched) {
  if (++doubts_ >= kConvinced) begin(touched);
}

void ZeroTracker::move(std::size_t gauge, std::int32_t by_q32, Calibration& calibration) {
  std::int32_t& zero = calibration.zero_q15[gauge];
  zero = followedZero(zero, by_q32, calibration.gain[gauge]);
  lastChange_q32_ = std::max(lastChange_q32_.value_or(0), absolute(by_q32));
}

void ZeroTracker::followUntouched(const TableConstants& constants, GaugeSet leftOut,
                                  Calibration& calibration) {
  lastChange_q32_ = 0;
  const std::int32_t limit = readingNoise_q32(constants);
  for (std::size_t i = 0; i < constants.gauge_count; ++i)
    if (!contains(leftOut, static_cast<int>(i))) move(i, std::clamp(sum_[i], -limit, limit), calibration);
  age_sets_ = 0;
}

void ZeroTracker::followTouched(const TableImage& tables, PitchQ20 position, GaugeSet leftOut,
                                Calibration& calibration) {
  const auto averages = std::span(sum_).first(tables.constants.gauge_count);
  if (!resting_) {
    rest_ = sum_;
    restLeftOut_ = leftOut_;
    resting_ = true;
    return;
  }
  const Problem problem = problemOf(tables, averages, gateEnergy(tables.constants, averages));
  const View view = viewOf(problem, position);
  const GaugeSet window = windowOf(problem, view);
  const Ways ways{problem, view, localFit(problem, RingSignal{problem, leftOut}, view).tangent};
  const std::int64_t square = squareIn(window, averages);
  for (std::size_t i = 0; i < averages.size(); ++i)
    averages[i] = contains(leftOut, static_cast<int>(i)) ? 0 : averages[i] - rest_[i];
  if (takeOutContact(ways, averages) > square >> (2 * kMovedShift)) {
    resting_ = false;
    return;
  }
  lastChange_q32_ = 0;
  for (std::size_t i = 0; i < averages.size(); ++i)
    if (!contains(leftOut, static_cast<int>(i))) move(i, averages[i], calibration);
}

void ZeroTracker::finish(const TableImage& tables, const std::optional<Fit>& fit, Calibration& calibration) {
  for (std::int32_t& sum : sum_) sum >>= kAverageShift;
  if (touched_) {
    followTouched(tables, fit->best.position, leftOut_ | (resting_ ? restLeftOut_ : 0), calibration);
  } else {
    followUntouched(tables.constants, leftOut_, calibration);
  }
  begin(touched_);
}

}  // namespace strainfinger::firmware
