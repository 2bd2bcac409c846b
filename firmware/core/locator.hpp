#pragma once
// Follows the contacts of a finger from one set of readings to the next.

#include <cstdint>
#include <optional>
#include <span>

#include "firmware/core/fit.hpp"
#include "firmware/core/judge.hpp"
#include "firmware/core/search.hpp"

namespace strainfinger::firmware {

/// How the contacts are fitted.
enum class FitMode : std::uint8_t {
  kThreePoint,  ///< as in the paper: three readings are solved exactly, the others judge; the width is known
  kRefined,     ///< all readings are fitted
};

/// A gauge without which one contact explains the readings, if nothing else does.
struct Suspect {
  GaugeSet gauge;
  std::uint32_t angle_q32;  ///< of the contact
};

/// The second best answer, of the same hypothesis.
struct Rival {
  ContactStates contact;
  bool any = false;            ///< there is one
  bool isAsLikely = false;     ///< nearly as likely as the answer when it was last fitted: see ambiguity()
  bool isWithinNoise = false;  ///< so nearly that noise alone may have favoured the wrong one
  bool isElsewhere = false;    ///< it was found at another place, not with another width at the same place
  bool isLost = false;         ///< it was refuted, or merged with the answer: a search is to look for it
  std::uint8_t timesRefuted = 0;
  std::uint8_t setsCompared = 0;  ///< sets in the mean of `more`, at most kMostCompared; 0: begin anew
  Wide more = 0;                  ///< mean energy that it leaves more than the answer
};

/// What the locator believes.
struct Answer {
  Solution solution;
  std::int8_t shift = 0;  ///< of the readings
  Variances variances;
  Rival rival;
  bool doubtful = false;   ///< it leaves doubt, or another hypothesis explains the readings nearly as well
  bool accepted = false;   ///< the hypothesis explains the readings
  bool weak = false;       ///< a contact is felt by little more than noise
  bool searching = false;  ///< the search for other hypotheses goes on
  bool several = false;    ///< two contacts explain the readings best; or one without a gauge, but not well
  bool exchanged = false;  ///< the second of two contacts is told as the first: it was there first
  GaugeSet suspect = 0;    ///< see Suspect; 0: none

  /// The index in the solution of the contact that is told as the first (0) or the second (1). The solution
  /// keeps its own order, as it decides by which unknowns others are limited.
  int indexOf(int told) const { return exchanged ? 1 - told : told; }
};

/// Follows the last answer while it explains the readings, else starts from the readings alone; where the
/// answer leaves doubt, searches for others over several sets of readings. Cost of an update: see
/// firmware/cost.md.
class Locator {
 public:
  explicit Locator(FitMode mode) : mode_(mode) {}

  /// One set of strains of a touched ring. `gauges`: those that work and are within their range; `noise_q4`:
  /// the noise's variance over the configured one [* 2^4]; `beyond_q32`: see scaledReadings().
  void update(const TableImage& tables, std::span<const std::int32_t> strains_q32, GaugeSet gauges,
              std::uint32_t noise_q4 = kConfiguredNoise_q4, Number beyond_q32 = 0);
  /// Completes the search that update() began, with the same strains.
  void finishSearch(const TableImage& tables, std::span<const std::int32_t> strains_q32, GaugeSet gauges);
  /// Forgets the touch and ends its search.
  void release() {
    endTouch();
    search_.stop();
  }
  /// The touch has ended: the answer is forgotten, but a search goes on with the readings that it has: see
  /// lookBack().
  void endTouch();
  /// Does a part of the search that goes on after endTouch(): once a sample set, while isSearching(). When
  /// the search is over, returns the suspect, if there is one. Cost: that of an update, while it goes on.
  std::optional<Suspect> lookBack(const TableImage& tables);

  const Answer& answer() const { return answer_; }
  /// Other answers are being looked for, whether or not Answer::searching says that the answer is doubted.
  bool isSearching() const { return search_.isBegun(); }
  /// Another update with the same readings would not improve the answer: its fit has converged, and no search
  /// is due at once.
  bool isSettled() const {
    return answer_.accepted && answer_.solution.converged && !isSearching() && !answer_.searching &&
           (setsInDoubt_ == 0 || answer_.doubtful);
  }
  /// The linear model around the answer, from which the answer's errors are computed.
  const Linearisation& linearisation() const { return linearisation_; }
  /// Work space that other fits may use between updates, so that they need none of their own.
  Linearisation& scratch() { return scratch_; }

 private:
  ContactStates expected(const TableConstants& constants) const;
  std::optional<int> follow(const TableImage& tables, const ScaledReadings& readings, GaugeSet gauges);
  void start(const TableImage& tables, const ScaledReadings& readings, GaugeSet gauges);
  void settle(const TableImage& tables, const ScaledReadings& readings);
  void goOn(const TableImage& tables, const ScaledReadings& readings, int workDone);
  void search(const TableImage& tables, const ScaledReadings& readings, GaugeSet gauges);
  int takeBack(const TableImage& tables, const ScaledReadings& readings, GaugeSet gauges);
  bool conclude(const TableImage& tables);
  bool isSecondFirst(const Solution& solution) const;
  GaugeSet culprit(const TableImage& tables);
  void rememberRival(const TableImage& tables, const Ranking& ranking, const ScaledReadings& readings);
  void rememberFound(const TableConstants& constants, const Solution& followed, const Solution& found,
                     const ScaledReadings& readings);
  int followRival(const TableImage& tables, const ScaledReadings& readings);
  void noteLook(int shift);
  bool hasOtherWidth() const;
  bool isLookOutdated(const ScaledReadings& readings) const;
  void believe(const TableImage& tables, const Solution& solution, const ScaledReadings& readings);
  void solveExactly(const TableImage& tables, const ScaledReadings& readings);

  Search search_;
  Linearisation linearisation_;
  Linearisation scratch_;
  Answer answer_;
  /// By how much the contacts turned with the last set, and with the one before it.
  std::array<std::uint32_t, kMostContacts> slid_q32_{}, slidBefore_q32_{};
  FitMode mode_;
  bool tracking_ = false;
  bool isLookedInto_ = false;     ///< the last search tried leaving gauges out
  bool guessed_ = false;          ///< the answer is an initial guess that settle() is to fit
  std::uint8_t setsInDoubt_ = 0;  ///< in a row, counted up to where a search begins
  std::uint8_t setsSinceRival_ = 0;
  std::uint8_t setsLeftOut_ = 0;  ///< sets in which the answer left gauges out
  std::uint16_t setsSinceSearch_ = 0;
  std::uint32_t searchedAt_q32_ = 0;  ///< where the answer was when the search began
  Number lookedMoment_q20_ = 0;       ///< of the answer when others were last looked for
  std::int8_t lookedShift_ = 0;       ///< of the readings then
  std::uint16_t toldAt_q16_ = 0;      ///< the place of the first contact of the last accepted answer
};

/// The answer to one set of strains alone: an update and the whole search.
void locateOnce(const TableImage& tables, std::span<const std::int32_t> strains_q32, GaugeSet gauges,
                Locator& locator);

}  // namespace strainfinger::firmware
