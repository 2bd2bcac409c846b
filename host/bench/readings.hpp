#pragma once
// The contacts that every method is tried on, and how well any method could do.

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "host/bench/methods/sample.hpp"
#include "host/config/finger_config.hpp"
#include "host/evidence/fit_model.hpp"
#include "host/evidence/touches.hpp"
#include "host/model/impulse_response.hpp"
#include "host/simulation/gauge_strains.hpp"

namespace strainfinger::bench {

/// One contact and what the gauges read of it.
struct Reading {
  Place<double> truth;
  Sample sample;
  Eigen::Vector3d bound;  ///< Cramer-Rao, standard deviations: pitches, N/m, N/m; 0 without noise
};

/// The default finger as the benchmark sees it: exactly as drawn.
class BenchFinger {
 public:
  BenchFinger();

  /// A gauge so many pitches beyond the contact; slopes per pitch.
  model::ImpulseResponse::Value response(double pitches) const;
  /// Of a normal load, at the gauge under it: strain per N/m, positive.
  double peakPerLoad() const;
  static double pitch_rad();
  double arc_um(double pitches) const;

  /// Readings of a touch, one a gauge.
  Eigen::VectorXd readings(const simulation::Touch& touch) const;

  /// Standard deviations of the errors of the best unbiased estimator that reads all gauges: of a line known
  /// to be one, of a wide touch whose width it doesn't know.
  Eigen::Vector3d bound(const simulation::Touch& touch, double noise_strain) const;
  const config::FingerConfig& config() const { return config_; }

 private:
  config::FingerConfig config_;
  model::ImpulseResponse response_;
  evidence::FitModel model_;
  simulation::GaugeStrains strains_;
};

inline constexpr double kBenchLoad_n_per_m = 30;  ///< length of (normal, tangential)

/// Reading number `number` of a seed: any angle, load directions within +-45 degrees, semi-elliptic pressures
/// of any width in the range, white noise of relativeNoise * the peak strain of a line load. The same on
/// every machine.
Reading readingOf(const BenchFinger& finger, std::uint64_t seed, std::uint64_t number, double relativeNoise,
                  const evidence::Range& width_m = {0, 0});

}  // namespace strainfinger::bench
