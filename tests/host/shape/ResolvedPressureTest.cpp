#include "host/shape/resolved_pressure.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "tests/host/shape/rings.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::shape;
using namespace strainfinger::testing;

namespace {

// Pressure directions above the noise, median over the contact's phase between gauges, computed for this
// project in numpy: alpha, gauges; widths 2, 4, 6 mm at 1 % of the peak and at 0.1 %.
struct KnownCounts {
  double alpha;
  int gauges;
  std::array<int, 3> atOnePercent, atATenth;
};

constexpr std::array kKnown{
    KnownCounts{0.70, 16, {3, 4, 4}, {4, 4, 5}}, KnownCounts{0.70, 32, {3, 4, 5}, {4, 5, 7}},
    KnownCounts{0.85, 16, {2, 3, 3}, {3, 4, 4}}, KnownCounts{0.85, 32, {3, 5, 5}, {4, 5, 7}},
    KnownCounts{0.93, 16, {2, 2, 2}, {3, 3, 3}}, KnownCounts{0.93, 32, {3, 4, 4}, {3, 4, 5}}};

constexpr std::array kWidths_mm{2.0, 4.0, 6.0};

int medianCount(const KnownCounts& known, double width_mm, double noise) {
  const config::FingerConfig config = ringOf(known.alpha, known.gauges);
  const TouchModel model(config);
  std::vector<int> counts;
  for (int i = 0; i <= 20; ++i) {
    const double phase_rad = 2 * std::numbers::pi / known.gauges * i / 20;
    const double half_rad = width_mm * 1e-3 / kSurface_m / 2;
    const Touch touch{phase_rad, 1, 0, momentOfWidth(2 * half_rad)};
    counts.push_back(ResolvedPressure(model, touch, half_rad, noise * peakStrain(config)).directions());
  }
  std::ranges::sort(counts);
  return counts[10];
}

}  // namespace

TEST_GROUP(ResolvedPressure) {
  const config::FingerConfig config = ringOf(0.7, 32);
  const TouchModel model{config};
  const Touch touch{2, 10, 3, momentOfWidth(4e-3 / kSurface_m)};
  const double noise = 0.1 * peakStrain(config);
  const double half_rad = 2e-3 / kSurface_m;
  const ResolvedPressure resolved{model, touch, half_rad, noise};
  const Eigen::VectorXd offsets = Eigen::VectorXd::LinSpaced(4001, -half_rad, half_rad);
  const double step_m = 4e-3 / 4000;
};

TEST(ResolvedPressure, AsManyDirectionsAreAboveTheNoiseAsKnown) {
  for (const KnownCounts& known : kKnown)
    for (std::size_t i = 0; i < kWidths_mm.size(); ++i) {
      LONGS_EQUAL(known.atOnePercent[i], medianCount(known, kWidths_mm[i], 1e-2));
      LONGS_EQUAL(known.atATenth[i], medianCount(known, kWidths_mm[i], 1e-3));
    }
}

TEST(ResolvedPressure, DirectionsAreOrthonormalOverTheContact) {
  const Eigen::MatrixXd directions = resolved.directionsAt(offsets);
  LONGS_EQUAL(resolved.resolved(), directions.cols());
  const Eigen::MatrixXd products = step_m * directions.transpose() * directions;
  const Eigen::MatrixXd one = Eigen::MatrixXd::Identity(products.rows(), products.cols());
  DOUBLES_EQUAL(0, (products - one).cwiseAbs().maxCoeff(), 5e-3);  // the ends count half
}

TEST(ResolvedPressure, NothingIsSaidOfWhatIsOutside) {
  const Eigen::Vector2d outside(-1.001 * half_rad, 1.001 * half_rad);
  DOUBLES_EQUAL(0, resolved.directionsAt(outside).norm(), 0);
}

// Without noise the estimate is the pressure's projection on the resolved directions, but for what the others
// bring in through the shear.
TEST(ResolvedPressure, EstimatesTheResolvedPartOfThePressure) {
  const Eigen::MatrixXd directions = resolved.directionsAt(offsets);
  Eigen::VectorXd pressure_pa(offsets.size());
  for (Eigen::Index i = 0; i < offsets.size(); ++i)
    pressure_pa[i] =
        touch.normal_n_per_m / kSurface_m * density(Profile::kEllipse, touch.moment_rad2, offsets[i]);
  const Eigen::VectorXd part = directions * (step_m * directions.transpose() * pressure_pa);
  const auto estimate = resolved.estimate(ellipseStrains(config, touch), offsets);
  DOUBLES_EQUAL(0, (estimate.pressure_pa - part).cwiseAbs().maxCoeff(), 2e-3 * pressure_pa.maxCoeff());
  CHECK_TRUE((part - pressure_pa).cwiseAbs().maxCoeff() > 0.05 * pressure_pa.maxCoeff());  // not all of it
}

TEST(ResolvedPressure, ATangentialLoadDoesNotChangeIt) {
  Touch slid = touch;
  slid.tangential_n_per_m = -8;
  const auto known = resolved.estimate(ellipseStrains(config, touch), offsets);
  const auto estimate = resolved.estimate(ellipseStrains(config, slid), offsets);
  DOUBLES_EQUAL(0, (estimate.pressure_pa - known.pressure_pa).norm(), 1e-9 * known.pressure_pa.norm());
}

TEST(ResolvedPressure, TheBandIsAsWideAsTheNoise) {
  const Eigen::VectorXd places = offsets(Eigen::seq(0, 4000, 200));
  const auto band = resolved.estimate(Eigen::VectorXd::Zero(32), places).sigma_pa;
  Eigen::VectorXd square = Eigen::VectorXd::Zero(places.size());
  for (int i = 0; i < 32; ++i)  // independent gauges
    square += resolved.estimate(noise * Eigen::VectorXd::Unit(32, i), places).pressure_pa.cwiseAbs2();
  DOUBLES_EQUAL(0, (square.cwiseSqrt() - band).norm(), 1e-9 * band.norm());
}

// One odd direction is where the touch is. A second one takes a wide touch, and little noise.
TEST(ResolvedPressure, AnOddPartIsHardToSee) {
  CHECK_FALSE(resolved.isOddResolved());
  CHECK_TRUE(ResolvedPressure(model, touch, 3e-3 / kSurface_m, noise / 30).isOddResolved());
  CHECK_FALSE(ResolvedPressure(model, touch, 0.5e-3 / kSurface_m, noise / 30).isOddResolved());
}
