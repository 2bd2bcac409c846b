#pragma once
// The model in double precision against the same templates in 100 digits, all over its domain.

#include <array>
#include <span>
#include <string>
#include <vector>

#include "host/contact/contact.hpp"
#include "host/model/harmonic.hpp"

namespace strainfinger::stability {

/// The default finger's.
inline constexpr double kOuterRadius_m = 12.7e-3, kShearModulus_pa = 8.3e4;

struct Range {
  double from, to;
};

/// Largest errors found in one region. NaNs and infinities that have no place there are counted, not
/// compared.
struct Worst {
  std::array<double, model::kRowCount> error{};
  int samples = 0;
  int notFinite = 0;
  int underflowing = 0;  ///< harmonics below the range of double

  void take(model::Row row, double found);  ///< what is no number is the worst
  double largest() const;
};

/// Radii: r_a; close above it (1e-9 to 1e-2 of the rubber); in between; close below r_b; r_b.
enum class Place { kCore, kNearCore, kMiddle, kNearSurface, kSurface };
inline constexpr std::array kPlaceNames{"core", "near core", "middle", "near surface", "surface"};

inline constexpr std::array kAlphas{Range{0.01, 0.1}, Range{0.1, 0.5},   Range{0.5, 0.9},
                                    Range{0.9, 0.97}, Range{0.97, 0.99}, Range{0.99, 0.999}};
inline constexpr std::array kHarmonics{Range{0, 0},           Range{1, 1},      Range{2, 10},
                                       Range{10, 100},        Range{100, 1000}, Range{1000, 10'000},
                                       Range{10'000, 100'000}};
/// Poisson's ratio: well below 1/2, just below it, 1/2.
inline constexpr std::array kPoissonRatios{Range{0, 0.49}, Range{0.49, 0.5 - 1e-15}, Range{0.5, 0.5}};

struct HarmonicRegion {
  Range alpha, n, poissonRatio;
  Place place;
  Worst worst;
};

/// Errors relative to the larger of a row's two coefficients (hoop stress: of the radial one's, if larger),
/// as HarmonicModel states them; harmonics below 1e-290 only have to be as small.
/// Costs 0.1 ms a sample; there are 630 regions.
std::vector<HarmonicRegion> surveyHarmonics(int samplesPerRegion, unsigned seed);

struct FieldRegion {
  double alpha, poissonRatio, width_rad;
  double depthOfRubber;  ///< (r_b - r) / (r_b - r_a)
  Worst worst;
  bool isRefused = false;  ///< computeField() says that it has no answer
};

/// Errors of computeField() relative to the largest value of a row among the angles looked at, of which some
/// are close to the load and to its edges. Depths that take more harmonics than `mostHarmonics` are left out,
/// but for what is refused. Beyond 10,000 harmonics two widths and four angles are looked at, beyond 100,000
/// Poisson's ratio 1/2 only. Costs 0.1 ms a harmonic and depth and 5 us a width and angle of it, on
/// all cores: 10 s for up to 1000 harmonics, minutes for 1,000,000.
std::vector<FieldRegion> surveyFields(int mostHarmonics);

/// A contact of given width. There is no solver in 100 digits; but an answer's residual is computed anew from
/// its tractions.
struct ContactRegion {
  double alpha, poissonRatio, width_rad;
  contact::Regime regime;
  const char* indenter;
  double misfit = 0;        ///< residual over depth; NaN if anything in the answer is not finite
  bool isWarnedOf = false;  ///< by Contact::warnings
  bool isRefused = false;
};

inline constexpr std::array kContactPoissonRatios{0.0, 0.3, 0.499999, 0.5};

/// Every regime (sliding with a friction of 0.5), widths from 1e-6 rad to a quarter turn, a flat indenter, a
/// cylinder of 5 mm and a wedge of 160 degrees.
/// On layers of alpha >= 0.98 indenters are flat and Poisson's ratios 0.3 and 1/2, of widths beyond 0.01 rad
/// 1/2 only, at 0.999 without friction. On all cores; costs 5 s an alpha below 0.9, a minute at 0.999.
std::vector<ContactRegion> surveyContacts(std::span<const double> alphas,
                                          std::span<const double> poissonRatios);

/// Those of the whole survey.
inline constexpr std::array kContactAlphas{0.01, 0.1, 0.5, 0.7, 0.85, 0.93, 0.97, 0.99, 0.999};

}  // namespace strainfinger::stability
