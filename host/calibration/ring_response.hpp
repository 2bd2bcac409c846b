#pragma once
// What the gauges of one finger read of a touch, with all derivatives: the model that calibration fits.

#include <Eigen/Core>

#include "host/calibration/finger_state.hpp"

namespace strainfinger::calibration {

/// What a fit finds out of a touch: [rad], [N/m], [N/m], [rad^2]. As evidence::Parameter.
enum TouchUnknown : Eigen::Index { kPlace, kNormalLoad, kTangentialLoad, kMoment, kTouchUnknowns };
using TouchState = Eigen::Vector4d;

/// The waves that a touch sends around the ring, harmonic by harmonic: cosines and sines of the load that is
/// even about the touch, then of the odd one, and their derivatives. A semi-ellipse of pressure with
/// Mindlin's partial slip (model::trueSpectrum()), continued to second moments below 0, where noise may put a
/// line.
struct TouchWaves {
  /// Columns: the waves; their derivatives to the touch's unknowns.
  Eigen::Matrix<double, Eigen::Dynamic, 1 + kTouchUnknowns> columns;

  /// `normalIsEven` as ImpulseResponse::isEvenInNormal(). Costs 0.4 us a harmonic.
  TouchWaves(const TouchState& touch, double friction, bool normalIsEven, int lastHarmonic);
};

/// A ring of gauges of a finger as built.
class RingResponse {
 public:
  /// The last harmonic that counts for fingers of this drawing: what is beyond is below 1e-7 of the peak.
  static int lastHarmonic(const Drawing& drawing);

  /// Domain: the deviations put every gauge into the rubber. Costs 1 ms for 16 gauges and 60 harmonics.
  RingResponse(const Drawing& drawing, const Eigen::VectorXd& deviations, int lastHarmonic);

  /// One reading a gauge, gains and zeros included. Costs 5 us besides the touch's waves.
  Eigen::VectorXd readings(const TouchState& touch) const;

  struct Linearised {
    Eigen::VectorXd readings;
    Eigen::MatrixX4d toTouch;  ///< a row a gauge
    Eigen::MatrixXd toFinger;  ///< a row a gauge, a column a deviation; empty unless asked for
  };
  Linearised linearised(const TouchState& touch, bool withFinger) const;

  int gauges() const { return static_cast<int>(gain_.size()); }
  const Eigen::VectorXd& zeros() const { return zero_; }
  /// What each harmonic of a normal and of a tangential load of these moments is multiplied by.
  struct Spread {
    Eigen::VectorXd pressure, shear;
  };
  Spread spread(double moment_rad2, double shearMoment_rad2) const;
  /// Readings, zeros apart, of a normal and a tangential load of 1 N/m at a place: what a search compares
  /// readings with.
  Eigen::MatrixX2d unitReadings(double place_rad, const Spread& spread) const;

 private:
  TouchWaves wavesOf(const TouchState& touch) const {
    return {touch, friction_, normalIsEven_, lastHarmonic_};
  }
  void fillGauge(const Drawing& drawing, const Eigen::VectorXd& deviations, int gauge);

  bool normalIsEven_;
  double friction_;
  int lastHarmonic_;
  Eigen::MatrixXd
      strains_;  ///< a row a gauge: what one wave each makes of strain there, at the drawn modulus
  Eigen::MatrixXd toRadius_;  ///< their derivatives, in units of the tolerances
  Eigen::MatrixXd toCore_;
  Eigen::MatrixXd toPoisson_;
  Eigen::VectorXd gain_;  ///< times drawn modulus / modulus
  Eigen::VectorXd zero_;
  double compliance_;  ///< drawn modulus / modulus
  Eigen::Vector4d gaugeTolerance_;
  double modulusTolerance_;
};

}  // namespace strainfinger::calibration
