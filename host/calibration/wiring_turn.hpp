#pragma once
// Is the ring turned or reversed? Such rings explain their own readings as well as the drawn one: only rows
// of known direction tell them, and the shape of a ring that is drawn uneven.

#include <Eigen/Core>
#include <optional>
#include <span>

#include "host/calibration/wiring.hpp"

namespace strainfinger::calibration {

/// Rows that show each gauge of a ring without other faults, and the Poisson's ratio that explains them, in
/// tolerances from the drawing's.
struct StrongRows {
  Eigen::MatrixXd readings;
  double poissonDeviation;
};

/// A turn that explains the directions and the shape much better than the drawing does, if there is one.
/// Domain: `readings` as calibrate()'s. Cost: 0.2 to 0.45 s where a direction is known or the ring is uneven.
std::optional<WiringFault> findTurn(const config::FingerConfig& config, std::span<const KnownTouch> known,
                                    const Eigen::MatrixXd& readings, const KnownErrors& errors,
                                    const StrongRows& strong);

}  // namespace strainfinger::calibration
