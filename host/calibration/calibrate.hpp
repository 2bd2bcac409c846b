#pragma once
// Each gauge's gain, and its zero, from touches that are known.

#include <Eigen/Core>
#include <optional>
#include <span>
#include <vector>

#include "host/config/finger_config.hpp"

namespace strainfinger::calibration {

/// What pressed while a row of readings was taken. Both loads 0: nothing did.
struct KnownTouch {
  double angle_deg = 0;
  double normal_n_per_m = 0;
  double tangential_n_per_m = 0;

  bool isTouch() const { return normal_n_per_m != 0; }
};

struct Estimate {
  double value;
  double sigma;
};

struct GaugeCalibration {
  Estimate gain;  ///< what the gauge reads over what the elastic model gives
  std::optional<Estimate> zero_strain;
  double residual_strain;  ///< RMS of what the fit leaves, over rows less unknowns; 0 if there are as many
};

struct CalibrationFit {
  std::vector<GaugeCalibration> gauges;
  double excess;  ///< RMS of all residuals over noise_strain; 1 if nothing is left over to tell
};

/// Gains less certain than this are not determined: with them a finger is no better than without.
inline constexpr double kMostGainSigma = 0.01;

/// Least squares of reading = gain * strain + zero for every gauge, strain by the elastic model of the
/// config's finger. Zeros are fitted if a row is of no touch, else they are 0. Noise is independent and of
/// gauges.noise_strain; where the residuals of all gauges together are larger, sigmas are larger by the same
/// factor: then touches or readings were off, not only noisy. Gains in config.calibration are not looked at.
///
/// `readings`: strain at nominal gain, a row a touch, a column a gauge; all finite.
/// Throws Failure(kFailure), saying which row or gauge and what would help: rows that don't pair; a touch
/// that can't be (angle or load not finite, pulling, or shear without pressing); a reading beyond full scale;
/// gauges whose gain the touches don't tell to kMostGainSigma; touches that don't explain the readings; a
/// gain out of the domain of calibration.gain. Cost: one evaluation of the impulse response (0.4 us) a gauge
/// and row.
CalibrationFit calibrate(const config::FingerConfig& config, std::span<const KnownTouch> touches,
                         const Eigen::MatrixXd& readings);

}  // namespace strainfinger::calibration
