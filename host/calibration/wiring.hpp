#pragma once
// Are the gauges wired as the drawing has them? From the strains of touches at unknown places.

#include <Eigen/Core>
#include <span>
#include <string>
#include <vector>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::calibration {

/// Of tolerance.zero_strain: what taring leaves is less, four standard deviations.
inline constexpr double kFarZero = 4;

struct WiringFault {
  enum class Kind {
    kSwapped,      ///< `gauge` and `other` in each other's place
    kSign,         ///< reads the wrong way
    kAllSigns,     ///< all of them do
    kDead,         ///< reads nothing
    kGlued,        ///< reads what its neighbour `other` does
    kUnfit,        ///< reads something that is neither
    kZeroOff,      ///< the same, and `zero_strain` where nothing touches the finger
    kShifted,      ///< the ring is turned by `other` gauges: gauge i is where i + other should be
    kReversed,     ///< counted the other way round, and turned so that gauge i is where other - i should be
    kTurnUnclear,  ///< turned or reversed: which isn't told
  };
  Kind kind;
  int gauge = 0;
  int other = 0;
  int onlyMark = 0;  ///< of a turn: the row, from 1, of the one known direction that tells it; 0: several do
  double zero_strain = 0;

  bool operator==(const WiringFault&) const = default;
};

/// Gauges near which there are too few touches to judge the wiring: in hardly a row such a gauge reads most,
/// or one beside it, as a dead one reads most nowhere. Domain: as calibrate()'s. Cost: one look at each row.
std::vector<int> untouchedGauges(const config::Gauges& gauges, const Eigen::MatrixXd& readings);

/// What is wrong, worst first; empty for a ring that is wired as drawn. A fault is told when the drawn finger
/// explains much more of the readings with it mended. Rings that are turned or reversed explain theirs as
/// well as the drawn one: rows of known angle_deg tell them, if three quarters of these are where such a ring
/// would see them, and the shape of an uneven ring does. One direction is enough where it is three degrees or
/// more from any gauge and from the middle of any gap: a ring that is reversed about such a place reads a
/// touch there as one that is turned does. A gauge that reads what no touch does is told for its zero where
/// rows that are known to be untouched show that. Domain: as calibrate()'s, touches near every gauge. Cost:
/// 0.08 s for a healthy ring of 16, 0.05 s a fault, and findTurn()'s.
std::vector<WiringFault> findWiringFaults(const config::FingerConfig& config,
                                          std::span<const KnownTouch> known, const Eigen::MatrixXd& readings,
                                          const KnownErrors& errors);

/// The finger is to be mended. Otherwise a mark may be: the only one that tells a turn, or one more.
bool isOfFinger(const WiringFault& fault);

/// What it is and how to mend it.
std::string textOf(const WiringFault& fault);

}  // namespace strainfinger::calibration
