#pragma once
// One strain against the angle to the line load that makes it: the paper's impulse responses, of finger and
// half plane alike, and where they part.

#include <functional>

#include "common/quantities.hpp"
#include "host/model/harmonic.hpp"

namespace strainfinger::paper {

/// Strain per N/m, pressing or towards +theta, at an angle [rad] from the load; even or odd in it. For the
/// half plane the angle is that of the arc on the finger's surface, x = r_b theta. (With x = r_s theta its
/// curves would leave the finger's from 0.02 rad on already, not from the 0.4 rad of the paper.)
class ImpulseCurve {
 public:
  /// Domain and errors as model::ImpulseResponse.
  static ImpulseCurve ofCylinder(const model::Annulus<double>& annulus, double radius_m,
                                 StrainComponent component, model::Traction load);
  static ImpulseCurve ofHalfPlane(const model::Annulus<double>& annulus, double radius_m,
                                  StrainComponent component, model::Traction load);

  double at(double angle_rad) const { return strain_(angle_rad); }
  double relative(double angle_rad) const { return strain_(angle_rad) / peak_; }

  double peak() const { return peak_; }  ///< largest magnitude

 private:
  ImpulseCurve(std::function<double(double)> strain, double depth_rad);
  std::function<double(double)> strain_;
  double peak_ = 0;
};

/// The depth of a radius below the surface, as an angle on the surface: what peaks are as wide as.
double depth_rad(const model::Annulus<double>& annulus, double radius_m);

/// How far the next sample of a curve may be from one at an angle from the load, so that none of its features
/// is missed: they are as wide as the depth near the load, wider further off.
double sampleStep_rad(double depth_rad, double angle_rad);

/// First angle >= 0 at which two curves, each over its own peak, differ by `share` of the peak; NaN without
/// one.
double partingAngle_rad(const ImpulseCurve& one, const ImpulseCurve& other, double share);

}  // namespace strainfinger::paper
