#pragma once
// A touch's normal and tangential load, and how friction spreads the latter.

#include <array>

#include "host/model/load_spectrum.hpp"
#include "host/model/pressure_profile.hpp"

namespace strainfinger::model {

/// A pressure and a shear over the same width. Domain: moment_rad2 >= 0, friction >= 0.
struct TouchLoad {
  double normal_n_per_m = 0;      ///< positive: pressing
  double tangential_n_per_m = 0;  ///< positive: towards +theta
  double moment_rad2 = 0;         ///< second moment of the pressure about its centre; 0: line loads
  Profile profile = Profile::kEllipse;
  double friction = 1;  ///< Coulomb's coefficient mu
};

/// How much of the friction that is there the shear needs: |Q| / (mu P), 1 where all of the contact slides.
double frictionUsed(const TouchLoad& load);

/// Second moment [rad^2] of the shear under a semi-elliptic pressure. In partial slip (Cattaneo 1938, Mindlin
/// 1949; Johnson, Contact Mechanics, sec. 7.2) the shear is mu p less mu c/a times the pressure's ellipse
/// shrunk from the half width a to that of the stick zone, c = a sqrt(1 - |Q| / (mu P)), so its moment is
/// m (2 - |Q| / (mu P)): from twice the pressure's at no shear down to the pressure's own in full sliding.
double shearMoment_rad2(const TouchLoad& load);

/// Harmonics 0 .. last of the true tractions: under a semi-ellipse Mindlin's partial slip, under any other
/// profile a shear that is spread like the pressure. Costs 0.2 us a harmonic and ellipse.
LoadSpectrum trueSpectrum(const TouchLoad& load, int last);

/// Harmonics 0 .. last as a fit takes them: pressure and shear are both of the profile, each with its second
/// moment, the shear's by shearMoment_rad2().
LoadSpectrum fittedSpectrum(const TouchLoad& load, int last);

/// Derivatives of fittedSpectrum() to the normal load, the tangential load and the moment, in this order.
/// At no shear they are those for a shear that grows from there, whose sign doesn't matter.
std::array<LoadSpectrum, 3> fittedSlopes(const TouchLoad& load, int last);

}  // namespace strainfinger::model
