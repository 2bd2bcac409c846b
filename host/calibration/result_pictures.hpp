#pragma once
// A calibration in pictures.

#include "host/calibration/findings.hpp"
#include "host/plot/picture.hpp"

namespace strainfinger::calibration {

/// Gain, angle and depth of each gauge, two sigmas up and down, beside what [tolerance] allows a drawn one.
plot::Picture ringPicture(const CalibrationResult& result);

/// Where around the ring touches were, with what load: used, and left out where they are known at all.
plot::Picture coveragePicture(const CalibrationResult& result);

/// What is left over by gauge and by row: with the finger as drawn, and as fitted.
plot::Picture residualPicture(const CalibrationResult& result, const Residuals& residuals);

}  // namespace strainfinger::calibration
