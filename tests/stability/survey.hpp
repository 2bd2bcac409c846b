#pragma once
// The model in double precision against the same templates in 100 digits, all over its domain.

#include <array>
#include <string>
#include <vector>

#include "host/model/harmonic.hpp"

namespace strainfinger::stability {

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
};

/// Errors of computeField() relative to the largest value of a row among the angles looked at, of which some
/// are close to the load and to its edges. Depths that take more harmonics than `mostHarmonics` are left out.
/// Costs 5 us a harmonic, angle and region: 10 s for up to 1000 harmonics.
std::vector<FieldRegion> surveyFields(int mostHarmonics);

}  // namespace strainfinger::stability
