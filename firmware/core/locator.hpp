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
  kThreePoint,  ///< the paper's: three readings are solved exactly, the others decide; the width is known
  kRefined,     ///< all readings
};

/// A gauge without which one contact explains the readings, and nothing else does.
struct Suspect {
  GaugeSet gauge;
  std::uint32_t angle_q32;  ///< of the contact
};

/// Another answer of the same hypothesis.
struct Rival {
  ContactStates contact;
  bool any = false;            ///< there is one
  bool isAsLikely = false;     ///< nearly, when it was last fitted, see ambiguity()
  bool isWithinNoise = false;  ///< besides: noise alone may have told the wrong one
  bool isElsewhere = false;    ///< when it was found, not another width of the same place
  bool isLost = false;         ///< a search is to look for it
  std::uint8_t timesRefuted = 0;
  std::uint8_t setsCompared = 0;  ///< differences in `more`, at most kMostCompared; 0: begin anew
  Wide more = 0;                  ///< energy that it leaves more than the answer, in their mean
};

/// What the locator believes.
struct Answer {
  Solution solution;
  std::int8_t shift = 0;  ///< of the readings
  Variances variances;
  Rival rival;
  bool doubtful = false;   ///< another hypothesis explains the readings nearly as well
  bool accepted = false;   ///< the hypothesis explains the readings
  bool weak = false;       ///< a contact is felt by little more than noise
  bool searching = false;  ///< the search for other hypotheses goes on
  bool several = false;    ///< two contacts, or nothing, explain the readings best
  GaugeSet suspect = 0;    ///< as Suspect has it
};

/// Starts from the last answer where it still explains the readings, else from the readings; searches where
/// that leaves doubt, over several sets of readings. Cost of an update: see firmware/cost.md.
class Locator {
 public:
  explicit Locator(FitMode mode) : mode_(mode) {}

  /// One set of strains of a touched ring. `gauges`: those that work and are within their range; `noise_q4`:
  /// variance of a reading in configured ones [* 2^4]; `beyond_q32`: see scaledReadings().
  void update(const TableImage& tables, std::span<const std::int32_t> strains_q32, GaugeSet gauges,
              std::uint32_t noise_q4 = kConfiguredNoise_q4, Number beyond_q32 = 0);
  /// The whole of a search that update() began, with the same strains.
  void finishSearch(const TableImage& tables, std::span<const std::int32_t> strains_q32, GaugeSet gauges);
  /// Forgets the touch, and a search with it.
  void release() {
    endTouch();
    search_.stop();
  }
  /// Nothing touches the finger any more: the answer is forgotten, while a search goes on with the readings
  /// that it has (lookBack()).
  void endTouch();
  /// After endTouch(), while isSearching(), once a sample set: a part of the search that goes on. Once it is
  /// over, the gauge without which one contact explains its readings, if there is one. Cost: that of an
  /// update, while it goes on.
  std::optional<Suspect> lookBack(const TableImage& tables);

  const Answer& answer() const { return answer_; }
  /// Other answers are being looked for, whether or not the answer is doubted meanwhile (Answer::searching).
  bool isSearching() const { return search_.isBegun(); }
  /// Another update with the same readings would change nothing.
  bool isSettled() const {
    return answer_.accepted && answer_.solution.converged && !isSearching() && !answer_.searching &&
           (setsInDoubt_ == 0 || answer_.doubtful);
  }
  /// The linear model around the answer, of which its errors are.
  const Linearisation& linearisation() const { return linearisation_; }
  /// Work space between updates, so that who else fits needs none of its own.
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
  GaugeSet culprit(const TableImage& tables);
  void rememberRival(const TableImage& tables, const Ranking& ranking, const ScaledReadings& readings);
  void rememberFound(const TableConstants& constants, const Solution& followed, const Solution& found,
                     const ScaledReadings& readings);
  int followRival(const TableImage& tables, const ScaledReadings& readings);
  void noteLook(int shift);
  bool isLookOutdated(const ScaledReadings& readings) const;
  void believe(const TableImage& tables, const Solution& solution, const ScaledReadings& readings);
  void solveExactly(const TableImage& tables, const ScaledReadings& readings);

  Search search_;
  Linearisation linearisation_;
  Linearisation scratch_;
  Answer answer_;
  /// By how much the contacts turned from set to set, the last time and before.
  std::array<std::uint32_t, kMostContacts> slid_q32_{}, slidBefore_q32_{};
  FitMode mode_;
  bool tracking_ = false;
  bool isLookedInto_ = false;     ///< gauges were left out by the last search
  bool guessed_ = false;          ///< the answer is where a fit starts
  std::uint8_t setsInDoubt_ = 0;  ///< in a row, up to where a search begins
  std::uint8_t setsSinceRival_ = 0;
  std::uint8_t setsLeftOut_ = 0;  ///< in which the answer left gauges out
  std::uint16_t setsSinceSearch_ = 0;
  std::uint32_t searchedAt_q32_ = 0;  ///< where the answer was when the search began
  Number lookedMoment_q20_ = 0;       ///< of the answer when others had been looked for
  std::int8_t lookedShift_ = 0;       ///< of the readings then
};

/// The answer to one set of strains alone: an update and the whole search.
void locateOnce(const TableImage& tables, std::span<const std::int32_t> strains_q32, GaugeSet gauges,
                Locator& locator);

}  // namespace strainfinger::firmware
