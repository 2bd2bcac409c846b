#include "firmware/core/search.hpp"

#include <algorithm>
#include <utility>

namespace strainfinger::firmware {
namespace {

/// Second moments to look at, as fractions of the largest [* 2^20]. On the default finger 0.2, 0.8, 1.7, 3.1
/// and 4.6 mm^2; for pairs 0.4 mm^2, chosen by how many pairs are found.
constexpr std::array<Number, 5> kFineMoments_q20{40'000, 160'000, 340'000, 600'000, 900'000};
constexpr std::array<Number, 2> kCoarseMoments_q20{60'000, 400'000};
constexpr Number kPairMoment_q20 = 80'000;

constexpr int kFinePlaces = 25, kCoarsePlaces = 17;
constexpr std::uint32_t kFineStep = 2, kCoarseStep = 3, kPairStep = 6;  ///< twelfths of a pitch
constexpr int kBesideSteps = 2;  ///< each way from a contact of the best pair
static_assert(12 % kPairStep == 0, "pairs are sought all round the ring");

/// Leaving out a gauge further away from the contact than this removes nothing but that gauge's own residual.
constexpr std::uint32_t kSuspectPitches = 2;

constexpr int kFirstSteps = 2;  ///< Gauss-Newton steps of the best points, before candidates are chosen
constexpr int kMostSteps = 14;  ///< of a candidate
constexpr int kPatience = 4;    ///< steps after which one that raises the energy is shortened

constexpr int kPointEnergyBits = 4;  ///< the energy of 32 readings of 16 bits is at most 2^35

/// Work for a point, for a pair of places, and between two grids [units of Search::kWork].
constexpr int kPointWork = 5, kPairWork = 12, kTaskWork = 9;

/// The middle of the two neighbouring gauges with the most energy: a contact is within two pitches of it,
/// whatever its loads. A gauge that does not count is given the mean energy of its neighbours, because with
/// no energy contacts beside it would be up to three pitches away.
std::uint32_t anchor_q32(const TableImage& tables, const ScaledReadings& readings, GaugeSet gauges) {
  const int count = tables.constants.gauge_count;
  const auto read = [&](int i) {
    return contains(gauges, i) ? Wide{readings.value[index(i)]} * readings.value[index(i)] : 0;
  };
  const auto energy = [&](int i) {
    return contains(gauges, i) ? read(i) : (read((i + count - 1) % count) + read((i + 1) % count)) / 2;
  };
  Wide most = -1;
  std::uint32_t anchor = 0;
  for (int i = 0; i < count; ++i) {
    const int next = (i + 1) % count;
    const Wide sum = energy(i) + energy(next);
    if (sum <= most) continue;
    most = sum;
    const std::uint32_t before = tables.gauge_angle_q32[index(i)];
    anchor = before + (tables.gauge_angle_q32[index(next)] - before) / 2;
  }
  return anchor;
}

/// Two fits nearer to each other than this in place and second moment led to the same answer.
bool isSame(const TableConstants& constants, const ContactState& a, const ContactState& b) {
  return apart_q32(a.angle_q32, b.angle_q32) < pitch_q32(constants) / 16 &&
         magnitude(a.moment_q20 - b.moment_q20) < (1 << 15) + (a.moment_q20 + b.moment_q20) / 16;
}

}  // namespace

bool areSame(const TableConstants& constants, int contacts, const ContactStates& a, const ContactStates& b) {
  const auto match = [&](int i, int j) { return isSame(constants, a[index(i)], b[index(j)]); };
  if (contacts == 1) return match(0, 0);
  return (match(0, 0) && match(1, 1)) || (match(0, 1) && match(1, 0));
}

bool areElsewhere(const TableConstants& constants, int contacts, const ContactStates& a,
                  const ContactStates& b) {
  const auto match = [&](int i, int j) {
    return apart_q32(a[index(i)].angle_q32, b[index(j)].angle_q32) <
           pitch_q32(constants) / 16 * threshold::kElsewhere_16;
  };
  if (contacts == 1) return !match(0, 0);
  return !(match(0, 0) && match(1, 1)) && !(match(0, 1) && match(1, 0));
}

void Ranking::take(const TableConstants& constants, const Solution& solution,
                   const ScaledReadings& readings) {
  if (!isPromising(constants, solution)) return;
  if (!anyBest) {
    best = solution;
    anyBest = true;
    return;
  }
  const auto energy = [&](const Solution& of) { return likelihoodEnergy(constants, of, readings); };
  const auto isSameAsBest = [&](const Solution& of) {
    return of.hypothesis == best.hypothesis &&
           areSame(constants, of.hypothesis.contacts, of.contact, best.contact);
  };
  const auto isRival = [&](const Solution& of) {
    return of.hypothesis == best.hypothesis && energy(of) - energy(best) < ambiguity(readings.variances) &&
           areElsewhere(constants, of.hypothesis.contacts, of.contact, best.contact);
  };
  Solution other = solution;
  if (energy(other) < energy(best)) {
    std::swap(other, best);
    anySecond = anySecond && !isSameAsBest(second);
  }
  if (isSameAsBest(other)) return;
  if (anySecond) {
    const bool is = isRival(other), was = isRival(second);
    if (is != was ? was : energy(second) <= energy(other)) return;
  }
  second = other;
  anySecond = true;
}

Grid::Grid(const TableImage& tables, const Hypothesis& hypothesis, const ScaledReadings& readings, Kind kind)
    : kind_(kind), widthIsFree_(hypothesis.widthIsFree) {
  const bool fine = kind == Kind::kFine;
  step_q32_ = pitch_q32(tables.constants) / 12 * (fine ? kFineStep : kCoarseStep);
  rows_ = fine ? kFinePlaces : kCoarsePlaces;
  first_q32_ =
      anchor_q32(tables, readings, hypothesis.gauges) - static_cast<std::uint32_t>(rows_ / 2) * step_q32_;
  if (widthIsFree_)
    columns_ = static_cast<std::int16_t>(fine ? kFineMoments_q20.size() : kCoarseMoments_q20.size());
}

Grid::Grid(const TableConstants& constants, bool widthIsFree, const Ranking& single)
    : step_q32_(pitch_q32(constants) / 12 * kPairStep),
      columns_(static_cast<std::int16_t>(6 * constants.gauge_count / kPairStep)),
      kind_(Kind::kPairs),
      widthIsFree_(widthIsFree) {
  int singles = 0;
  const auto add = [&](const ContactState& contact) {
    known_[index(singles++)] = {contact.angle_q32, contact.moment_q20};
  };
  if (single.anyBest) add(single.best.contact[0]);
  if (single.anySecond) add(single.second.contact[0]);
  rows_ = static_cast<std::int16_t>(2 * (columns_ + singles));
}

Grid::Grid(const TableConstants& constants, bool widthIsFree, const ContactStates& pair)
    : step_q32_(pitch_q32(constants) / 12 * kPairStep),
      rows_(kMostContacts),
      columns_(2 * kBesideSteps),
      kind_(Kind::kBeside),
      widthIsFree_(widthIsFree) {
  for (std::size_t k = 0; k < known_.size(); ++k) known_[k] = {pair[k].angle_q32, pair[k].moment_q20};
}

ContactStates Grid::at(const TableImage& tables, int point) const {
  const int row = point / columns_, column = point % columns_;
  const auto contact = [&](std::uint32_t angle_q32, Number moment_q20) {
    return ContactState{angle_q32, 0, 0,
                        widthIsFree_ ? moment_q20 : static_cast<Number>(tables.constants.known_moment_q20)};
  };
  const auto place = [&](int steps, Number moment_q20) {
    return contact(first_q32_ + static_cast<std::uint32_t>(steps) * step_q32_, moment_q20);
  };
  if (kind_ == Kind::kFine) return {place(row, kFineMoments_q20[index(column)])};
  if (kind_ == Kind::kCoarse) return {place(row, kCoarseMoments_q20[index(column)])};
  const auto known = [&](int which, int steps) {
    const Known& at = known_[index(which)];
    return contact(at.angle_q32 + static_cast<std::uint32_t>(steps) * step_q32_,
                   steps == 0 ? at.moment_q20 : kPairMoment_q20);
  };
  if (kind_ == Kind::kBeside) {
    const int steps = column < kBesideSteps ? column - kBesideSteps : column - kBesideSteps + 1;
    return {known(0, row == 0 ? steps : 0), known(1, row == 0 ? 0 : steps)};
  }
  const int beside = row - 2 * columns_;
  if (beside < 0) return {place(row, kPairMoment_q20), place(row + column + 1, kPairMoment_q20)};
  return {known(beside / 2, 0), place(beside % 2 * columns_ + column, kPairMoment_q20)};
}

ContactStates initialGuess(const TableImage& tables, const Hypothesis& hypothesis,
                           const ScaledReadings& readings, Linearisation& scratch,
                           std::optional<std::uint32_t> otherStart_q32) {
  const Grid grid(tables, hypothesis, readings, Grid::Kind::kCoarse);
  const Residual all = allOf(tables, hypothesis, readings);
  const std::uint32_t away_q32 = pitch_q32(tables.constants) / 16 * threshold::kOtherStart_16;
  Solution best;
  bool any = false;
  for (int i = 0; i < grid.size(); ++i) {
    const ContactStates contacts = grid.at(tables, i);
    if (otherStart_q32 && apart_q32(contacts[0].angle_q32, *otherStart_q32) < away_q32) continue;
    const Solution point = fitLoads(tables, hypothesis, contacts, all, readings.weight_q14, scratch);
    if (!isPromising(tables.constants, point)) continue;
    if (any && point.residualEnergy >= best.residualEnergy) continue;
    best = point;
    any = true;
  }
  return any ? best.contact : grid.at(tables, grid.size() / 2);
}

void Search::begin(const TableImage& tables, const ScaledReadings& readings, const Hypothesis& hypothesis) {
  readings_ = readings;
  all_ = hypothesis;
  single_ = withoutOne_ = pair_ = {};
  stage_ = Stage::kSingle;
  beginTask(all_, Grid(tables, all_, readings_, Grid::Kind::kFine));
}

/// Chosen by the figures of LocateAccuracy and of the disturbance matrix.
Search::Effort Search::effort() const {
  if (stage_ == Stage::kSingle) return {19, 12, 8};
  if (stage_ == Stage::kPair || stage_ == Stage::kBeside)
    return {kMostPoints, kMostCandidates, kMostCandidates};
  return {3, 3, 1};
}

void Search::beginTask(const Hypothesis& hypothesis, const Grid& grid) {
  hypothesis_ = hypothesis;
  grid_ = grid;
  bestPoints_.clear();
  candidates_.clear();
  point_ = 0;
  tried_ = refined_ = steps_ = kept_ = 0;
}

/// As many points as there is work left for.
void Search::lookAtPoints(const TableImage& tables, int& left, Linearisation& scratch) {
  const Residual all = allOf(tables, hypothesis_, readings_);
  const int work = nextWork(tables);
  for (; point_ < grid_.size() && work <= left; left -= work) lookAtNext(tables, all, scratch);
}

/// Keeps the best points, and of neighbours only the best one, because the others lead to the same answer.
void Search::lookAtNext(const TableImage& tables, const Residual& all, Linearisation& scratch) {
  const Solution solution =
      fitLoads(tables, hypothesis_, grid_.at(tables, point_), all, readings_.weight_q14, scratch);
  const Point point{static_cast<std::uint32_t>(solution.residualEnergy >> kPointEnergyBits), point_++};
  if (!isPromising(tables.constants, solution)) return;
  const auto isNeighbour = [&](const Point& other) {
    return grid_.areNeighbours(point.number, other.number);
  };
  for (int i = 0; i < bestPoints_.size(); ++i)
    if (bestPoints_[i].residualEnergy <= point.residualEnergy && isNeighbour(bestPoints_[i])) return;
  bestPoints_.remove(isNeighbour);
  bestPoints_.insert(point, effort().points);
}

/// Fits the loads of the next of the best points, then takes its first steps, one with each call.
void Search::tryNext(const TableImage& tables, Linearisation& scratch) {
  if (steps_ == 0) {
    const ContactStates at = grid_.at(tables, bestPoints_[tried_].number);
    const Residual all = allOf(tables, hypothesis_, readings_);
    reached_.contact = fitLoads(tables, hypothesis_, at, all, readings_.weight_q14, scratch).contact;
    steps_ = 1;
    return;
  }
  linearise(tables, hypothesis_, reached_.contact, scratch, readings_.weight_q14);
  const Solution solution = step(tables, scratch, readings_);
  reached_ = {solution.contact, solution.residualEnergy};
  if (!solution.converged && ++steps_ <= kFirstSteps) return;
  steps_ = 0;
  ++tried_;
  candidates_.insert(reached_, effort().candidates);
}

/// Takes a Gauss-Newton step of the next candidate, or shortens its last step where that raised the energy.
/// descend() does both at once; here each call costs only one linearisation.
void Search::refineNext(const TableImage& tables, Linearisation& scratch) {
  Candidate& candidate = candidates_[refined_];
  if (steps_ == 0 && isWorseTwin(tables.constants, refined_)) {
    ++refined_;
    return;
  }
  linearise(tables, hypothesis_, candidate.contact, scratch, readings_.weight_q14);
  const Wide left = energyLeft(tables, scratch, readings_);
  const bool isWorse = steps_ >= kPatience && left >= reached_.residualEnergy;
  Solution solution{hypothesis_, {}};
  if (isWorse) {
    const Wide promised = reached_.residualEnergy - candidate.residualEnergy;
    solution.contact =
        partway(reached_.contact, candidate.contact, promised, left - candidate.residualEnergy);
    solution.residualEnergy = candidate.residualEnergy;
    solution.converged = solution.contact == reached_.contact;
  } else {
    reached_ = {candidate.contact, left};
    solution = step(tables, scratch, readings_);
  }
  candidate = {solution.contact, solution.residualEnergy};
  if (!solution.converged && ++steps_ < kMostSteps) return;
  if (!solution.converged) candidate = reached_;
  steps_ = 0;
  ++refined_;
  ++kept_;
  ranking().take(tables.constants,
                 {hypothesis_, candidate.contact, solution.converged, candidate.residualEnergy}, readings_);
}

/// A better candidate led to the same answer.
bool Search::isWorseTwin(const TableConstants& constants, int candidate) const {
  for (int better = 0; better < candidate; ++better)
    if (areSame(constants, hypothesis_.contacts, candidates_[candidate].contact, candidates_[better].contact))
      return true;
  return false;
}

/// A candidate is left to refine. Twins of a better one don't count. Of one contact, candidates with far more
/// energy than the best lead nowhere; of pairs, whose first steps come less far, they may.
bool Search::isRefining() const {
  if (kept_ == effort().refined || refined_ == candidates_.size()) return false;
  return steps_ > 0 || refined_ == 0 || hypothesis_.contacts > 1 ||
         candidates_[refined_].residualEnergy >> threshold::kHopelessBits <
             candidates_[0].residualEnergy + energyOf(readings_, threshold::kRefuted * threshold::kAmbiguous);
}

Ranking& Search::ranking() {
  if (stage_ == Stage::kSingle) return single_;
  return stage_ == Stage::kWithoutOne ? withoutOne_ : pair_;
}

/// Suspects: gauges near the best single contact, and those with a quarter or more of its residual energy.
void Search::findSuspects(const TableImage& tables, Linearisation& scratch) {
  suspects_ = all_.gauges;
  leftOut_ = 0;
  if (!single_.anyBest) return;
  const Solution& best = single_.best;
  linearise(tables, best.hypothesis, best.contact, scratch);
  for (int i = 0; i < tables.constants.gauge_count; ++i) {
    const Wide left = readings_.left(index(i), scratch.predicted[index(i)]);
    if (apart_q32(best.contact[0].angle_q32, tables.gauge_angle_q32[index(i)]) >
            kSuspectPitches * pitch_q32(tables.constants) &&
        left * left < best.residualEnergy / 4)
      suspects_ &= ~(GaugeSet{1} << i);
  }
}

void Search::withoutNext(const TableImage& tables) {
  while (leftOut_ < tables.constants.gauge_count && !contains(suspects_, leftOut_)) ++leftOut_;
  if (leftOut_ < tables.constants.gauge_count) {
    const Hypothesis without{1, all_.widthIsFree, all_.gauges & ~(GaugeSet{1} << leftOut_++)};
    return beginTask(without, Grid(tables, without, readings_, Grid::Kind::kCoarse));
  }
  if (single_.anyBest && isPlainAsBuilt(tables.constants, single_.best, readings_)) return finish();
  stage_ = Stage::kPair;
  beginTask({2, all_.widthIsFree, all_.gauges}, Grid(tables.constants, all_.widthIsFree, single_));
}

void Search::finishTask(const TableImage& tables, Linearisation& scratch) {
  if (stage_ == Stage::kSingle && single_.anyBest && isPlain(tables.constants, single_.best, readings_))
    return finish();
  if (stage_ == Stage::kSingle) {
    stage_ = Stage::kWithoutOne;
    findSuspects(tables, scratch);
  }
  if (stage_ == Stage::kWithoutOne) return withoutNext(tables);
  if (stage_ == Stage::kBeside || !pair_.anyBest) return finish();
  stage_ = Stage::kBeside;
  beginTask(hypothesis_, Grid(tables.constants, all_.widthIsFree, pair_.best.contact));
}

/// The next piece takes at most this much work.
int Search::nextWork(const TableImage& tables) const {
  const bool isTrying = tried_ < bestPoints_.size();
  if (point_ < grid_.size() || (isTrying && steps_ == 0))
    return hypothesis_.contacts == 1 ? kPointWork : kPairWork;
  return isTrying || isRefining() ? stepWork(tables, hypothesis_) : kTaskWork;
}

void Search::advance(const TableImage& tables, int work, Linearisation& scratch) {
  for (int left = work; isRunning() && nextWork(tables) <= left;) {
    if (point_ < grid_.size()) {
      lookAtPoints(tables, left, scratch);
      continue;
    }
    left -= nextWork(tables);
    if (tried_ < bestPoints_.size()) {
      tryNext(tables, scratch);
    } else if (isRefining()) {
      refineNext(tables, scratch);
    } else {
      finishTask(tables, scratch);
    }
  }
}

}  // namespace strainfinger::firmware
