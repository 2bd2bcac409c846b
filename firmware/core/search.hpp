#pragma once
// Looks for the contacts that explain a set of readings of which nothing else is known, piece by piece.

#include <array>
#include <cstdint>

#include "firmware/core/fit.hpp"
#include "firmware/core/judge.hpp"

namespace strainfinger::firmware {

/// The most likely solution of a hypothesis, and the next best that lies elsewhere.
struct Ranking {
  Solution best;
  Solution second;
  bool anyBest = false;
  bool anySecond = false;

  /// Takes a solution in. One that is not admissible counts as if it left threshold::kInadmissible more.
  void take(const TableConstants& constants, const Solution& solution, const ScaledReadings& readings);
};

/// Where to look for the contacts of a hypothesis: places and widths around where the strains bend most, or
/// pairs of places.
class Grid {
 public:
  Grid() = default;
  /// `fine`: an eighth of a pitch and five widths instead of a quarter and two.
  Grid(const TableImage& tables, const Hypothesis& hypothesis, const ScaledReadings& readings, bool fine);

  int size() const { return places_ * others_; }
  ContactStates at(const TableImage& tables, int index) const;

 private:
  std::uint32_t anchor_q32_ = 0;  ///< the middle of the places
  std::int16_t places_ = 0;       ///< of the first contact
  std::int16_t others_ = 0;       ///< widths, or places of the second contact
  std::uint8_t step_ = 0;         ///< between places [eighths of a pitch]
  bool pairs_ = false;
  bool fine_ = false;
};

/// Where to start without knowing anything: the best point of a coarse grid.
ContactStates initialGuess(const TableImage& tables, const Hypothesis& hypothesis,
                           const ScaledReadings& readings);

/// One contact; if that does not explain the readings, one contact without one of the gauges, and two
/// contacts. Of each hypothesis a grid is looked at, and its best points are refined. advance() does a part
/// of it that fits into a sample period.
class Search {
 public:
  /// `hypothesis`: one contact, read by all gauges that work.
  void begin(const TableImage& tables, const ScaledReadings& readings, const Hypothesis& hypothesis);
  void stop() { stage_ = Stage::kIdle; }
  bool isRunning() const { return stage_ != Stage::kIdle; }
  /// Goes on for at most kWork units. Cost: 500 instructions of a Cortex-M4 each.
  void advance(const TableImage& tables, Linearisation& scratch);

  const ScaledReadings& readings() const { return readings_; }
  const Ranking& single() const { return single_; }
  const Ranking& withoutOne() const { return withoutOne_; }
  const Ranking& pair() const { return pair_; }

  static constexpr int kWork = 100;

 private:
  enum class Stage : std::uint8_t { kIdle, kSingle, kWithoutOne, kPair };
  static constexpr int kMostCandidates = 12;

  void beginTask(const TableImage& tables, const Hypothesis& hypothesis);
  int lookAtPoint(const TableImage& tables);
  void consider(const TableConstants& constants, const Solution& point);
  int refineNext(const TableImage& tables, Linearisation& scratch);
  int refinements() const;
  Ranking& rankingOf(Stage stage);
  void finishTask(const TableImage& tables);
  void withoutNext(const TableImage& tables);

  ScaledReadings readings_;
  Hypothesis all_;         ///< one contact, all gauges
  Hypothesis hypothesis_;  ///< that is looked at
  Grid grid_;
  Ranking single_, withoutOne_, pair_;
  std::array<Solution, kMostCandidates> candidate_;
  std::int16_t point_ = 0;  ///< of the grid, the next to be looked at
  std::uint8_t candidates_ = 0;
  std::uint8_t refined_ = 0;  ///< refinements made: first steps of all candidates, then all of the best
  std::uint8_t leftOut_ = 0;  ///< gauge
  Stage stage_ = Stage::kIdle;
};

}  // namespace strainfinger::firmware
