#pragma once
// `calibrate --can`: a guided session with a finger on a bus.

#include <cstdint>
#include <optional>
#include <string>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::cli {

struct LiveCalibration {
  std::string bus;
  std::uint8_t node = 1;
  int rate_hz = 100;
  std::string outputPath;  ///< the rows are kept beside it
  bool plain = false;      ///< lines on stderr, even in a terminal
  calibration::KnownErrors errors;
};

/// What a session ended with.
struct LiveResult {
  std::optional<calibration::CalibrationResult> result;
  std::string complaint;                 ///< why there is none
  std::string strainsPath, touchesPath;  ///< of the rows
  std::string kept;                      ///< where the rows are, and how to go on
  bool interrupted = false;              ///< by Ctrl-C
};

/// Runs until nothing is left to gain, or the user ends it. Throws Failure as the bus, the finger and the
/// files of the session have it; what was collected is kept whatever happens.
LiveResult calibrateLive(const config::FingerConfig& config, const LiveCalibration& options);

}  // namespace strainfinger::cli
