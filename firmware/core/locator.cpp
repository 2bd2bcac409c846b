#include "firmware/core/locator.hpp"

#include <algorithm>
#include <bit>
#include <optional>
#include <utility>

namespace strainfinger::firmware {
namespace {

constexpr int kMostSteps = 9;       ///< of a fit from an initial guess
constexpr int kFollowingSteps = 8;  ///< of a fit from the last answer, if there is work left for them
constexpr int kStepsWhileSearching = 2, kStepsAfterSearch = 3;
constexpr int kStepsOfThree = 4;  ///< of a fit of three readings, from where all of them lead
constexpr int kLastSteps = 2;     ///< of finishSearch(), which no later set follows
/// Work of an update that only follows, and of one that concludes a search, in the units of Search::kWork.
constexpr int kFollowingWork = 130, kWorkAfterSearch = 170;
/// The rival, or an answer to all gauges that work, is fitted once in this many sets of readings.
constexpr std::uint8_t kRivalEvery = 8;
/// One contact and its rival are compared by a fading mean of about this many of those sets if the finger has
/// a model error: the plain mean of the first, then each new one counts a quarter. A pair, and any touch of a
/// finger without one, is compared anew in each set, as there may be more answers than these two (of 18,000
/// touches with ten times the noise 17 are wrong without a flag by the mean, 6 by single sets).
constexpr int kMostCompared = 4;
constexpr std::uint8_t kTimesRefuted = 3;  ///< in a row, until the rival is forgotten
/// Sets of readings after which others are looked for again while an answer is in doubt.
constexpr std::uint16_t kSearchAgainAfter = 64;
/// If the answer was not in doubt, others are looked for after this many sets in a row that leave doubt. By
/// noise alone, chi-squared of 12 degrees of freedom is beyond 29 (threshold::kDoubt) with p = 0.004, three
/// times in a row with 6e-8.
constexpr std::uint8_t kNewDoubt = 3;

/// Kinds of hypotheses that a search compares.
enum Kind : std::size_t { kSingle, kWithoutOne, kPair };

/// The other solution has another number of contacts, or another place. It is no doubt that leaving a gauge
/// out changes loads and width at the same place.
bool saysOther(const TableConstants& constants, const Solution& answer, const Solution& other) {
  const int contacts = answer.hypothesis.contacts;
  return contacts != other.hypothesis.contacts ||
         areElsewhere(constants, contacts, answer.contact, other.contact);
}

/// Both contacts of a pair press by more than noise (threshold::kFaint), and by a 16th of the other or more.
bool areAllContacts(const Solution& pair, const ScaledReadings& readings) {
  if (pair.hypothesis.contacts < 2) return true;
  const Number first = pair.contact[0].normal, second = pair.contact[1].normal;
  const Wide least = std::min(first, second) / 2;  // the largest reading of the lighter one
  return std::min(first, second) >= std::max(first, second) >> 4 &&
         least * least >= energyOf(readings, threshold::kFaint);
}

/// These contacts in the order in which they are nearest to a solution's.
ContactStates inOrderOf(const Solution& solution, ContactStates contacts) {
  const auto apart = [&](int i, int j) {
    return Wide{apart_q32(solution.contact[index(i)].angle_q32, contacts[index(j)].angle_q32)};
  };
  if (solution.hypothesis.contacts == 2 && apart(0, 1) + apart(1, 0) < apart(0, 0) + apart(1, 1))
    std::swap(contacts[0], contacts[1]);
  return contacts;
}

/// Takes one more set into the mean, in which the rival leaves this much more than the answer.
void compareRival(const TableConstants& constants, Answer& answer, Wide more) {
  const bool isAveraged = answer.solution.hypothesis.contacts == 1 && constants.model_error_q16 != 0;
  const int most = isAveraged ? kMostCompared : 1;
  Rival& rival = answer.rival;
  rival.setsCompared = static_cast<std::uint8_t>(std::min(rival.setsCompared + 1, most));
  rival.more += (more - rival.more) / rival.setsCompared;
}

/// Sets the rival's flags by that mean.
void rate(Rival& rival, const Variances& variances) {
  rival.isAsLikely = rival.more < ambiguity(variances, rival.setsCompared);
  rival.isWithinNoise = rival.more < energyOf(variances.noise_q4, threshold::kAmbiguous) / rival.setsCompared;
}

/// One contact as all gauges read it may be wider than the tables cover: a gauge too many explains that as
/// well.
bool mayBeWider(const Ranking& single) {
  return isWidest(single.best.contact[0]) || (single.anySecond && isWidest(single.second.contact[0]));
}

/// The reading of a gauge that was left out is far from what the others predict.
bool isFarOff(const TableImage& tables, const Solution& solution, const ScaledReadings& readings,
              GaugeSet leftOut, Linearisation& scratch) {
  linearise(tables, solution.hypothesis, solution.contact, scratch);
  const auto gauge = index(std::countr_zero(leftOut));
  const Number off = magnitude(Number{readings.value[gauge]} - scratch.predicted[gauge]);
  return off >= threshold::kCulprit;
}

}  // namespace

void Locator::endTouch() {
  tracking_ = guessed_ = false;
  answer_ = {};
}

void Locator::believe(const TableImage& tables, const Solution& solution, const ScaledReadings& readings) {
  answer_.solution = solution;
  answer_.shift = readings.shift;
  answer_.variances = readings.variances;
  answer_.accepted = isAccepted(tables.constants, solution, readings);
  answer_.weak = isWeak(solution, readings.variances, answer_.weak);
  const bool leavesDoubt = isLookedInto_ ? !isPlainAsBuilt(tables.constants, solution, readings, true)
                                         : !isPlain(tables.constants, solution, readings);
  setsInDoubt_ = static_cast<std::uint8_t>(leavesDoubt ? std::min<int>(setsInDoubt_ + 1, kNewDoubt) : 0);
  tracking_ = true;
}

void Locator::search(const TableImage& tables, const ScaledReadings& readings, GaugeSet gauges) {
  search_.begin(tables, readings, oneContact(tables.constants, gauges, mode_ == FitMode::kRefined));
  searchedAt_q32_ = answer_.solution.contact[0].angle_q32;
  setsSinceSearch_ = 0;
}

/// Where the contacts are expected: one that slid equally far in the last two sets is taken to slide on.
ContactStates Locator::expected(const TableConstants& constants) const {
  ContactStates contacts = answer_.solution.contact;
  for (std::size_t k = 0; k < contacts.size(); ++k)
    if (isShortTurn(constants, slid_q32_[k] - slidBefore_q32_[k])) contacts[k].angle_q32 += slid_q32_[k];
  return contacts;
}

/// Steps from the linear model around an earlier answer, moved to where the contacts are expected, or to
/// where a step led, if that is too far away for it. Returns the work it took; nothing if the answer is lost.
std::optional<int> Locator::follow(const TableImage& tables, const ScaledReadings& readings,
                                   GaugeSet gauges) {
  Hypothesis& hypothesis = answer_.solution.hypothesis;
  const bool areFewer = (hypothesis.gauges & ~gauges) != 0;
  hypothesis.gauges &= gauges;
  if (areFewer && ((hypothesis.exact & ~gauges) != 0 || freedoms(hypothesis) < 1)) return std::nullopt;
  const ContactStates from = expected(tables.constants);
  int passes = 2;  // counts predictions, with columns or without them, and steps
  if (readings.shift != answer_.shift || areFewer)
    linearise(tables, hypothesis, rescaled(from, answer_.shift, readings.shift), linearisation_,
              readings.weight_q14);
  else if (!isShortTurn(tables.constants, from[0].angle_q32 - linearisation_.at[0].angle_q32))
    move(tables, from, linearisation_, readings.weight_q14);
  else
    passes = 1;
  Solution solution = step(tables, linearisation_, readings);
  const auto workOf = [&](int of) { return (of * Search::stepWork(tables, hypothesis) + 1) / 2; };
  const int mostSteps = search_.isBegun() ? kStepsWhileSearching : kFollowingSteps;
  const int mostWork = search_.isBegun() ? Search::kWork : kFollowingWork;
  for (int steps = 1; !solution.converged; ++steps) {
    if (workOf(passes + kDescentMoves + 1) > mostWork) break;
    passes += descend(tables, readings, linearisation_, solution);
    if (solution.converged || steps == mostSteps) break;
    solution = step(tables, linearisation_, readings);
    ++passes;
  }
  const bool wasAccepted = answer_.accepted;
  if (readings.shift != answer_.shift || areFewer) answer_.rival.setsCompared = 0;  // of other readings
  answer_.rival.contact = rescaled(answer_.rival.contact, answer_.shift, readings.shift);
  slidBefore_q32_ = slid_q32_;
  for (std::size_t k = 0; k < solution.contact.size(); ++k) {
    slid_q32_[k] = solution.contact[k].angle_q32 - answer_.solution.contact[k].angle_q32;
    answer_.rival.contact[k].angle_q32 += slid_q32_[k];
  }
  believe(tables, solution, readings);
  const bool isLost = wasAccepted && !answer_.accepted && !answer_.searching &&
                      solution.residualEnergy > energyOf(readings, threshold::kLost * threshold::kGate);
  if (isLost) return std::nullopt;
  const int back = takeBack(tables, readings, gauges);
  return workOf(passes) + (back != 0 ? back : followRival(tables, readings));
}

/// Gauges that work, feel the touch and were left out count again once an answer explains their readings,
/// too. Returns the work it took.
int Locator::takeBack(const TableImage& tables, const ScaledReadings& readings, GaugeSet gauges) {
  Hypothesis hypothesis = answer_.solution.hypothesis;
  if (hypothesis.gauges == gauges || hypothesis.exact != 0 || search_.isBegun()) return 0;
  if (!answer_.accepted || ++setsLeftOut_ % kRivalEvery != 0) return 0;
  for (GaugeSet left = gauges & ~hypothesis.gauges; left != 0; left &= left - 1) {
    const int gauge = std::countr_zero(left);
    if (magnitude(linearisation_.predicted[index(gauge)]) >= threshold::kFelt)
      hypothesis.gauges |= GaugeSet{1} << gauge;
  }
  if (hypothesis == answer_.solution.hypothesis) return 0;
  linearise(tables, hypothesis, answer_.solution.contact, scratch_, readings.weight_q14);
  const Solution solution = step(tables, scratch_, readings);
  if (isPlain(tables.constants, solution, readings)) {
    linearisation_ = scratch_;
    answer_.doubtful = answer_.several = false;
    answer_.suspect = 0;
    answer_.rival.setsCompared = 0;
    believe(tables, solution, readings);
  }
  return Search::stepWork(tables, hypothesis);
}

/// Fits the rival now and then, until the touch has told which of the two is right. Weak readings may allow
/// both in one sample set and only one, perhaps the wrong one, in the next: the rival's flags hold until it
/// is refuted several times in a row, or a search has looked for it. Returns the work it took.
int Locator::followRival(const TableImage& tables, const ScaledReadings& readings) {
  if (!answer_.rival.any || ++setsSinceRival_ % kRivalEvery != 0) return 0;
  const Solution answer = answer_.solution;
  const Hypothesis& hypothesis = answer.hypothesis;
  linearise(tables, hypothesis, answer_.rival.contact, scratch_, readings.weight_q14);
  const Solution rival = step(tables, scratch_, readings);
  const Wide more = likelihoodEnergy(tables.constants, rival, readings) -
                    likelihoodEnergy(tables.constants, answer, readings);
  const int contacts = hypothesis.contacts;
  const bool isMerged =
      areSame(tables.constants, contacts, answer.contact, rival.contact) ||
      (answer_.rival.isElsewhere && !areElsewhere(tables.constants, contacts, answer.contact, rival.contact));
  const Wide refuted = threshold::kRefuted * ambiguity(readings.variances);
  const bool isRefuted = more > refuted;
  // One set with a large difference, by a spike or while the touch moves, must not outweigh those after it.
  if (!isMerged) compareRival(tables.constants, answer_, std::min(more, refuted));
  answer_.rival.isLost = isMerged || isRefuted;
  if (answer_.rival.isLost) {
    if (!isMerged) answer_.rival.contact = rival.contact;
    const bool hasTold = isRefuted && ++answer_.rival.timesRefuted == kTimesRefuted;
    if (hasTold || isFirm(tables.constants, answer, readings)) answer_.rival = {};
    return Search::stepWork(tables, hypothesis);
  }
  answer_.rival.timesRefuted = 0;
  answer_.rival.contact = rival.contact;
  const bool isLikelier = answer_.rival.more < 0 && (rival.converged || answer_.rival.setsCompared > 1);
  if (isLikelier) answer_.rival.more = -answer_.rival.more;
  rate(answer_.rival, readings.variances);
  if (isLikelier) {
    // The answers change places, which is no motion of the touch since the search began.
    searchedAt_q32_ += rival.contact[0].angle_q32 - answer.contact[0].angle_q32;
    answer_.rival.contact = answer.contact;
    linearisation_ = scratch_;
    believe(tables, rival, readings);
  }
  return Search::stepWork(tables, hypothesis);
}

void Locator::start(const TableImage& tables, const ScaledReadings& readings, GaugeSet gauges) {
  answer_ = {};
  isLookedInto_ = false;
  slid_q32_ = slidBefore_q32_ = {};
  search_.stop();
  const Hypothesis hypothesis = oneContact(tables.constants, gauges, mode_ == FitMode::kRefined);
  const ContactStates guess = initialGuess(tables, hypothesis, readings, linearisation_);
  believe(tables, fit(tables, hypothesis, guess, readings, 1, linearisation_), readings);
  guessed_ = answer_.searching = true;
}

/// Completes the fit that start() began; begins a search if that leaves doubt or is not firm.
void Locator::settle(const TableImage& tables, const ScaledReadings& readings) {
  guessed_ = false;
  const Hypothesis hypothesis = answer_.solution.hypothesis;
  const ContactStates from = rescaled(answer_.solution.contact, answer_.shift, readings.shift);
  believe(tables, fit(tables, hypothesis, from, readings, kMostSteps, linearisation_), readings);
  answer_.searching = !isPlain(tables.constants, answer_.solution, readings) ||
                      !isFirm(tables.constants, answer_.solution, readings);
  if (answer_.searching) search(tables, readings, hypothesis.gauges);
  noteLook(readings.shift);
}

/// The most likely of the hypotheses that were looked at: each must take more off chi-squared than its
/// additional unknowns would by chance. Returns false if there is none.
bool Locator::conclude(const TableImage& tables) {
  const ScaledReadings& readings = search_.readings();
  const std::array rankings{&search_.single(), &search_.withoutOne(), &search_.pair()};
  constexpr std::array<int, 3> kPrice{0, threshold::kLeftOut, threshold::kSecondContact};
  const auto costOf = [&](std::size_t i) {
    return rankings[i]->best.residualEnergy + energyOf(readings, kPrice[i]);
  };
  // Noise may move a fit beyond the friction cone, most of all that of a faint second contact: it is not
  // believed, but leaves doubt.
  std::array<bool, 3> explains{}, mayExplain{};
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < rankings.size(); ++i) {
    if (!rankings[i]->anyBest) continue;
    mayExplain[i] = isWithinGate(rankings[i]->best, readings) && areAllContacts(rankings[i]->best, readings);
    explains[i] = mayExplain[i] && isAdmissible(tables.constants, rankings[i]->best);
    if (!best || explains[i] > explains[*best] ||
        (explains[i] == explains[*best] && costOf(i) < costOf(*best)))
      best = i;
  }
  answer_.searching = answer_.doubtful = answer_.several = false;
  answer_.suspect = 0;
  answer_.rival = {};
  if (!best) return false;
  const Solution& answer = rankings[*best]->best;
  answer_.doubtful = !isPlainAsBuilt(tables.constants, answer, readings);
  for (std::size_t i = 0; i < rankings.size(); ++i)
    answer_.doubtful |= i != *best && mayExplain[i] &&
                        saysOther(tables.constants, answer, rankings[i]->best) &&
                        costOf(i) - costOf(*best) < ambiguity(readings.variances);
  const bool isWithoutOne = *best == kWithoutOne;
  answer_.several = *best == kPair || (isWithoutOne && !explains[kWithoutOne]);
  if (isWithoutOne && (tables.constants.spacing == RingSpacing::kSparse ||
                       (mayExplain[kSingle] && mayBeWider(search_.single()))))
    answer_.doubtful = true;
  else if (isWithoutOne && !(mayExplain[kPair] && answer_.doubtful))
    answer_.suspect = culprit(tables);
  answer_.exchanged = isSecondFirst(answer);
  believe(tables, answer, readings);
  rememberRival(tables, *rankings[*best], readings);
  return true;
}

/// Of two contacts, the second is where one was told before the other joined.
bool Locator::isSecondFirst(const Solution& solution) const {
  const auto off_q32 = [&](int i) {
    return apart_q32(solution.contact[index(i)].angle_q32, std::uint32_t{toldAt_q16_} << 16);
  };
  return solution.hypothesis.contacts == 2 && off_q32(1) < off_q32(0);
}

/// The gauge that the best answer leaves out, if no other one would do as well and its reading is far off.
GaugeSet Locator::culprit(const TableImage& tables) {
  if (!search_.single().anyBest) return 0;
  const Ranking& without = search_.withoutOne();
  const GaugeSet leftOut = search_.single().best.hypothesis.gauges & ~without.best.hypothesis.gauges;
  const bool isOnlyOne = !without.anySecond || without.second.residualEnergy - without.best.residualEnergy >=
                                                   energyOf(search_.readings(), threshold::kCulpritMargin);
  return isOnlyOne && isFarOff(tables, without.best, search_.readings(), leftOut, scratch_) ? leftOut : 0;
}

void Locator::rememberRival(const TableImage& tables, const Ranking& ranking,
                            const ScaledReadings& readings) {
  if (!ranking.anySecond || ranking.second.hypothesis != ranking.best.hypothesis) return;
  answer_.rival.contact = inOrderOf(ranking.best, ranking.second.contact);
  const Wide more = likelihoodEnergy(tables.constants, ranking.second, readings) -
                    likelihoodEnergy(tables.constants, ranking.best, readings);
  if (more > threshold::kRefuted * ambiguity(readings.variances)) return;
  answer_.rival.any = true;
  compareRival(tables.constants, answer_, more);
  rate(answer_.rival, readings.variances);
  answer_.rival.isElsewhere = areElsewhere(tables.constants, ranking.best.hypothesis.contacts,
                                           ranking.best.contact, answer_.rival.contact);
}

/// The answer that was followed explains these readings better than what a search found, which then is its
/// rival and counts as not told apart until it is fitted itself.
void Locator::rememberFound(const TableConstants& constants, const Solution& followed, const Solution& found,
                            const ScaledReadings& readings) {
  if (!areElsewhere(constants, followed.hypothesis.contacts, followed.contact, found.contact)) return;
  if (!isPromising(constants, found) ||
      found.residualEnergy - followed.residualEnergy > threshold::kRefuted * ambiguity(readings.variances))
    return;
  answer_.rival.contact = inOrderOf(followed, found.contact);
  answer_.rival.setsCompared = 0;
  answer_.rival.any = answer_.rival.isAsLikely = answer_.rival.isElsewhere = answer_.rival.isWithinNoise =
      true;
}

/// Goes on with the search, or concludes it, with what is left of an update's work.
void Locator::goOn(const TableImage& tables, const ScaledReadings& readings, int workDone) {
  if (!search_.isDone()) return search_.advance(tables, Search::kWork - workDone, scratch_);
  // If the rival was fitted to this set, there may be no work left: then with the next set.
  const auto stepsLeft = [&] {
    return (kWorkAfterSearch - workDone) / Search::stepWork(tables, answer_.solution.hypothesis) - 1;
  };
  if (stepsLeft() < 1) return;
  const Solution followed = answer_.solution;
  isLookedInto_ = search_.withoutOne().anyBest;
  const bool isFound = conclude(tables);
  search_.stop();
  // The touch may have moved since the search began: what was found is moved as the followed answer was.
  const Hypothesis hypothesis = answer_.solution.hypothesis;
  ContactStates from = rescaled(answer_.solution.contact, answer_.shift, readings.shift);
  answer_.rival.contact = rescaled(answer_.rival.contact, answer_.shift, readings.shift);
  if (answer_.shift != readings.shift) answer_.rival.setsCompared = 0;
  const std::uint32_t moved_q32 = isFound ? followed.contact[0].angle_q32 - searchedAt_q32_ : 0;
  for (ContactState& contact : from) contact.angle_q32 += moved_q32;
  for (ContactState& contact : answer_.rival.contact) contact.angle_q32 += moved_q32;
  const int steps = std::clamp(stepsLeft(), 1, kStepsAfterSearch);
  Solution now = fit(tables, hypothesis, from, readings, steps, linearisation_);
  if (followed.hypothesis == hypothesis && likelihoodEnergy(tables.constants, followed, readings) <=
                                               likelihoodEnergy(tables.constants, now, readings)) {
    rememberFound(tables.constants, followed, now, readings);
    now = fit(tables, hypothesis, followed.contact, readings, 1, linearisation_);
  }
  believe(tables, now, readings);
  noteLook(search_.readings().shift);
}

std::optional<Suspect> Locator::lookBack(const TableImage& tables) {
  if (!search_.isDone()) {
    search_.advance(tables, Search::kWork, scratch_);
    return std::nullopt;
  }
  const bool isFound = conclude(tables);
  const Answer found = answer_;
  release();
  // If the contact is weak or not accepted, one gauge's spike may be all there was.
  if (!isFound || !found.accepted || found.weak || found.suspect == 0) return std::nullopt;
  return Suspect{found.suspect, found.solution.contact[0].angle_q32};
}

void Locator::noteLook(int shift) {
  lookedShift_ = static_cast<std::int8_t>(shift);
  lookedMoment_q20_ = answer_.solution.contact[0].moment_q20;
}

/// Since others were last looked for, the touch has got quite another width: it was followed to another
/// answer.
bool Locator::hasOtherWidth() const {
  return magnitude(answer_.solution.contact[0].moment_q20 - lookedMoment_q20_) >
         1 << (kMomentBits - threshold::kOtherWidthBits);
}

/// That, or the readings have outgrown their scale, by two at most (four if it was kept while they fell), so
/// that others may be told apart.
bool Locator::isLookOutdated(const ScaledReadings& readings) const {
  return readings.shift > lookedShift_ || hasOtherWidth();
}

/// Solves exactly the three readings that determine the place and both loads best, unless that leads to
/// another place than all readings do.
void Locator::solveExactly(const TableImage& tables, const ScaledReadings& readings) {
  Hypothesis hypothesis = answer_.solution.hypothesis;
  if (hypothesis.contacts > 1 || hypothesis.exact != 0 || !answer_.accepted) return;
  const Solution byAll = answer_.solution;
  linearise(tables, {1, false, hypothesis.gauges}, answer_.solution.contact, linearisation_,
            readings.weight_q14);
  const auto& column = linearisation_.column;
  std::array<std::uint8_t, kMaxGauges> near;
  int rows = 0;
  for (int gauge = 0; gauge < tables.constants.gauge_count; ++gauge)
    if (contains(hypothesis.gauges, gauge) && isInReach(tables, byAll.contact[0], gauge))
      near[index(rows++)] = static_cast<std::uint8_t>(gauge);
  Wide most = -1;
  for (int i = 0; i < rows; ++i)
    for (int j = i + 1; j < rows; ++j) {
      const std::size_t a = near[index(i)], b = near[index(j)];
      const auto minor = [&](std::size_t m, std::size_t n) {
        return column[m][a] * column[n][b] - column[n][a] * column[m][b];
      };
      const Number x = minor(1, 2), y = minor(2, 0), z = minor(0, 1);
      for (int k = j + 1; k < rows; ++k) {
        const std::size_t c = near[index(k)];
        const Wide determinant =
            magnitude(Wide{x} * column[0][c] + Wide{y} * column[1][c] + Wide{z} * column[2][c]);
        if (determinant <= most) continue;
        most = determinant;
        hypothesis.exact = GaugeSet{1} << a | GaugeSet{1} << b | GaugeSet{1} << c;
      }
    }
  const Solution byThree = fit(tables, hypothesis, byAll.contact, readings, kStepsOfThree, linearisation_);
  const bool isSamePlace =
      apart_q32(byThree.contact[0].angle_q32, byAll.contact[0].angle_q32) <= pitch_q32(tables.constants) / 16;
  if (isSamePlace && isAdmissible(tables.constants, byThree)) return believe(tables, byThree, readings);
  linearise(tables, byAll.hypothesis, byAll.contact, linearisation_, readings.weight_q14);
}

void Locator::finishSearch(const TableImage& tables, std::span<const std::int32_t> strains_q32,
                           GaugeSet gauges) {
  const ScaledReadings readings =
      scaledReadings(tables.constants, strains_q32, gauges, kConfiguredNoise_q4, answer_.shift);
  if (guessed_) settle(tables, readings);
  while (search_.isBegun()) goOn(tables, readings, 0);
  const Solution found = answer_.solution;
  if (!found.converged)
    believe(tables, fit(tables, found.hypothesis, found.contact, readings, kLastSteps, linearisation_),
            readings);
  if (mode_ == FitMode::kThreePoint) solveExactly(tables, readings);
}

void Locator::update(const TableImage& tables, std::span<const std::int32_t> strains_q32, GaugeSet gauges,
                     std::uint32_t noise_q4, Number beyond_q32) {
  const ScaledReadings readings = scaledReadings(tables.constants, strains_q32, gauges, noise_q4,
                                                 tracking_ ? answer_.shift : -1, beyond_q32);
  if (answer_.accepted)
    toldAt_q16_ =
        static_cast<std::uint16_t>(answer_.solution.contact[index(answer_.indexOf(0))].angle_q32 >> 16);
  if (!tracking_ || (guessed_ && (answer_.solution.hypothesis.gauges & ~gauges) != 0))
    return start(tables, readings, gauges);
  if (guessed_) return settle(tables, readings);
  const std::optional<int> workDone = follow(tables, readings, gauges);
  if (!workDone) {
    tracking_ = false;  // start() with the next set
    search_.stop();
    answer_.searching = true;
    return;
  }
  if (search_.isBegun()) {
    if (readings.shift > search_.readings().shift)
      search(tables, readings, gauges);  // a firmer touch tells more
    goOn(tables, readings, *workDone);
  } else if ((setsInDoubt_ == kNewDoubt && !answer_.doubtful) ||
             (hasOtherWidth() && tables.constants.model_error_q16 <= threshold::kWellKnown_q16 &&
              !isFirm(tables.constants, answer_.solution, readings))) {
    answer_.searching = true;
    search(tables, readings, gauges);
  } else if (!answer_.accepted || answer_.doubtful || answer_.rival.isLost ||
             areTooNear(tables.constants, answer_.solution) || !areAllContacts(answer_.solution, readings) ||
             (isLookOutdated(readings) && !isFirm(tables.constants, answer_.solution, readings))) {
    if (++setsSinceSearch_ >= kSearchAgainAfter) search(tables, readings, gauges);
  }
  if (mode_ == FitMode::kThreePoint && !search_.isBegun()) solveExactly(tables, readings);
}

void locateOnce(const TableImage& tables, std::span<const std::int32_t> strains_q32, GaugeSet gauges,
                Locator& locator) {
  locator.release();
  locator.update(tables, strains_q32, gauges);
  locator.finishSearch(tables, strains_q32, gauges);
}

}  // namespace strainfinger::firmware
