#pragma once
// Looks for the contacts that explain a set of readings of which nothing else is known, piece by piece.

#include <array>
#include <cstddef>
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

/// Some of those with the least residual energy, the best first.
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

/// Where to look for the contacts of a hypothesis.
class Grid {
 public:
  enum class Kind : std::uint8_t {
    kCoarse,  ///< two pitches around where the ring reads most, by quarters of a pitch, two widths
    kFine,    ///< by sixths, five widths
    kPairs,   ///< two places round the ring, or one beside a single contact, by halves of a pitch
    kBeside,  ///< a pair of which one contact lies elsewhere within a pitch, by halves of it
  };

  Grid() = default;
  /// For one contact.
  Grid(const TableImage& tables, const Hypothesis& hypothesis, const ScaledReadings& readings, Kind kind);
  /// For two, of which one may be as the answers of a single one are.
  Grid(const TableConstants& constants, bool widthIsFree, const Ranking& single);
  /// For two beside a pair.
  Grid(const TableConstants& constants, bool widthIsFree, const ContactStates& pair);

  int size() const { return rows_ * columns_; }
  ContactStates at(const TableImage& tables, int point) const;
  /// Of a fine grid where the width is free: next to each other, and of the same width. Lines are so narrow
  /// that each place may lead elsewhere.
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
  std::array<Known, 2> known_{};  ///< single contacts, or those of a pair
  /// Places, each with so many widths. Of pairs: places of the first contact all round the ring, each with
  /// second ones up to half round from there; then two rows, each of half the ring, beside each single
  /// contact.
  std::int16_t rows_ = 0, columns_ = 1;
  Kind kind_ = Kind::kCoarse;
  bool widthIsFree_ = true;
};

/// Where to start without knowing anything: the best point of a coarse grid, apart from another start, if any
/// (threshold::kOtherStart_16).
ContactStates initialGuess(const TableImage& tables, const Hypothesis& hypothesis,
                           const ScaledReadings& readings, Linearisation& scratch,
                           std::optional<std::uint32_t> otherStart_q32 = {});

/// One contact; if that leaves doubt, one contact without one of the gauges, and two contacts, at last those
/// beside the best pair: near every contact there may be a second answer, of another width. Of each
/// hypothesis many points are looked at, the best of them get their first steps, and the best candidates that
/// these lead to are refined. advance() does a part of it that fits into a sample period.
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

  /// What an update has time for, in units of 530 instructions of a Cortex-M4 with 16 gauges.
  static constexpr int kWork = 128;
  /// Of a Gauss-Newton step and its linear model.
  static int stepWork(const TableImage& tables, const Hypothesis& hypothesis) {
    return (hypothesis.contacts == 1 ? 12 : 31) + (tables.depths.areKnown() ? 6 * hypothesis.contacts : 0);
  }

 private:
  enum class Stage : std::uint8_t { kIdle, kSingle, kWithoutOne, kPair, kBeside, kDone };

  /// Of a grid, looked at.
  struct Point {
    std::uint32_t residualEnergy;  ///< / 2^kPointEnergyBits
    std::int16_t number;
  };
  struct Candidate {
    ContactStates contact;
    Wide residualEnergy;
  };
  static constexpr int kMostPoints = 48, kMostCandidates = 16;

  /// How many points get their first steps, of how many candidates that these lead to the shortlist is, and
  /// how many of those are refined to the end.
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
  Hypothesis hypothesis_;  ///< that is looked at
  GaugeSet suspects_ = 0;  ///< gauges that are left out, one by one
  Grid grid_;
  Ranking single_, withoutOne_, pair_;
  BestFirst<Point, kMostPoints> bestPoints_;
  BestFirst<Candidate, kMostCandidates> candidates_;
  Candidate reached_;         ///< by first steps; by a candidate before its last step, and what is left there
  std::int16_t point_ = 0;    ///< of the grid, the next to be looked at
  std::uint8_t tried_ = 0;    ///< points that got their first steps
  std::uint8_t refined_ = 0;  ///< candidates, or passed over
  std::uint8_t steps_ = 0;    ///< of what is tried or refined
  std::uint8_t kept_ = 0;     ///< answers that refinements led to
  std::uint8_t leftOut_ = 0;  ///< gauge
  Stage stage_ = Stage::kIdle;
};

}  // namespace strainfinger::firmware
