#pragma once
// A calibration in words.

#include <string>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::calibration {

/// What was found and what it is worth, what is not known and what would tell it, and which rows were left
/// out and why: some lines of text, each ended.
std::string textReport(const CalibrationResult& result);

}  // namespace strainfinger::calibration
