#pragma once
// What may be wrong with a touch or with a finger: one row of the disturbance matrix.

#include <optional>
#include <string>

#include "host/bench/fingers.hpp"
#include "host/evidence/touches.hpp"

namespace strainfinger::bench {

/// A second contact beside the first, as wide and pushed the same way.
struct SecondContact {
  double apart_pitch;  ///< from the first one towards growing angles
  double ratio;        ///< of its loads to the first one's
  int later_sets = 0;  ///< begins so many sample sets after the first; negative: before it
};

/// What one gauge, or two neighbours, do all the time.
enum class Failure {
  kNone,
  kDead,
  kTwoDead,  ///< two neighbours
  kOpen,     ///< upper rail
  kStuck,    ///< at what it read when the finger was switched on
  kNoisy,    ///< ten times the noise
  kSwapped,  ///< the wires of two neighbours
  kBadGlue,  ///< feels 30 % of its neighbour besides
  kGain      ///< Disturbance::failedGain
};

/// Mains hum of 50 Hz, of one phase all over the ring.
struct Hum {
  double amplitude_strain = 0;
  bool isEven = true;  ///< the same in all gauges; else each gauge has an even draw from 0 to the amplitude
};

/// What contacts do while they press.
struct Motion {
  double trembles_hz = 0;
  double trembling = 0;  ///< amplitude of the loads over their mean
  double slides_m_per_s = 0;
};

/// The firmware's search for two contacts takes so long at most; until it ends their answers are flagged.
inline constexpr int kLongestSearch_sets = 600;

struct Disturbance {
  std::string name;
  config::FingerConfig actual = perfectFinger();
  config::FingerConfig told = perfectFinger();  ///< what the tables are made for
  bool isBuiltAnew = false;                     ///< each session has another finger as built
  bool isCalibrated = false;  ///< its tables are made for what a calibration found; else for `told`
  evidence::TouchRanges touches{.load_n_per_m = {2, 40}};
  std::optional<SecondContact> second = {};
  Motion motion = {};
  int rise_sets = 5;                    ///< of each contact's loads
  int touched_sets = 120;               ///< answers count at their end
  int rest_sets = 40;                   ///< before each touch
  double gainSpread = 0;                ///< standard deviation of each gauge's gain, relative
  double zeroSpread_strain = 0;         ///< standard deviation of each gauge's zero
  double drift_strain_per_s = 0;        ///< standard deviation of each gauge's own
  double commonDrift_strain_per_s = 0;  ///< of all gauges alike
  Hum hum = {};
  double spike_strain = 0;  ///< of one gauge, in every twentieth sample set
  Failure failure = Failure::kNone;
  double failedGain = 1;
  bool isUntouched = false;
  int rarer = 1;  ///< one touch where other rows have so many: for touches that take long
};

}  // namespace strainfinger::bench
