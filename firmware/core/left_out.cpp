#include "firmware/core/left_out.hpp"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <utility>

#include "firmware/core/detect.hpp"
#include "firmware/core/doubt.hpp"
#include "firmware/core/left_out_products.hpp"

namespace strainfinger::firmware {
namespace {

constexpr int kMaxSteps = 8;
constexpr PitchQ20 kLongestStep = kOnePitch / 8;
constexpr std::uint32_t kFaint = 64;  ///< an answer that explains less may be noise
constexpr std::size_t kPeaks = 6;
/// Where the search looks from the best peak's fit, in eighths of a pitch.
constexpr std::array<std::int8_t, 8> kAway{-4, -3, -2, -1, 1, 2, 3, 4};
constexpr PitchQ20 kSame = kOnePitch / 12;  ///< fits closer than this ran into one maximum

/// The search looks at eight offsets a pitch: 1/16, 3/16 .. from each gauge.
constexpr int kLooksPerPitch = 8;
constexpr int kLookRows = kRowsPerPitch / kLooksPerPitch;

View lookAt(const Problem& problem, int look) {
  const int looks = kLooksPerPitch * problem.gauges();
  const PitchQ20 position = (2 * wrapped(look, looks) + 1) * (kLookRows / 2) * kRowSpacing;
  return viewOf(problem, position);
}

PitchQ20 positionOf(const Problem& problem, const View& view, PitchQ20 beyondRow) {
  return roundTheRing(placeOf(view.centre, view.side, view.row, beyondRow), problem.gauges());
}

/// Energy outside the window that a contact there may well have left.
[[gnu::noinline]] std::int32_t tailOf(const Problem& problem, const RingSignal& signal, const View& view,
                                      const LocalFit& fit) {
  WindowEnergies window{fit.share.outerEnergy()};
  for (int step = -kWindowReach; step <= kWindowReach; ++step) {
    const int gauge = gaugeAt(problem, view, step);
    window.add(signal.at(gauge));
    if (contains(signal.leftOut, gauge)) window.addMissing(fit.predicted(problem, view, step));
  }
  return window.outside(problem.ringEnergy, problem.tail_q16());
}

/// Where a fit at a view leads, with its loads.
[[gnu::noinline]] Placement placed(const Problem& problem, const View& view, PitchQ20 beyondRow,
                                   const Three& coefficients) {
  const FitRow& row = problem.tables.rows[static_cast<std::size_t>(view.row)];
  const auto [normal, tangential] = amplitudesAt(row, view.side, coefficients);
  return {positionOf(problem, view, beyondRow), normal, tangential};
}

bool withinCone(const Problem& problem, const Placement& place) {
  if (place.normal <= 0) return false;
  return insideCone({place.normal, place.tangential}, problem.tables.constants.friction_cone_q8) >= 0;
}

PitchQ20 distance(PitchQ20 a, PitchQ20 b, int gauges) {
  const PitchQ20 ahead = roundTheRing(a - b, gauges);
  return std::min(ahead, gauges * kOnePitch - ahead);
}

[[gnu::noinline]] void enter(Rivals& rivals, const Candidate& candidate, int gauges) {
  const bool same = distance(candidate.place.position, rivals.best.place.position, gauges) < kSame;
  if (candidate.betterThan(rivals.best)) {
    if (!same) rivals.second = rivals.best;
    rivals.best = candidate;
  } else if (!same && candidate.betterThan(rivals.second)) {
    rivals.second = candidate;
  }
}

/// Where the ring's energy has a peak, the highest first; -1: no more.
using Looks = std::array<std::int16_t, kPeaks>;
struct Peaks {
  Peaks() {
    look.fill(-1);
    energy.fill(-1);
  }
  Looks look;
  std::array<std::int32_t, kPeaks> energy;

  void enter(std::int16_t newLook, std::int32_t newEnergy) {
    for (std::size_t i = 0; i < look.size(); ++i) {
      if (newEnergy <= energy[i]) continue;
      std::swap(newEnergy, energy[i]);
      std::swap(newLook, look[i]);
    }
  }
};

[[gnu::noinline]] Looks peaksOf(const Problem& problem, const RingSignal& signal) {
  const int looks = kLooksPerPitch * problem.gauges();
  Peaks peaks;
  std::int32_t before = explainedAt(problem, signal, lookAt(problem, -1));
  std::int32_t here = explainedAt(problem, signal, lookAt(problem, 0));
  for (int look = 0; look < looks; ++look) {
    const std::int32_t after = explainedAt(problem, signal, lookAt(problem, look + 1));
    if (before <= here && after < here) peaks.enter(static_cast<std::int16_t>(look), here);
    before = here;
    here = after;
  }
  return peaks.look;
}

/// Writes what the readings left out should be; those outside the window of the fit should be 0. False: that
/// isn't known, or is beyond what readings hold.
[[gnu::noinline]] bool fillIn(const Problem& problem, const RingSignal& signal, PitchQ20 position,
                              std::span<std::int32_t> strains_q32) {
  const View view = viewOf(problem, position);
  const LocalFit fit = localFit(problem, signal, view);
  if (!fit.share.determined) return false;
  const std::int32_t limit = (1 << (15 + problem.tables.constants.gate_shift)) - 1;
  const int reach = fitReach(problem.gauges());
  for (int step = -reach; step <= reach; ++step) {
    const int gauge = gaugeAt(problem, view, step);
    if (!contains(signal.leftOut, gauge)) continue;
    const std::int32_t expected = fit.expected_q32(problem, signal, view, step);
    if (absolute(expected) > limit) return false;
    strains_q32[static_cast<std::size_t>(gauge)] = expected;
  }
  return true;
}

void clear(GaugeSet gauges, std::span<std::int32_t> strains_q32) {
  for (std::size_t i = 0; i < strains_q32.size(); ++i)
    if (contains(gauges, static_cast<int>(i))) strains_q32[i] = 0;
}

/// What the search says of a fit.
struct Verdict {
  bool determined = false;
  bool ambiguous = false;
  PitchQ20 best = 0;        ///< place for which readings were filled in
  Placement alternative{};  ///< with the amplitudes of a fit to all of them
};

/// From one problem's scale to another's, whose `up` is so much more.
Placement inScale(const Placement& place, int up) {
  return {place.position, rescaled(place.normal, up), rescaled(place.tangential, up)};
}

/// Fills in; the verdict goes with what gateEnergy() then is.
[[gnu::noinline]] Verdict judge(const TableImage& tables, GaugeSet leftOut, const Rivals& rivals,
                                std::span<std::int32_t> strains_q32, std::uint32_t& energy) {
  const Problem problem = problemOf(tables, strains_q32, energy);
  Verdict verdict;
  const std::int64_t least = leastOfRivals(rivals.best.explained, problem.variances(kToldApart));
  verdict.ambiguous = rivals.second.admissible && rivals.second.explained > least;
  verdict.determined = rivals.best.explained > problem.variances(kFaint) &&
                       fillIn(problem, RingSignal{problem, leftOut}, rivals.best.place.position, strains_q32);
  energy = gateEnergy(tables.constants, strains_q32);
  verdict.best = rivals.best.place.position;
  verdict.alternative = inScale(rivals.second.place, problemOf(tables, strains_q32, energy).up - problem.up);
  return verdict;
}

/// Apart from the judgement, which needs no stack while this does.
[[gnu::noinline]] Rivals rivalsWithout(const TableImage& tables, GaugeSet leftOut,
                                       std::span<const std::int32_t> strains_q32, std::uint32_t energy) {
  const Problem problem = problemOf(tables, strains_q32, energy);
  return searchRemaining(problem, RingSignal{problem, leftOut});
}

[[gnu::noinline]] Verdict prepare(const TableImage& tables, GaugeSet leftOut,
                                  std::span<std::int32_t> strains_q32, std::uint32_t& energy) {
  clear(leftOut, strains_q32);
  const Rivals rivals = rivalsWithout(tables, leftOut, strains_q32, energy);
  return judge(tables, leftOut, rivals, strains_q32, energy);
}

/// One reading of the middle five may be missing, for the same reason (tooManyOut()).
bool tooFew(const Problem& problem, const View& view, GaugeSet leftOut) {
  int middle = 0;
  for (int step = -2; step <= 2; ++step)
    if (contains(leftOut, gaugeAt(problem, view, step))) ++middle;
  return middle > 1 || tooManyOut(leftOut, problem.gauges());
}

/// The window and row of a fit.
View viewOf(const Problem& problem, const Fit& fit) {
  const PitchQ20 ring = problem.gauges() * kOnePitch;
  PitchQ20 offset = fit.best.position - fit.centre * kOnePitch;
  if (offset > ring / 2) offset -= ring;
  if (offset < -ring / 2) offset += ring;
  return {fit.centre, offset < 0 ? -1 : 1, static_cast<int>(fit.row - problem.tables.rows.data())};
}

/// The errors of a fit to filled-in readings are those of the readings that are real.
[[gnu::noinline]] void widen(const TableImage& tables, GaugeSet leftOut,
                             std::span<const std::int32_t> strains_q32, std::uint32_t energy, Fit& fit) {
  const Problem problem = problemOf(tables, strains_q32, energy);
  const View view = viewOf(problem, fit);
  const LocalFit local = localFit(problem, RingSignal{problem, leftOut}, view);
  fit.reduced = true;
  fit.covariance_q12 = local.share.covariance_q12;
  if (!local.share.determined || tooFew(problem, view, leftOut)) fit.settled = false;
}

}  // namespace

Candidate followed(const Problem& problem, const RingSignal& signal, View view) {
  Candidate candidate;
  for (int count = 0; count < kMaxSteps; ++count) {
    const LocalFit fit = localFit(problem, signal, view);
    if (!fit.share.determined) return candidate;
    const PitchQ20 longest = kLongestStep >> std::max<std::int32_t>(count - 2, 0);  // no walking to and fro
    const PitchQ20 whole = fit.share.beyondRow(fit.tangent);
    const PitchQ20 step = std::clamp(whole, -longest, longest);
    candidate.place = placed(problem, view, step, fit.share.coefficients);
    candidate.explained = fit.share.explained + tailOf(problem, signal, view, fit);
    if (std::abs(whole) <= kConverged) {
      candidate.admissible = withinCone(problem, candidate.place);
      break;
    }
    view = viewOf(problem, candidate.place.position);
  }
  return candidate;
}

Rivals searchRemaining(const Problem& problem, const RingSignal& signal) {
  const Looks peaks = peaksOf(problem, signal);
  Rivals rivals;
  PitchQ20 first = 0;
  for (std::size_t start = 0; start < kPeaks + kAway.size(); ++start) {  // one call, for the stack's sake
    if (start == kPeaks) first = rivals.best.place.position;
    if (start < kPeaks && peaks[start] < 0) continue;
    const View view =
        start < kPeaks
            ? lookAt(problem, peaks[start])
            : viewOf(problem, roundTheRing(first + kAway[start - kPeaks] * kOnePitch / 8, problem.gauges()));
    enter(rivals, followed(problem, signal, view), problem.gauges());
  }
  return rivals;
}

Fit locateWithout(const TableImage& tables, GaugeSet leftOut, std::span<std::int32_t> strains_q32,
                  std::uint32_t energy) {
  const Verdict verdict = prepare(tables, leftOut, strains_q32, energy);
  Fit fit;
  locateBySeven(fit, tables, strains_q32.data(), energy);
  if (distance(fit.best.position, verdict.best, tables.constants.gauge_count) >= kSame)
    locateAt(fit, tables, strains_q32.data(), verdict.best);
  widen(tables, leftOut, strains_q32, energy, fit);
  if (!verdict.determined) fit.settled = false;
  if (verdict.ambiguous) {
    fit.ambiguous = true;
    fit.deficit = 0;
    fit.alternative = verdict.alternative;
  }
  return fit;
}

}  // namespace strainfinger::firmware
