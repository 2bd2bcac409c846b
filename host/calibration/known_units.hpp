#pragma once
// Whether what is said of touches is in the units that are meant, before anything is fitted to it: a wrong
// unit of all of it would be laid at the door of wires and zeros.

#include <Eigen/Core>
#include <optional>
#include <span>

#include "host/calibration/calibrate.hpp"
#include "host/calibration/touch_fit.hpp"

namespace strainfinger::calibration {

/// Whether a normal load is ten times more or less than that of the touch that explains the readings best, on
/// a finger as drawn; never where no touch explains them. Newtons for newtons per metre are fifty times on a
/// finger of 20 mm; the modulus is seldom twice the drawing's.
bool isOfAnotherUnit(const TouchSearch& drawn, const Eigen::VectorXd& strains, double said_n_per_m);

/// Where a touch of a finger as drawn reads so, 0 .. 360; nothing where no touch explains the readings.
std::optional<double> placeRead_deg(const TouchSearch& drawn, const Eigen::VectorXd& strains);

/// As calibrate() takes them. Throws Failure(kFailure) where the known angles are radians by the readings,
/// the known normal loads of another unit, or all known tangential loads of the other sign. Asks rows alone
/// that a touch of the drawn finger explains, so that faulty wires are not taken for units; of fewer than
/// three there is nothing to tell it by, nor of angles in one place. Cost: a drawnSearch(), and two of its
/// questions a row of which something is known.
void requireUnits(const config::FingerConfig& config, std::span<const KnownTouch> known,
                  const Eigen::MatrixXd& readings);

}  // namespace strainfinger::calibration
