#include "firmware/core/zero_tracker.hpp"

#include <algorithm>

#include "firmware/core/detect.hpp"

namespace strainfinger::firmware {
namespace {

constexpr int kTakenBits = 8;  ///< of an interval, sample sets that are averaged [log2]
static_assert(ZeroTracker::kInterval == ZeroTracker::kEvery << kTakenBits);

/// What one contact leaves of a contact's averages: less than this part [log2] of their energy.
constexpr int kContactBits = 4;
/// Averages below this part of a reading's variance teach nothing [log2].
constexpr int kQuietBits = 6;

/// The code * 2^15 by which a strain is more than another.
std::int32_t codeOf(std::int32_t strain_q32, std::int32_t gain) {
  return gain > 0 ? static_cast<std::int32_t>((std::int64_t{strain_q32} << 32) / gain) : 0;
}

}  // namespace

void ZeroTracker::begin(bool touched) {
  sum_.fill(0);
  sets_ = 0;
  leftOut_ = 0;
  touched_ = touched;
}

bool ZeroTracker::looksLikeAContact(const TableImage& tables, GaugeSet gauges, Linearisation& scratch) const {
  const auto averages = std::span(sum_).first(tables.constants.gauge_count);
  const ScaledReadings readings = scaledReadings(tables.constants, averages, gauges);
  Wide energy = 0;
  for (int i = 0; i < tables.constants.gauge_count; ++i)
    if (contains(gauges, i))
      energy +=
          Wide{readings.value[static_cast<std::size_t>(i)]} * readings.value[static_cast<std::size_t>(i)];
  if (energy <= Wide{readings.gateVariance_q4} >> (4 + kQuietBits)) return false;
  const Hypothesis hypothesis{1, tables.constants.width_is_known == 0, gauges};
  const Solution solution =
      fit(tables, hypothesis, initialGuess(tables, hypothesis, readings, scratch), readings, 3, scratch);
  return isAdmissible(tables.constants, solution) && solution.residualEnergy < energy >> kContactBits;
}

void ZeroTracker::finish(const TableImage& tables, GaugeSet leftOut, Calibration& calibration,
                         Linearisation& scratch) {
  const GaugeSet gauges = allGauges(tables.constants.gauge_count) & ~leftOut;
  if (!touched_) {
    if (looksLikeAContact(tables, gauges, scratch)) return;
    age_sets_ = 0;
  }
  lastChange_q32_ = 0;
  const std::int32_t limit = readingNoise_q32(tables.constants) / 2;
  for (std::size_t i = 0; i < tables.constants.gauge_count; ++i) {
    if (!contains(gauges, static_cast<int>(i))) continue;
    const std::int32_t change = std::clamp(sum_[i], -limit, limit);
    std::int32_t& zero = calibration.zero_q15[i];
    zero = static_cast<std::int32_t>(
        std::clamp<std::int64_t>(std::int64_t{zero} + codeOf(change, calibration.gain[i]), 0,
                                 std::numeric_limits<std::int32_t>::max()));
    lastChange_q32_ = std::max(*lastChange_q32_, magnitude(change));
  }
}

bool ZeroTracker::take(const TableImage& tables, std::span<const std::int32_t> strains_q32,
                       const Answer* answer, const Linearisation& fit, GaugeSet leftOut,
                       Calibration& calibration, Linearisation& scratch) {
  if (age_sets_ != std::numeric_limits<std::uint32_t>::max()) ++age_sets_;
  const bool touched = answer != nullptr;
  if (touched != touched_ || (touched && (!answer->accepted || answer->searching))) {
    begin(touched);
    return false;
  }
  leftOut_ |= leftOut;
  if (++sets_ % kEvery != 0) return false;
  if (touched) {
    const std::int32_t unit = std::int32_t{1} << answer->shift;  // at most 2^(kMostGateShift + 1)
    for (std::size_t i = 0; i < strains_q32.size(); ++i)
      sum_[i] += (strains_q32[i] - shortened(fit.predicted[i]) * unit) >> kTakenBits;
  } else {
    for (std::size_t i = 0; i < strains_q32.size(); ++i) sum_[i] += strains_q32[i] >> kTakenBits;
  }
  if (sets_ < kInterval) return false;
  finish(tables, leftOut_, calibration, scratch);
  begin(touched);
  return true;
}

}  // namespace strainfinger::firmware
