#pragma once
// Frequency responses of the strains, and what the cut-off frequency of one is.

#include <Eigen/Core>
#include <span>

#include "common/quantities.hpp"
#include "host/model/harmonic.hpp"
#include "host/paper/half_plane.hpp"

namespace strainfinger::paper {

/// Row n = 0, 1, ...: coefficient of the strain [1/Pa] under loads as flat as the paper's impulse; column
/// column(component, load).
using Spectra = Eigen::MatrixXd;

constexpr Eigen::Index column(StrainComponent component, model::Traction load) {
  return 2 * static_cast<Eigen::Index>(component) + load;
}

/// Of the finger, under an impulse whose coefficients are 1 from n = 1 on and 1/2 for n = 0: in proportion to
/// the lambda / pi and lambda / 2 pi of sec. 3. As many harmonics as leave out less than 1e-6 of any
/// response. Domain and errors as model::truncatedSeries().
Spectra cylinderSpectra(const model::Annulus<double>& annulus, double radius_m);

/// Of the half plane at the depth of that radius, harmonic n being the wave number n / outer_radius_m. Its
/// spectrum is a continuous density, 1 of every wave number, 0 included.
Spectra halfPlaneSpectra(const model::Annulus<double>& annulus, double radius_m);

/// The half plane that the paper compares a finger with: as deep as the gauges are.
HalfPlane halfPlaneOf(const model::Annulus<double>& annulus, double radius_m);

/// Where a response ends: at its last index whose magnitude is a tenth of the largest one, n = 0 included, or
/// more. (The first index below a tenth is no cut-off: responses change sign.)
struct CutOff {
  double maximum;       ///< largest magnitude
  int last;             ///< index
  double interpolated;  ///< where the straight line from `last` to the index after it is a tenth
};

inline constexpr double kCutOffLevel = 0.1;

/// A response that is 0 throughout (an incompressible rubber's e_rr at the core) has none: -1 and NaN.
/// Domain: a spectrum whose last magnitude is below a tenth.
CutOff cutOff(std::span<const double> spectrum);

/// Cut-offs of one strain component.
struct CutOffs {
  CutOff normal, tangential;

  double ratio() const { return tangential.maximum / normal.maximum; }
};

CutOffs cutOffs(const Spectra& spectra, StrainComponent component);

/// Whether gauges at that radius read nothing of a component, whatever the load is: on the core, which holds
/// the rubber, there is no e_tt, and without change of volume no e_rr.
bool vanishes(const model::Annulus<double>& annulus, double radius_m, StrainComponent component);

/// Why e_rr vanishes where it does, for the user.
inline constexpr const char* kWhyNoRadial =
    "gauges.radius_m is the core's, which holds the rubber, and rubber of poisson_ratio = 0.5 changes no "
    "volume";

}  // namespace strainfinger::paper
