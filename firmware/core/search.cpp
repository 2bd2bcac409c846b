#include "firmware/core/search.hpp"

#include <algorithm>

namespace strainfinger::firmware {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

/// Second moments to look at, as fractions of the largest [* 2^20]. On the default finger 0.3, 0.9, 1.8, 3.1
/// and 4.6 mm^2.
constexpr std::array<Number, 5> kFineMoments_q20{40'000, 160'000, 340'000, 600'000, 900'000};
constexpr std::array<Number, 2> kCoarseMoments_q20{60'000, 400'000};
constexpr Number kPairMoment_q20 = 60'000;

constexpr int kFinePlaces = 33, kCoarsePlaces = 15, kPairPlaces = 5;
constexpr int kFineStep = 1, kCoarseStep = 2, kPairStep = 4;  ///< eighths of a pitch

constexpr int kFirstSteps = 2;  ///< Gauss-Newton steps of every candidate, before the best are chosen
constexpr int kMostSteps = 14;  ///< of these

/// Units of work: a look at a point, one at a pair of places, a Gauss-Newton step of one or two contacts.
constexpr int kPointWork = 1, kPairWork = 3, kStepWork = 4, kPairStepWork = 12;

/// How many candidates a hypothesis has, and how many of them are refined.
struct Effort {
  int candidates, refined;
};
constexpr Effort kFineEffort{12, 4}, kCoarseEffort{3, 1}, kPairEffort{6, 2};

std::uint32_t pitch_q32(const TableConstants& constants) {
  return static_cast<std::uint32_t>((std::uint64_t{1} << 32) / constants.gauge_count);
}

/// The middle of the two neighbouring gauges that read most energy: a contact is within two pitches of it,
/// whatever its loads.
std::uint32_t anchor_q32(const TableImage& tables, const ScaledReadings& readings, GaugeSet gauges) {
  std::array<std::uint8_t, kMaxGauges> ring{};
  int used = 0;
  for (int i = 0; i < tables.constants.gauge_count; ++i)
    if (contains(gauges, i)) ring[at(used++)] = static_cast<std::uint8_t>(i);
  const auto gauge = [&](int i) { return std::size_t{ring[at(i % used)]}; };
  const auto energy = [&](int i) { return Wide{readings.value[gauge(i)]} * readings.value[gauge(i)]; };
  Wide most = -1;
  std::uint32_t anchor = 0;
  for (int i = 0; i < used; ++i) {
    const Wide sum = energy(i) + energy(i + 1);
    if (sum <= most) continue;
    most = sum;
    const std::uint32_t before = tables.gauge_angle_q32[gauge(i)];
    anchor = before + (tables.gauge_angle_q32[gauge(i + 1)] - before) / 2;
  }
  return anchor;
}

Number momentOf(const TableConstants& constants, Number moment_q20) {
  return constants.width_is_known != 0 ? static_cast<Number>(constants.known_moment_q20) : moment_q20;
}

std::uint32_t apart_q32(const ContactState& a, const ContactState& b) {
  const std::uint32_t difference = a.angle_q32 - b.angle_q32;
  return std::min(difference, 0 - difference);
}

/// Closer than this in place and second moment, two fits went to the same answer.
bool isSame(const TableConstants& constants, const ContactState& a, const ContactState& b) {
  return apart_q32(a, b) < pitch_q32(constants) / 16 &&
         magnitude(a.moment_q20 - b.moment_q20) < (1 << 15) + (a.moment_q20 + b.moment_q20) / 16;
}

bool isSame(const TableConstants& constants, const Solution& a, const Solution& b) {
  if (a.hypothesis != b.hypothesis) return false;
  const auto match = [&](int i, int j) { return isSame(constants, a.contact[at(i)], b.contact[at(j)]); };
  if (a.hypothesis.contacts == 1) return match(0, 0);
  return (match(0, 0) && match(1, 1)) || (match(0, 1) && match(1, 0));
}

/// Points of a grid next to each other in place, of the same width: the worse is on the way to the better.
bool isNeighbour(const TableConstants& constants, const Solution& a, const Solution& b) {
  const std::uint32_t near_q32 = pitch_q32(constants) / 16 * (a.hypothesis.contacts == 1 ? 5 : 9);
  for (int k = 0; k < a.hypothesis.contacts; ++k)
    if (apart_q32(a.contact[at(k)], b.contact[at(k)]) > near_q32 ||
        a.contact[at(k)].moment_q20 != b.contact[at(k)].moment_q20)
      return false;
  return true;
}

bool isBetter(const Solution& a, const Solution& b) { return a.residualEnergy < b.residualEnergy; }

const Effort& effortOf(bool fine, const Hypothesis& hypothesis) {
  if (hypothesis.contacts == 2) return kPairEffort;
  return fine ? kFineEffort : kCoarseEffort;
}

}  // namespace

void Ranking::take(const TableConstants& constants, const Solution& solution,
                   const ScaledReadings& readings) {
  if (!isPromising(constants, solution)) return;
  const auto isLikelier = [&](const Solution& a, const Solution& b) {
    return likelihoodEnergy(constants, a, readings) < likelihoodEnergy(constants, b, readings);
  };
  const bool same = anyBest && isSame(constants, solution, best);
  if (!anyBest || isLikelier(solution, best)) {
    if (anyBest && !same) {
      second = best;
      anySecond = true;
    }
    best = solution;
    anyBest = true;
  } else if (!same && (!anySecond || isLikelier(solution, second))) {
    second = solution;
    anySecond = true;
  }
}

Grid::Grid(const TableImage& tables, const Hypothesis& hypothesis, const ScaledReadings& readings, bool fine)
    : anchor_q32_(anchor_q32(tables, readings, hypothesis.gauges)),
      pairs_(hypothesis.contacts == 2),
      fine_(fine) {
  if (pairs_) {
    places_ = kPairPlaces;
    others_ = static_cast<std::int16_t>(2 * tables.constants.gauge_count);
    step_ = kPairStep;
    return;
  }
  places_ = fine ? kFinePlaces : kCoarsePlaces;
  step_ = fine ? kFineStep : kCoarseStep;
  others_ = !hypothesis.widthIsFree
                ? 1
                : static_cast<std::int16_t>(fine ? kFineMoments_q20.size() : kCoarseMoments_q20.size());
}

ContactStates Grid::at(const TableImage& tables, int index) const {
  const std::uint32_t eighth_q32 = pitch_q32(tables.constants) / 8;
  const int place = index / others_, other = index % others_;
  const auto away = static_cast<std::uint32_t>((place - places_ / 2) * step_);
  ContactStates contacts{};
  contacts[0].angle_q32 = anchor_q32_ + away * eighth_q32;
  if (pairs_) {
    contacts[1].angle_q32 =
        contacts[0].angle_q32 + static_cast<std::uint32_t>(other * kPairStep) * eighth_q32;
    contacts[0].moment_q20 = contacts[1].moment_q20 = momentOf(tables.constants, kPairMoment_q20);
  } else {
    const auto i = static_cast<std::size_t>(other);
    contacts[0].moment_q20 = momentOf(tables.constants, fine_ ? kFineMoments_q20[i] : kCoarseMoments_q20[i]);
  }
  return contacts;
}

ContactStates initialGuess(const TableImage& tables, const Hypothesis& hypothesis,
                           const ScaledReadings& readings) {
  const Grid grid(tables, hypothesis, readings, false);
  Solution best;
  bool any = false;
  for (int i = 0; i < grid.size(); ++i) {
    const Solution point = fitLoads(tables, hypothesis, grid.at(tables, i), readings);
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
  beginTask(tables, all_);
}

void Search::beginTask(const TableImage& tables, const Hypothesis& hypothesis) {
  hypothesis_ = hypothesis;
  grid_ = Grid(tables, hypothesis, readings_, stage_ == Stage::kSingle);
  point_ = 0;
  candidates_ = refined_ = 0;
}

/// Keeps the best points that are not neighbours of better ones, best first.
void Search::consider(const TableConstants& constants, const Solution& point) {
  const auto first = candidate_.begin();
  auto last = first + candidates_;
  const auto neighbours = [&](const Solution& other) { return isNeighbour(constants, point, other); };
  const auto place = std::upper_bound(first, last, point, isBetter);
  if (std::any_of(first, place, neighbours)) return;
  last = std::remove_if(place, last, neighbours);
  if (place - first == effortOf(stage_ == Stage::kSingle, hypothesis_).candidates) return;
  if (last - first == effortOf(stage_ == Stage::kSingle, hypothesis_).candidates) --last;
  std::move_backward(place, last, last + 1);
  *place = point;
  candidates_ = static_cast<std::uint8_t>(last + 1 - first);
}

int Search::lookAtPoint(const TableImage& tables) {
  const Solution point = fitLoads(tables, hypothesis_, grid_.at(tables, point_++), readings_);
  if (isPromising(tables.constants, point)) consider(tables.constants, point);
  return hypothesis_.contacts == 1 ? kPointWork : kPairWork;
}

/// The first steps of the next candidate, or all of them where one of the best is next.
int Search::refineNext(const TableImage& tables, Linearisation& scratch) {
  const bool first = refined_ < candidates_;
  const int i = first ? refined_ : refined_ - candidates_;
  ++refined_;
  Solution& candidate = candidate_[at(i)];
  if (!first)
    for (int better = 0; better < i; ++better)
      if (isSame(tables.constants, candidate, candidate_[at(better)])) return 0;
  const int steps = first ? kFirstSteps : kMostSteps;
  candidate = fit(tables, hypothesis_, candidate.contact, readings_, steps, scratch);
  if (refined_ == candidates_) std::sort(candidate_.begin(), candidate_.begin() + candidates_, isBetter);
  if (!first) rankingOf(stage_).take(tables.constants, candidate, readings_);
  return (first ? kFirstSteps : kMostSteps / 2) * (hypothesis_.contacts == 1 ? kStepWork : kPairStepWork);
}

int Search::refinements() const {
  return candidates_ + std::min<int>(candidates_, effortOf(stage_ == Stage::kSingle, hypothesis_).refined);
}

Ranking& Search::rankingOf(Stage stage) {
  if (stage == Stage::kSingle) return single_;
  return stage == Stage::kPair ? pair_ : withoutOne_;
}

void Search::withoutNext(const TableImage& tables) {
  while (leftOut_ < tables.constants.gauge_count && !contains(all_.gauges, leftOut_)) ++leftOut_;
  if (leftOut_ < tables.constants.gauge_count) {
    const GaugeSet others = all_.gauges & ~(GaugeSet{1} << leftOut_++);
    return beginTask(tables, {1, all_.widthIsFree, others});
  }
  stage_ = Stage::kPair;
  beginTask(tables, {2, all_.widthIsFree, all_.gauges});
}

void Search::finishTask(const TableImage& tables) {
  if (stage_ == Stage::kPair) return stop();
  if (stage_ == Stage::kSingle) {
    if (single_.anyBest && isAccepted(tables.constants, single_.best, readings_)) return stop();
    stage_ = Stage::kWithoutOne;
    leftOut_ = 0;
  }
  withoutNext(tables);
}

void Search::advance(const TableImage& tables, Linearisation& scratch) {
  for (int work = 0; isRunning() && work < kWork;) {
    if (point_ < grid_.size()) {
      work += lookAtPoint(tables);
    } else if (refined_ < refinements()) {
      work += refineNext(tables, scratch);
    } else {
      finishTask(tables);
    }
  }
}

}  // namespace strainfinger::firmware
