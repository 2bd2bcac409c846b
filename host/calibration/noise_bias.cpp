#include "host/calibration/noise_bias.hpp"

#include <Eigen/Dense>
#include <bit>

namespace strainfinger::calibration {
namespace {

using Eigen::Index, Eigen::VectorXd;

/// Patterns that each touch is given, of as many as there are; consecutive touches take others.
constexpr std::size_t kPatternsPerTouch = 2;

/// Signs of Walsh's function `number`. Over all of them each pair of gauges agrees as often as it differs, so
/// that their mean square is that of independent noise exactly.
VectorXd pattern(Index gauges, std::size_t number) {
  VectorXd signs(gauges);
  for (Index gauge = 0; gauge < gauges; ++gauge)
    signs[gauge] = std::popcount(static_cast<std::size_t>(gauge) & number) % 2 == 0 ? 1 : -1;
  return signs;
}

/// The slope of minus half of chi-squared to the finger, its touch being fitted. What the fit's last step
/// left is taken off: 1e-5 of a standard deviation, of 30,000 touches always to one side, would be 3 % of the
/// unit of force.
VectorXd slope(const RingResponse& ring, const TouchData& data, const TouchState& start) {
  return TouchEquations(ring, data, refineTouch(ring, data, start).touch, true).fingerGradient();
}

}  // namespace

VectorXd noiseBias(const Drawing& drawing, int lastHarmonic, const std::vector<TouchData>& data,
                   const JointFit& fit, const Eigen::MatrixXd& covariance) {
  const RingResponse ring(drawing, fit.deviations, lastHarmonic);
  const Index gauges = drawing.gauges();
  const std::size_t patterns = std::bit_ceil(static_cast<std::size_t>(gauges));
  VectorXd sum = VectorXd::Zero(drawing.unknowns());
  for (std::size_t i = 0; i < data.size(); ++i) {
    const TouchState& touch = fit.touches[i];
    const VectorXd exact = ring.readings(touch);
    TouchData noisy = data[i];
    noisy.prior.value = touch;
    for (std::size_t k = 0; k < kPatternsPerTouch; ++k) {
      const VectorXd noise = noisy.sigma_strain * pattern(gauges, (kPatternsPerTouch * i + k) % patterns);
      for (const double sign : {1.0, -1.0}) {  // both: what is linear in the noise is gone
        noisy.readings = exact + sign * noise;
        sum += slope(ring, noisy, touch);
      }
    }
  }
  return covariance * sum / (2 * kPatternsPerTouch);
}

}  // namespace strainfinger::calibration
