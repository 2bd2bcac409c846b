#pragma once
// Looks for the contacts that explain a set of readings of which nothing else is known, piece by piece.

#include <array>
#include <cstdint>
#include <optional>

#include "firmware/core/fit.hpp"
#include "firmware/core/judge.hpp"

namespace strainfinger::firmware {

/// Two fits of so many contacts went to the same answer, in whichever order.
bool areSame(const TableConstants& constants, int contacts, const ContactStates& a, const ContactStates& b);

/// Some contact of the one fit is so far from those of the other that it is another touch, whatever the
/// widths.
bool areElsewhere(const TableConstants& constants, int contacts, const ContactStates& a,
                  const ContactStates& b);

/// The most likely solution of a hypothesis, and another: the likeliest elsewhere, if the readings hardly
/// tell it from the best, else the next best, which may be another width of the same place.
struct Ranking {
  Solution best;
  Solution second;
  bool anyBest = false;
  bool anySecond = false;

  /// Takes a solution in. One that is not admissible counts as if it left threshold::kInadmissible more.
  void take(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings);
};

/// Contacts worth refining, the likeliest first. Their order is kept apart from them, so that sorting moves
/// bytes.
struct Candidate {
  ContactStates contact;
  Wide residualEnergy;
};
class Candidates {
 public:
  static constexpr int kMost = 19;

  int size() const { return count_; }
  Candidate& operator[](int i) { return candidate_[order_[index(i)]]; }
  const Candidate& operator[](int i) const { return candidate_[order_[index(i)]]; }
  void clear();
  /// Behind the others; at most kMost in all.
  void add(const ContactStates& contact, Wide residualEnergy = 0) {
    (*this)[count_++] = {contact, residualEnergy};
  }
  /// At its place, instead of worse ones that are its neighbours, unless a better one is; `most` in all.
  template <typename IsNeighbour>
  void insert(const Solution& solution, int most, IsNeighbour isNeighbour);
  void sort();

 private:
  void move(int from, int to);

  std::array<Candidate, kMost> candidate_;
  std::array<std::uint8_t, kMost> order_{};  ///< slots of candidate_: those in use, then the free ones
  std::uint8_t count_ = 0;
};

/// Where to look for the contacts of a hypothesis.
class Grid {
 public:
  enum class Kind : std::uint8_t {
    kCoarse,  ///< two pitches around where the ring reads most, by quarters of a pitch, two widths
    kFine,    ///< by eighths, five widths
    kRing,    ///< all round the ring by quarters of a pitch
    kPairs,   ///< the same for a second contact beside each of some first ones
  };
  static constexpr int kMostFirsts = 8;

  Grid() = default;
  Grid(const TableImage& tables, const Hypothesis& hypothesis, const ScaledReadings& readings, Kind kind);
  /// Pairs: one of `firsts`, at most kMostFirsts, and a place of a `ring`.
  Grid(const Grid& ring, const Candidates& firsts);

  Kind kind() const { return kind_; }
  int size() const { return places_ * others_; }
  ContactStates at(const TableImage& tables, int point) const;

 private:
  std::uint32_t first_q32_ = 0;  ///< the first place
  std::uint32_t step_q32_ = 0;
  struct First {
    std::uint32_t angle_q32;
    Number moment_q20;
  };
  std::array<First, kMostFirsts> firsts_{};
  std::int16_t places_ = 0;
  std::int16_t others_ = 1;  ///< widths, or first contacts
  Kind kind_ = Kind::kCoarse;
  bool widthIsFree_ = true;
};

/// Where to start without knowing anything: the best point of a coarse grid, apart from another start, if any
/// (threshold::kOtherStart_16).
ContactStates initialGuess(const TableImage& tables, const Hypothesis& hypothesis,
                           const ScaledReadings& readings, Linearisation& scratch,
                           std::optional<std::uint32_t> otherStart_q32 = {});

/// One contact; if that leaves doubt, one contact without one of the gauges, and two contacts, of which each
/// is looked for anew in what the other leaves, then both together. Of each hypothesis a grid is looked at,
/// and its best points are refined. advance() does a part of it that fits into a sample period.
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
  /// Goes on for at most so much work.
  void advance(const TableImage& tables, int work, Linearisation& scratch);

  const ScaledReadings& readings() const { return readings_; }
  const Ranking& single() const { return single_; }
  const Ranking& withoutOne() const { return withoutOne_; }
  const Ranking& pair() const { return pair_; }

  /// What an update has time for, in units of 510 instructions of a Cortex-M4.
  static constexpr int kWork = 128;
  /// Of a Gauss-Newton step and its linear model.
  static int stepWork(const TableImage& tables, const Hypothesis& hypothesis) {
    return (hypothesis.contacts == 1 ? 12 : 31) + (tables.depths.areKnown() ? 6 * hypothesis.contacts : 0);
  }

 private:
  enum class Stage : std::uint8_t {
    kIdle,
    kSingle,
    kWithoutOne,
    kFirstOfPair,
    kPair,
    kFirstAgain,
    kSecondAgain,
    kTogether,
    kDone
  };
  static constexpr int kMostAnswers = 4;  ///< of one contact in what the other leaves, that are kept

  /// How many candidates a grid leaves, and how many of them are refined to the end.
  struct Effort {
    int candidates, refined;
  };
  Effort effort() const;

  void beginTask(const Hypothesis& hypothesis, const Grid& grid);
  int nextWork(const TableImage& tables) const;
  void lookAtPoint(const TableImage& tables, Linearisation& scratch);
  void consider(const TableConstants& constants, const Solution& point);
  void refineNext(const TableImage& tables, Linearisation& scratch);
  bool isWorseTwin(const TableConstants& constants, int candidate) const;
  bool isRefining() const;
  Ranking& ranking();
  void finishTask(const TableImage& tables, Linearisation& scratch);
  void findSuspects(const TableImage& tables, Linearisation& scratch);
  void withoutNext(const TableImage& tables);
  bool isSettled(const TableConstants& constants) const;
  void lookAgain(const TableImage& tables, int contact, Linearisation& scratch);
  void tryTogether();
  void finish() { stage_ = Stage::kDone; }
  void keep(const TableConstants& constants, const Solution& solution);
  bool isLookingAgain() const { return stage_ == Stage::kFirstAgain || stage_ == Stage::kSecondAgain; }

  ScaledReadings readings_;
  ScaledReadings looked_;  ///< by the stage: the readings, or what a contact of the pair leaves of them
  Hypothesis all_;         ///< one contact, all gauges
  Hypothesis hypothesis_;  ///< that is looked at
  GaugeSet suspects_ = 0;  ///< gauges that are left out, one by one
  Grid grid_;
  Ranking single_, withoutOne_, pair_;
  Candidates candidates_;
  Candidate reached_;  ///< by the refinement that is under way, and what is left there, before its last step
  std::array<std::array<ContactState, kMostAnswers>, kMostContacts> again_;  ///< answers of each contact
  std::array<std::uint8_t, kMostContacts> answers_{};
  Wide leftBefore_ = 0;       ///< by the pair, before its contacts were looked for again
  std::int16_t point_ = 0;    ///< of the grid, the next to be looked at
  std::uint8_t refined_ = 0;  ///< refinements made: first steps of all candidates, then all of the best
  std::uint8_t steps_ = 0;    ///< of the refinement that is under way
  std::uint8_t kept_ = 0;     ///< answers that refinements led to
  std::uint8_t leftOut_ = 0;  ///< gauge
  std::uint8_t rounds_ = 0;   ///< of looking for each contact of a pair again
  Stage stage_ = Stage::kIdle;
};

}  // namespace strainfinger::firmware
