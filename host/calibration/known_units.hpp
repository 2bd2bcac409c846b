#pragma once
// Whether what is said of touches is in the units that are meant, before anything is fitted to it: a wrong
// unit of all of it would be laid at the door of wires and zeros.

#include <Eigen/Core>
#include <span>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::calibration {

/// Whether a load is another one than that of a finger as drawn: ten times or more, either way. Newtons for
/// newtons per metre are fifty times on a finger of 20 mm; the modulus is seldom twice the drawing's.
bool isOfAnotherUnit(double said_n_per_m, double drawn_n_per_m);

/// As calibrate() takes them. Throws Failure(kFailure) where the known angles are radians by the readings, or
/// the known normal loads of another unit; where fewer than three are known there is nothing to tell it by.
/// Cost: 5 ms, and 30 us a row of which something is known.
void requireUnits(const config::FingerConfig& config, std::span<const KnownTouch> known,
                  const Eigen::MatrixXd& readings);

}  // namespace strainfinger::calibration
