#include <algorithm>
#include <cmath>
#include <random>

#include "tests/host/model/wide.hpp"
#include "tests/stability/survey.hpp"

namespace strainfinger::stability {
namespace {

using namespace model;
using testing::Wide;

constexpr double kUnderflowing = 1e-290;

/// Draws from ranges whose ends come up often.
class Draw {
 public:
  explicit Draw(unsigned seed) : random_(seed) {}

  double uniform(double from, double to) { return std::uniform_real_distribution<double>(from, to)(random_); }

  double from(const Range& range) {
    const unsigned roll = random_() % 8;
    return roll == 0 ? range.from : roll == 1 ? range.to : uniform(range.from, range.to);
  }

  /// Evenly in the logarithm of the distance from 1/2, down to the last digits.
  double poissonRatio(const Range& range) {
    if (range.from >= 0.49)
      return std::min(range.to, 0.5 - std::exp(uniform(std::log(1e-16), std::log(0.01))));
    return from(range);
  }

  int harmonic(const Range& range) {
    if (range.from == range.to) return static_cast<int>(range.from);
    const double n = std::exp(from({std::log(range.from), std::log(range.to)}));
    return static_cast<int>(std::lround(n));
  }

  double radius(Place place, double core_m) {
    const double rubber_m = kOuterRadius_m - core_m, near = std::pow(10, uniform(-9, -2));
    switch (place) {
      case Place::kCore:
        return core_m;
      case Place::kNearCore:
        return core_m + rubber_m * near;
      case Place::kMiddle:
        return core_m + rubber_m * uniform(0.01, 0.99);
      case Place::kNearSurface:
        return kOuterRadius_m - rubber_m * near;
      default:
        return kOuterRadius_m;
    }
  }

 private:
  std::mt19937_64 random_;
};

using Larger = std::array<Wide, kRowCount>;

/// What the errors of the rows are relative to.
Larger unitsOf(const testing::WideResponse& exact) {
  Larger units;
  for (int row = 0; row < kRowCount; ++row)
    units[static_cast<std::size_t>(row)] = exact.row(row).cwiseAbs().maxCoeff();
  units[kTtt] = std::max(units[kTtt], units[kTrr]);
  return units;
}

/// Rows that vanish (at the core) have to be zero: of them the error is infinite otherwise.
double errorOf(const Wide& unit, const Wide& size, const Wide& difference) {
  static const Wide kVanishing("1e-60");
  if (unit > size * kVanishing) return static_cast<double>(difference / unit);
  return difference <= size * kVanishing ? 0 : double{INFINITY};
}

void compare(Worst& worst, const Annulus<double>& finger, double radius_m, int n) {
  const HarmonicResponse<double> response = HarmonicModel<double>(finger, radius_m)(n);
  const testing::WideResponse exact = HarmonicModel<Wide>(testing::widen(finger), Wide(radius_m))(n);
  const Larger units = unitsOf(exact);
  ++worst.samples;
  worst.notFinite += response.allFinite() ? 0 : 1;
  const Wide stress = units[kTrr] + units[kTrt];
  const bool underflows = stress / finger.shear_modulus_pa * finger.outer_radius_m < kUnderflowing;
  worst.underflowing += underflows ? 1 : 0;
  for (int row = 0; row < kRowCount; ++row) {
    const Wide difference = (response.row(row).cast<Wide>() - exact.row(row)).cwiseAbs().maxCoeff();
    const Wide size = stress * (row <= kTtt  ? 1.0
                                : row <= kUt ? 1e-2 / kShearModulus_pa
                                             : 1 / kShearModulus_pa);
    const double error = underflows ? (difference <= kUnderflowing ? 0 : double{INFINITY})
                                    : errorOf(units[static_cast<std::size_t>(row)], size, difference);
    worst.take(static_cast<Row>(row), error);
  }
}

}  // namespace

void Worst::take(Row row, double found) {
  double& known = error[static_cast<std::size_t>(row)];
  if (!std::isnan(known) && !(found <= known)) known = found;
}

double Worst::largest() const {
  Worst all;
  for (const double each : error) all.take(kTrr, each);
  return all.error[kTrr];
}

std::vector<HarmonicRegion> surveyHarmonics(int samplesPerRegion, unsigned seed) {
  std::vector<HarmonicRegion> regions;
  Draw draw(seed);
  for (const Range& alpha : kAlphas)
    for (const Range& n : kHarmonics)
      for (const Range& poissonRatio : kPoissonRatios)
        for (int place = 0; place < static_cast<int>(kPlaceNames.size()); ++place) {
          HarmonicRegion region{alpha, n, poissonRatio, static_cast<Place>(place), {}};
          for (int i = 0; i < samplesPerRegion; ++i) {
            const double core_m = draw.from(alpha) * kOuterRadius_m;
            const Annulus<double> finger{core_m, kOuterRadius_m, kShearModulus_pa,
                                         draw.poissonRatio(poissonRatio)};
            compare(region.worst, finger, draw.radius(region.place, core_m), draw.harmonic(n));
          }
          regions.push_back(region);
        }
  return regions;
}

}  // namespace strainfinger::stability
