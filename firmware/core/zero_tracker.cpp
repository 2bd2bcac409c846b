#include "firmware/core/zero_tracker.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>

#include "firmware/core/detect.hpp"

namespace strainfinger::firmware {
namespace {

/// Readings, below 2^29 (kMostGateShift), are summed in steps of 2^6, far below the noise of one: 256 of them
/// stay below 2^31.
constexpr int kSumShift = 6;
constexpr int kAverageShift = 2;
static_assert(ZeroTracker::kInterval / ZeroTracker::kEvery == 1 << (kSumShift + kAverageShift));

/// A touch that changes by this part of itself, as a power of two, has moved.
constexpr int kMovedShift = 6;

GaugeSet windowOf(const Problem& problem, const View& view) {
  GaugeSet window = 0;
  for (int step = -kWindowReach; step <= kWindowReach; ++step) window |= 1u << gaugeAt(problem, view, step);
  return window;
}

/// Sine of a fraction of a revolution [* 2^14], within 0.2 %: a parabola, and a second one through its error.
std::int32_t sine_q14(std::uint32_t turn_q32) {
  const std::int32_t half = static_cast<std::int32_t>(turn_q32) >> 17;  // half revolutions * 2^14
  const std::int32_t parabola = (half * ((1 << 14) - std::abs(half))) >> 12;
  return parabola + ((230 * (((parabola * std::abs(parabola)) >> 14) - parabola)) >> 10);
}

/// Drift that all gauges share: alike, or one side more than the other. Three patterns round the ring
/// [* 2^14].
Three patternsAt(const TableConstants& constants, int gauge) {
  const auto turn = static_cast<std::uint32_t>(
      (std::uint64_t{constants.pitch_turn_q35} * static_cast<unsigned>(gauge)) >> 3);
  return {1 << 14, sine_q14(turn + (1u << 30)), sine_q14(turn)};
}

/// The window of a contact, and its three ways of changing it.
struct Ways {
  const Problem& problem;
  View view;
  Tangent tangent;

  [[gnu::noinline]] std::int64_t weight(int step, std::size_t way) const {
    const int sign = view.side > 0 ? 1 : problem.mirrorSign();
    if (std::abs(step) <= kWindowReach) return sign * tangent.at[indexOf(step)][way];
    return (step > 0 ? sign : -sign) * overRootTwo(tangent.at[indexOf(kOuterReach)][way]);
  }
  int reach() const { return fitReach(problem.gauges()); }
  std::size_t gauge(int step) const { return static_cast<std::size_t>(gaugeAt(problem, view, step)); }

  /// Components along the ways of what `at(gauge)` gives.
  template <typename At>
  Three along(At at) const {
    std::array<std::int64_t, 3> sums{};
    for (int step = -reach(); step <= reach(); ++step)
      for (std::size_t way = 0; way < 3; ++way) sums[way] += weight(step, way) * at(gauge(step));
    return {narrowed(sums[0] >> 15), narrowed(sums[1] >> 15), narrowed(sums[2] >> 15)};
  }
};

/// Least squares of changes in terms of the shared patterns, whatever a contact has changed: what lies along
/// its ways counts for nothing. Zero where the gauges don't tell.
Three sharedDrift(const Ways& ways, std::span<const std::int32_t> changes_q32, const Three& changeAlong,
                  const std::array<Three, 3>& patternAlong) {
  std::array<std::int64_t, 6> matrix{};
  std::array<std::int64_t, 3> right{};
  for (std::size_t gauge = 0; gauge < changes_q32.size(); ++gauge) {
    const Three p = patternsAt(ways.problem.tables.constants, static_cast<int>(gauge));
    std::size_t k = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      right[i] += std::int64_t{p[i]} * changes_q32[gauge];
      for (std::size_t j = i; j < 3; ++j) matrix[k++] += std::int64_t{p[i]} * p[j];
    }
  }
  const auto count = static_cast<std::int64_t>(changes_q32.size());
  Symmetric scaled{};
  Three sums{}, shared{};
  Symmetric inverse{};
  std::size_t k = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    for (std::size_t way = 0; way < 3; ++way)
      right[i] -= std::int64_t{patternAlong[i][way]} * changeAlong[way];
    sums[i] = narrowed((right[i] >> 14) / count);
    for (std::size_t j = i; j < 3; ++j, ++k) {
      for (std::size_t way = 0; way < 3; ++way)
        matrix[k] -= std::int64_t{patternAlong[i][way]} * patternAlong[j][way];
      scaled[k] = static_cast<std::int32_t>((matrix[k] / count) >> 4);
    }
  }
  if (invert(scaled, inverse)) shared = product_q12(inverse, sums);
  return shared;
}

/// Changes of more than the whole range saturate: the squares of three fit 63 bits. A contact that did as
/// much has moved.
[[gnu::noinline]] std::int32_t withinRange(std::int64_t change) {
  constexpr std::int64_t kRange = std::int64_t{1} << 30;
  return static_cast<std::int32_t>(std::clamp(change, -kRange, kRange));
}

/// Splits changes into what a contact has done, which is taken out of them, and drift. Returns the squared
/// length of the contact's part.
std::int64_t takeOutContact(const Ways& ways, std::span<std::int32_t> changes_q32) {
  const auto patternOf = [&](std::size_t i) {
    return ways.along([&](std::size_t gauge) {
      return std::int64_t{patternsAt(ways.problem.tables.constants, static_cast<int>(gauge))[i]};
    });
  };
  const std::array patternAlong{patternOf(0), patternOf(1), patternOf(2)};
  Three contact = ways.along([&](std::size_t gauge) { return std::int64_t{changes_q32[gauge]}; });
  const Three shared = sharedDrift(ways, changes_q32, contact, patternAlong);
  std::int64_t square = 0;
  for (std::size_t way = 0; way < 3; ++way) {
    std::int64_t drift = 0;
    for (std::size_t i = 0; i < 3; ++i) drift += std::int64_t{patternAlong[i][way]} * shared[i];
    contact[way] = withinRange(contact[way] - (drift >> 14));
    square += std::int64_t{contact[way]} * contact[way];
  }
  for (int step = -ways.reach(); step <= ways.reach(); ++step) {
    std::int64_t part = 0;
    for (std::size_t way = 0; way < 3; ++way) part += ways.weight(step, way) * contact[way];
    std::int32_t& change = changes_q32[ways.gauge(step)];
    change = withinRange(change - (part >> 15));
  }
  return square;
}

/// Squared length of the readings of a window.
std::int64_t squareOf(std::span<const std::int32_t> strains_q32, GaugeSet window) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < strains_q32.size(); ++i)
    if (contains(window, static_cast<int>(i))) sum += std::int64_t{strains_q32[i]} * strains_q32[i];
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
  for (std::size_t i = 0; i < strains_q32.size(); ++i) sum_[i] += strains_q32[i] >> kSumShift;
}

void ZeroTracker::doubt(bool touched) {
  if (++doubts_ >= kConvinced) begin(touched);
}

void ZeroTracker::move(std::size_t gauge, std::int32_t by_q32, Calibration& calibration) {
  const std::int64_t codes =
      (std::int64_t{by_q32} << 32) / std::max<std::int32_t>(calibration.gain[gauge], 1);
  calibration.zero_q15[gauge] = static_cast<std::int32_t>(std::clamp<std::int64_t>(
      calibration.zero_q15[gauge] + codes, 0, std::numeric_limits<std::int32_t>::max()));
  lastChange_q32_ = std::max(lastChange_q32_.value_or(0), std::abs(by_q32));
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
  const std::int64_t square = squareOf(averages, window);
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
