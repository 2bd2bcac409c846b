#pragma once
// What a gauge reads of a load of some width, in place of the line load of an impulse response.

#include <Eigen/Core>

#include "common/quantities.hpp"
#include "host/model/annulus.hpp"
#include "host/model/pressure_profile.hpp"

namespace strainfinger::paper {

/// A strain, mostly e_rr, per N/m of a normal (pressing) and of a tangential load. A semi-ellipse in place of
/// a contact's exact pressure costs 1.5e-5 of the peak at 2 mm, 1e-3 at 4 mm (default finger).
class SpreadResponse {
 public:
  /// The profile has the second moment of a semi-ellipse of that width, an arc of the surface, 0 to
  /// 2 pi outer_radius_m. Domain and errors besides as model::ImpulseResponse.
  SpreadResponse(const model::Annulus<double>& annulus, double radius_m, double width_m,
                 model::Profile profile = model::Profile::kEllipse,
                 StrainComponent component = StrainComponent::kRadial);

  struct Value {
    double normal, tangential;                  ///< strain per N/m
    double normalSlope, tangentialSlope;        ///< per rad of angle
    double normalPerWidth, tangentialPerWidth;  ///< per m of width
  };

  /// At the gauge's angle minus the contact's. Costs 0.5 us for the default finger.
  Value at(double angle_rad) const;

 private:
  bool normalIsEven_;
  Eigen::MatrixX2d series_;    // of normal cosines and tangential sines, of shear the reverse
  Eigen::MatrixX2d perWidth_;  // their derivative to the width
};

}  // namespace strainfinger::paper
