#pragma once
// Every threshold of a guided session: unit, value, and where it comes from.

#include "host/calibration/calibrate.hpp"
#include "host/calibration/wiring.hpp"

namespace strainfinger::session {

/// Which sample sets are kept as rows of strains.
struct ThinningRules {
  /// [standard deviations of a difference of two readings, RMS over the gauges] By so much a row differs from
  /// the kept ones of its cell; 1 is noise, 5 is none by chance.
  double distinct = 5;
  /// [noise] Of the largest reading; weaker touches tell nothing beside it, to calibrate() as well.
  double weakest = calibration::kWeakestTouch;
  /// [1/s] Change of the readings over their largest size of late. The board takes 446 us to read a set's
  /// gauges one after the other (firmware/board/stm32g431): at 10/s they are off by 0.13 %, RMS over the
  /// ring.
  double fastest_per_s = 10;
  /// [s] The change is measured over a time between these: long enough that noise is none of it, and short
  /// enough that nobody presses and lets go in between. Rows every 100 ms, as the guide has them, have it.
  double shortestSpan_s = 0.03, longestSpan_s = 0.25;
  /// [s] Between rows: a finger that is rolled around in 5 s has moved by half a millimetre.
  double closest_s = 0.04;
  /// [rows] Of one cell (half a gap between gauges, an octave of load, a third of leans). The default ring's
  /// 96 cells of each octave get 2,300 rows in three octaves; what 3,000 are worth is in
  /// host/study/README.md.
  int mostPerCell = 8;
  /// [N/m over N/m] Tangential over normal load beyond which a touch counts as rubbed.
  double rubbed = 0.25;
};
inline constexpr ThinningRules kThinning{};

/// What a session asks for, and when nothing is left to gain.
struct SessionGoals {
  /// [s] Leave it alone so long: ten rows of half a second.
  double untouched_s = 5;
  int untouchedRows = 10;
  /// [noise] Sigma of the worst zero: ten rows give 0.3.
  double zero = 0.5;
  /// [noise] The finger is at rest while no reading leaves its mean by more: one in 10^9 by chance.
  double atRest = 6;
  /// [tolerance.zero_strain] A finger at rest whose readings are beyond is touched or wants a new zero.
  double farZero = calibration::kFarZero;
  /// [touches] Over every gauge, and between it and the next, before anything else is judged: two touches a
  /// gauge's unknown, with their four neighbours' help.
  int leastPerArc = 4;
  /// [1] Sigma of the unit of force: a gram in a hundred, as kitchen scales have it.
  double unitOfForce = 0.01;
  /// [1] By what share a press of known load must lower that sigma to be asked for: the eleventh and later
  /// ones of equal presses lower it by less.
  double leastUnitGain = 0.05;
  /// [presses a gauge] Of known load that are asked for: where so many leave it above, something is wrong
  /// with them.
  int mostPressesPerGauge = 1;
  /// [deg] Sigma of the zero of the angle: what a hand presses a mark to, over the root of 8.
  double zeroOfAngle_deg = 0.2;
  /// [directions] That are known, not opposite each other: two tell a ring that is turned or reversed.
  int directions = 2;
  /// [deg] From each other and from opposite each other.
  double directionsApart_deg = 20;
  /// [touches] So many more are weighed against what they would gain.
  int batch = 100;
  /// [1] The gain of a batch in the error of touches to come below which nothing is left to gain. What isn't
  /// known of a finger falls with the root of the touches: an error that a hundred after 500 lower by less is
  /// within a quarter of what noise alone makes.
  double leastGain = 0.03;
};
inline constexpr SessionGoals kGoals{};

/// When rows are fitted anew.
struct FitRules {
  /// [touches a gauge] Before the first fit: calibrate() wants two.
  int firstPerGauge = 4;
  /// [touches a gauge] With so many the first fit is made although arcs are not covered: it may tell why, as
  /// gauges that are wired wrongly.
  int uncoveredPerGauge = 20;
  /// [1] More rows than at the last fit, at which sigmas have fallen by a tenth.
  double growth = 1.2;
};
inline constexpr FitRules kFits{};

/// What is kept of a touch that is held while its load or angle is typed in.
struct HoldRules {
  double time_s = 0.3;  ///< [s] over which it is averaged
  int leastSets = 3;
  /// Each gauge may move by the larger of these, RMS: a hand is no clamp.
  double noise = 3;     ///< [noise]
  double share = 0.01;  ///< [1] of the largest reading
  /// [1] Of what was held, RMS: readings that are off it by less are still that touch's. A hand that tires
  /// and rubber that creeps change them by a tenth, letting go by all of it.
  double stillHeld = 0.5;
  /// [deg] and [sigmas of known angles] A mark that is farther from where the readings have it is doubted:
  /// the touch that was looked for may have been another, or the keyboard slipped. Rings are glued within 10
  /// deg.
  double elsewhere_deg = 15, elsewhere = 4;
};
inline constexpr HoldRules kHolds{};

/// When a finger has taken another zero.
struct ZeroRules {
  /// [noise] By so much a gauge's zero has moved between two rounds of them, a second apart: following drift
  /// moves it by 2 (firmware/core/zero_tracker.hpp), by 6 where two rounds were lost. A new zero of 64 sets
  /// of a finger that is as it was is 0.2 off.
  double moved = 6;
};
inline constexpr ZeroRules kZeros{};

}  // namespace strainfinger::session
