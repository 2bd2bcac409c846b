#pragma once
// What one gauge reads of a line load, as a function of the angle between them.

#include <Eigen/Core>

#include "common/quantities.hpp"
#include "host/model/annulus.hpp"
#include "host/model/load_spectrum.hpp"

namespace strainfinger::model {

/// What a gauge reads per N/m of a normal (pressing) and of a tangential (towards +theta) line load, and
/// under loads that are spread.
class ImpulseResponse {
 public:
  /// The gauge sits at radius_m and averages over gaugeArc_m, an arc at its radius; the load is spread
  /// uniformly over contactWidth_m, an arc at r_b. Radial and hoop: e_rr and e_tt, even in the normal load
  /// and odd in the tangential one; shear: the tensor component e_rt, the reverse.
  /// Domain: core_radius_m <= radius_m < outer_radius_m, widths >= 0 (0: a point) and at most a revolution,
  /// 0 < tolerance < 1, relative to the peak. Throws Failure(kUsage) outside it and where the series needs
  /// more than kMaxHarmonics, above all at r_b: there the response to a line load is a delta function.
  ImpulseResponse(const Annulus<double>& annulus, double radius_m, StrainComponent component,
                  double gaugeArc_m = 0, double contactWidth_m = 0, double tolerance = 1e-15);

  struct Value {
    double normal, tangential;            ///< strain per N/m
    double normalSlope, tangentialSlope;  ///< its derivative to the angle: strain per N/m and rad
  };

  /// At the gauge's angle minus the contact's. Costs one sincos and four multiplications a harmonic, 0.4 us
  /// for the default finger; error below 5e-15 of the peak besides the tolerance, of 200,000 harmonics too.
  Value at(double angle_rad) const;

  struct Strain {
    double strain;
    double slope;  ///< its derivative to the angle, per rad
  };

  /// Under loads that are spread, at the gauge's angle minus the contact's. Cost and error as at().
  /// Domain: the spectrum has harmonics() or more, of which those beyond are not felt.
  Strain under(const LoadSpectrum& load, double angle_rad) const;

  /// Number of the last harmonic.
  int harmonics() const { return static_cast<int>(even_.size()) - 1; }

  /// Whether the response to a normal load is the even one, as of e_rr and e_tt.
  bool isEvenInNormal() const { return normalIsEven_; }
  const Eigen::VectorXd& even() const { return even_; }  ///< factors of cos n angle, n = 0..harmonics()
  const Eigen::VectorXd& odd() const { return odd_; }    ///< factors of sin n angle

 private:
  bool normalIsEven_;
  Eigen::VectorXd even_;
  Eigen::VectorXd odd_;
};

}  // namespace strainfinger::model
