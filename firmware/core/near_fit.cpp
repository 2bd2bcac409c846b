#include "firmware/core/near_fit.hpp"

#include <algorithm>

#include "firmware/core/doubt.hpp"
#include "firmware/core/near_triple.hpp"
#include "firmware/core/scan.hpp"

namespace strainfinger::firmware {
namespace {

/// The window as the middle gauge's + side sees it, if that is where the pairs tell the contact to be.
struct Facing {
  Signal signal;
  int side;
  int nearRow;  ///< before the offset that they tell
};

[[gnu::always_inline]] inline Facing facing(const Problem& problem, const StartWeights& weights,
                                            const Signal& signal) {
  constexpr int kBits = kStartWeightBits - (kPitchBits - kNearBits);
  const Number offset = toldOffset(weights, signal);
  if (offset < 0) return {mirrored(signal, problem.mirrorSign()), -1, -offset >> kBits};
  return {signal, 1, offset >> kBits};
}

/// Where the three readings agree.
struct Meeting {
  const NearRow* row;   ///< before it, of three
  std::int32_t fall;    ///< of the readings' distance, from there to the next row
  std::int32_t length;  ///< from the row [spacings * 2^kBetweenBits]
};

/// Along the near rows, from one of them: up to three pairs. False: they lead beyond those that tell, or
/// nowhere.
[[gnu::always_inline]] inline bool meet(const NearTable& table, const Signal& signal, int row,
                                        Meeting& meeting) {
  constexpr int kEighth = (1 << kBetweenBits) / 8, kLast = kNearRows - 3;
  const NearRow* const first = unknown(table.data());
  row = std::min(row, kLast);
  for (int left = 3; left > 0; --left) {
    if (row < 0 || row > kLast) return false;
    const NearRow* const at = meeting.row = unknown(first + row);
    const std::int32_t here = distanceFrom(at[0], signal), next = distanceFrom(at[1], signal);
    meeting.fall = here - next;
    const std::int32_t straight = overFall(here, meeting.fall);
    if (straight >= -kEighth && straight <= 9 * kEighth) {
      meeting.length = curved({here, next, distanceFrom(at[2], signal)}, straight);
      return at[2].tells();
    }
    row += straight >> kBetweenBits;
  }
  return false;
}

/// Where the distance, in units of the longest normal, falls by less than a sixth of the window's length a
/// pitch, it doesn't tell the offset.
bool tellsOffset(const Meeting& meeting, std::int32_t windowEnergy) {
  return mulHigh(meeting.fall, meeting.fall) >= windowEnergy >> 17;
}

/// What all seven readings say of an offset.
struct Verdict {
  const FitRow* row;
  Projections projection;
  std::int32_t information;
  std::int32_t unexplained;
};
[[gnu::always_inline]] inline Verdict verdictOn(const FitTable& rows, const Signal& signal,
                                                std::int32_t windowEnergy, PitchQ20 offset) {
  const int nearest = nearestRow(std::max<PitchQ20>(offset, 0));
  const FitRow& row = *unknown(unknown(rows.data()) + nearest);
  const Projections projection = projectionsOn(row, signal);
  const std::int32_t information =
      informationOf(weightedBy(row, projection), lowOnly(tabled(row.gradient_cosine)));
  const std::int32_t explained = energyBeside(row, projection, information, offset - nearest * kRowSpacing);
  return {&row, projection, information, windowEnergy - explained};
}

/// What three readings say of a contact.
struct NearAnswer {
  PitchQ20 offset;  ///< towards the side that faces it
  std::int32_t normal, tangential;
};
[[gnu::always_inline]] inline NearAnswer answerAt(const TableImage& tables, const Signal& signal,
                                                  const Meeting& meeting) {
  const auto row = static_cast<int>(meeting.row - unknown(tables.near.data()));
  const PitchQ20 offset = (row << kNearBits) + (meeting.length << (kNearBits - kBetweenBits));
  const Number factor = poleFactor(offset >> (kPitchBits - 15), tables.constants.near_pole_q15);
  const Pair readings = lows(signal.even[0], signal.odd[0]);
  const auto load = [&](NearLoad weights) {
    return nearAmplitude(meeting.row, weights, readings, meeting.length, factor);
  };
  return {offset, load(&NearRow::normal_load), load(&NearRow::tangential_load)};
}

[[gnu::always_inline]] inline void reportNear(const Problem& problem, const Deepest& deepest, int side,
                                              const NearAnswer& answer, const Verdict& verdict,
                                              std::int32_t windowEnergy, Fit& fit) {
  const PitchQ20 position = deepest.gauge * kOnePitch + side * answer.offset;
  fit.best = {roundTheRing(position, problem.gauges()), answer.normal, side * answer.tangential};
  fit.alternative = fit.best;
  fit.deficit = kNoRival;
  fit.row = verdict.row;
  fit.projection = verdict.projection;
  fit.information = verdict.information;
  fit.unexplained = verdict.unexplained;
  fit.windowEnergy = windowEnergy;
  fit.up = static_cast<std::int8_t>(problem.up);
  fit.centre = fit.anchor = static_cast<std::uint8_t>(deepest.gauge);
  fit.readings = FitMode::kThreePoint;
  fit.triple = kNearTriple;
  fit.reduced = fit.ambiguous = false;
  fit.settled = true;
}

}  // namespace

bool locateByNearest(Fit& fit, const TableImage& tables, const std::int32_t* strains_q32,
                     std::uint32_t energy) {
  const Problem problem = problemOf(tables, {strains_q32, tables.constants.gauge_count}, energy);
  if (!isFirm(problem)) return false;
  const Deepest deepest = deepestOf(problem);
  const StartWeights& weights = startWeights(problem, deepest);
  if (!weights.tell()) return false;
  const Signal window = windowSignal(problem.strains, deepest.gauge, problem.up);
  const std::int32_t windowEnergy = energyOf(window);
  const auto [signal, side, nearRow] = facing(problem, weights, window);
  Meeting meeting;
  if (!meet(tables.near, signal, nearRow, meeting) || !tellsOffset(meeting, windowEnergy)) return false;
  const NearAnswer answer = answerAt(tables, signal, meeting);
  if (!withinCone(tables.constants, answer.normal, answer.tangential)) return false;
  const Verdict verdict = verdictOn(tables.rows, signal, windowEnergy, answer.offset);
  if (doubtful(problem, true, verdict.unexplained, windowEnergy)) return false;
  if (answer.offset < kBesideGauge && mayBeHidden(problem, answer.offset)) return false;
  reportNear(problem, deepest, side, answer, verdict, windowEnergy, fit);
  return true;
}

}  // namespace strainfinger::firmware
