#pragma once
// The normal equations of one touch: where it is thought to be, what its readings say of that, and what is
// left of them for the finger.

#include <Eigen/Core>

#include "host/calibration/ring_response.hpp"

namespace strainfinger::calibration {

/// What is known of a touch beside its readings, as a normal prior of each unknown. A place is the same in
/// every revolution.
struct TouchPrior {
  TouchState value = TouchState::Zero();
  TouchState weight = TouchState::Zero();  ///< 1 / standard deviation; 0: nothing is known

  /// Deviations from the prior, in its standard deviations: residuals like those of readings.
  TouchState residuals(const TouchState& touch) const;
};

/// What a touch is fitted to.
struct TouchData {
  Eigen::VectorXd readings;  ///< a strain a gauge
  double sigma_strain = 0;   ///< of each of them
  TouchPrior prior;
};

/// All in standard deviations of a reading. Costs 40 us with the finger, 10 us without.
class TouchEquations {
 public:
  TouchEquations(const RingResponse& ring, const TouchData& data, const TouchState& touch, bool withFinger);
  /// Of a touch that is yet to be made, of which nothing but the readings will be known; with the finger.
  TouchEquations(const RingResponse& ring, const TouchState& touch, double sigma_strain);

  Eigen::VectorXd residual;  ///< readings less the model's, a gauge each
  Eigen::MatrixX4d toTouch;  ///< a row a gauge
  Eigen::MatrixXd toFinger;  ///< a row a gauge, a column a deviation; empty unless asked for
  Eigen::Matrix4d matrix;    ///< of the touch's unknowns, the prior counted in
  TouchState gradient;       ///< of half of chi-squared, downhill
  double chiSquared;         ///< of readings and prior

  /// Domain of all three: with the finger, readings that tell each unknown of the touch.
  /// Column k: by how much a deviation of 1 of the finger's unknown k moves the touch that is fitted.
  Eigen::MatrixXd pull() const;
  /// What the readings tell of the finger, their touch being found, too (Schur complement).
  Eigen::MatrixXd fingerInformation() const;
  /// The slope of minus half of chi-squared to the finger, once the touch has made the step that is best.
  Eigen::VectorXd fingerGradient() const;
};

}  // namespace strainfinger::calibration
