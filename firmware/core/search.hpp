#pragma once
// Searches, in pieces that fit into sample periods, for the contacts that explain one set of readings.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>

#include "firmware/core/fit.hpp"
#include "firmware/core/judge.hpp"

namespace strainfinger::firmware {

/// Two fits of this many contacts led to the same answer, whatever the order of their contacts.
bool areSame(const TableConstants& constants, int contacts, const ContactStates& a, const ContactStates& b);

/// Some contact of one fit is at another place than those of the other (threshold::kElsewhere_16), whatever
/// their widths.
bool areElsewhere(const TableConstants& constants, int contacts, const ContactStates& a,
                  const ContactStates& b);

/// The most likely solution and a second one: the most likely at another place if the readings hardly tell it
/// from the best, else the next best, which may be another width at the same place.
struct Ranking {
  Solution best;
  Solution second;
  bool anyBest = false;
  bool anySecond = false;

  /// Enters a solution. One that is not admissible counts as if it left threshold::kInadmissible more.
  void take(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings);
};

/// The entries with the least residual energy, the best first.
template <typename Entry, std::size_t most>
class BestFirst {
 public:
  int size() const { return count_; }
  Entry& operator[](int i) { return entry_[index(i)]; }
  const Entry& operator[](int i) const { return entry_[index(i)]; }
  void clear() { count_ = 0; }
  /// `atMost` of them are kept, within `most`.
  void insert(const Entry& entry, int atMost = static_cast<int>(most)) {
    int place = count_;
    while (place > 0 && entry.residualEnergy < (*this)[place - 1].residualEnergy) --place;
    if (place == atMost) return;
    if (count_ < atMost) ++count_;
    for (int i = count_ - 1; i > place; --i) (*this)[i] = (*this)[i - 1];
    (*this)[place] = entry;
  }
  template <typename IsRemoved>
  void remove(IsRemoved isRemoved) {
    int kept = 0;
    for (int i = 0; i < count_; ++i)
      if (!isRemoved((*this)[i])) (*this)[kept++] = (*this)[i];
    count_ = static_cast<std::uint8_t>(kept);
  }

 private:
  std::array<Entry, most> entry_;
  std::uint8_t count_ = 0;
};

/// The points, places and widths, at which the contacts of a hypothesis are looked for.
class Grid {
 public:
  enum class Kind : std::uint8_t {
    kCoarse,  ///< within two pitches of where the ring reads most, by quarters of a pitch, two widths
    kFine,    ///< the same by sixths of a pitch, five widths
    kPairs,   ///< two places round the ring, or one with a single contact's answer, by half pitches
    kBeside,  ///< a pair with one contact moved by half a pitch or a pitch
  };

  Grid() = default;
  /// For one contact.
  Grid(const TableImage& tables, const Hypothesis& hypothesis, const ScaledReadings& readings, Kind kind);
  /// For two contacts anywhere, one of which may be as in the answers with a single contact.
  Grid(const TableConstants& constants, bool widthIsFree, const Ranking& single);
  /// For two contacts beside the best pair.
  Grid(const TableConstants& constants, bool widthIsFree, const ContactStates& pair);

  int size() const { return rows_ * columns_; }
  ContactStates at(const TableImage& tables, int point) const;
  /// Neighbours are adjacent places with the same width, of a fine grid with free width. Where the width is
  /// known none are: lines are so narrow that each place may lead elsewhere.
  bool areNeighbours(int a, int b) const {
    return kind_ == Kind::kFine && widthIsFree_ && a % columns_ == b % columns_ &&
           magnitude(Number{a - b}) <= columns_;
  }

 private:
  struct Known {
    std::uint32_t angle_q32;
    Number moment_q20;
  };

  std::uint32_t first_q32_ = 0;  ///< the first place
  std::uint32_t step_q32_ = 0;
  std::array<Known, 2> known_{};  ///< single contacts' answers, or the contacts of a pair
  /// One contact: a row is a place, its columns are widths. Pairs: a row is a place of the first contact
  /// round the ring, its columns are second places up to half way round from there. Two more rows, each with
  /// half of the ring, are for each single contact's answer.
  std::int16_t rows_ = 0, columns_ = 1;
  Kind kind_ = Kind::kCoarse;
  bool widthIsFree_ = true;
};

/// An initial guess from the readings alone: the best point of a coarse grid. If there was another guess
/// before, points nearer to it than threshold::kOtherStart_16 are passed over.
ContactStates initialGuess(const TableImage& tables, const Hypothesis& hypothesis,
                           const ScaledReadings& readings, Linearisation& scratch,
                           std::optional<std::uint32_t> otherStart_q32 = {});

/// Looks at one contact; if that leaves doubt, at one contact without each gauge in turn, then at two
/// contacts, and last beside the best pair, because near every contact there may be a second answer of
/// another width. For each hypothesis many points are looked at, the best of them get their first
/// Gauss-Newton steps, and the best candidates that these lead to are refined. advance() does a part of that.
class Search {
 public:
  /// `hypothesis`: one contact, read by all gauges that work.
  void begin(const TableImage& tables, const ScaledReadings& readings, const Hypothesis& hypothesis);
  void stop() { stage_ = Stage::kIdle; }
  /// Since begin(), until stop().
  bool isBegun() const { return stage_ != Stage::kIdle; }
  /// There is more to look at.
  bool isRunning() const { return isBegun() && !isDone(); }
  /// All was looked at; its rankings hold until stop().
  bool isDone() const { return stage_ == Stage::kDone; }
  /// Goes on for at most this much work, in the units of kWork.
  void advance(const TableImage& tables, int work, Linearisation& scratch);

  const ScaledReadings& readings() const { return readings_; }
  const Ranking& single() const { return single_; }
  const Ranking& withoutOne() const { return withoutOne_; }
  const Ranking& pair() const { return pair_; }

  /// The work that an update has time for, in units of 530 instructions of a Cortex-M4 with 16 gauges.
  static constexpr int kWork = 128;
  /// The work of a Gauss-Newton step with its linearisation.
  static int stepWork(const TableImage& tables, const Hypothesis& hypothesis) {
    return (hypothesis.contacts == 1 ? 12 : 31) + (tables.depths.areKnown() ? 6 * hypothesis.contacts : 0);
  }

 private:
  enum class Stage : std::uint8_t { kIdle, kSingle, kWithoutOne, kPair, kBeside, kDone };

  /// A grid's point that was looked at.
  struct Point {
    std::uint32_t residualEnergy;  ///< / 2^kPointEnergyBits
    std::int16_t number;
  };
  struct Candidate {
    ContactStates contact;
    Wide residualEnergy;
  };
  static constexpr int kMostPoints = 48, kMostCandidates = 16;

  /// How many points get their first steps, how many of the candidates that these lead to are kept, and how
  /// many of those are refined to the end.
  struct Effort {
    int points, candidates, refined;
  };
  Effort effort() const;

  void beginTask(const Hypothesis& hypothesis, const Grid& grid);
  int nextWork(const TableImage& tables) const;
  void lookAtPoints(const TableImage& tables, int& left, Linearisation& scratch);
  void lookAtNext(const TableImage& tables, const Residual& all, Linearisation& scratch);
  void tryNext(const TableImage& tables, Linearisation& scratch);
  void refineNext(const TableImage& tables, Linearisation& scratch);
  bool isWorseTwin(const TableConstants& constants, int candidate) const;
  bool isRefining() const;
  Ranking& ranking();
  void finishTask(const TableImage& tables, Linearisation& scratch);
  void findSuspects(const TableImage& tables, Linearisation& scratch);
  void withoutNext(const TableImage& tables);
  void finish() { stage_ = Stage::kDone; }

  ScaledReadings readings_;
  Hypothesis all_;         ///< one contact, all gauges
  Hypothesis hypothesis_;  ///< the one that is looked at
  GaugeSet suspects_ = 0;  ///< gauges that are left out, one by one
  Grid grid_;
  Ranking single_, withoutOne_, pair_;
  BestFirst<Point, kMostPoints> bestPoints_;
  BestFirst<Candidate, kMostCandidates> candidates_;
  Candidate reached_;         ///< where first steps led; when refining, the candidate before its last step
  std::int16_t point_ = 0;    ///< of the grid, the next to be looked at
  std::uint8_t tried_ = 0;    ///< points that got their first steps
  std::uint8_t refined_ = 0;  ///< candidates that were refined or passed over
  std::uint8_t steps_ = 0;    ///< of the point or candidate at hand
  std::uint8_t kept_ = 0;     ///< candidates that were refined to the end
  std::uint8_t leftOut_ = 0;  ///< the next gauge that may be left out
  Stage stage_ = Stage::kIdle;
};

}  // namespace strainfinger::firmware
