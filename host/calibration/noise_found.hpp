#pragma once
// Whether readings are as noisy as the config says. A full scale or an amplifier's gain that is another one
// scales noise as it does strains, and nothing else tells it: gains and the modulus take the factor up.

#include <optional>
#include <string>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::calibration {

struct NoiseFound {
  double ratio;  ///< over gauges.noise_strain: below 1 quieter, above noisier
  bool isNoisier() const { return ratio > 1; }
};

/// Noise that is off the config's by a quarter or more, and beyond chance; none otherwise. Noisier is told by
/// untouched rows that follow each other, as what touches leave over may be the model's error; quieter by
/// what touches leave over, as untouched rows may be means of many readings (those of a guided session are).
std::optional<NoiseFound> noiseFound(const CalibrationResult& result);

/// What it is and what to look at, in a sentence; empty where there is none.
std::string noiseText(const CalibrationResult& result);

}  // namespace strainfinger::calibration
