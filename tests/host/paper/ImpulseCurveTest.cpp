#include "host/paper/impulse_curve.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "host/base/angles.hpp"
#include "host/paper/crossing.hpp"
#include "host/paper/spectrum.hpp"
#include "tests/host/model/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::paper;
using model::kNormal;
using model::kTangential;
using testing::kDefaultFinger;
using testing::kGaugeRadius_m;

namespace {

constexpr double kGrid_rad = 2e-4;

ImpulseCurve cylinder(model::Traction load) {
  return ImpulseCurve::ofCylinder(kDefaultFinger, kGaugeRadius_m, StrainComponent::kRadial, load);
}

ImpulseCurve plane(model::Traction load) {
  return ImpulseCurve::ofHalfPlane(kDefaultFinger, kGaugeRadius_m, StrainComponent::kRadial, load);
}

/// First angle at which the tangential curves differ by `share` of a peak, on a grid, the half plane's
/// abscissa being radius_m theta; each over its own peak, or both over the finger's.
double firstApart_rad(double radius_m, double share, bool scaled) {
  const ImpulseCurve finger = cylinder(kTangential);
  const HalfPlane rubber = halfPlaneOf(kDefaultFinger, kGaugeRadius_m);
  const double planePeak = scaled ? plane(kTangential).peak() : finger.peak();
  for (double angle_rad = 0; angle_rad < 1; angle_rad += 1e-4) {
    const double flat =
        rubber.atArc(radius_m * angle_rad)(static_cast<int>(StrainComponent::kRadial), kTangential);
    if (std::abs(finger.relative(angle_rad) - flat / planePeak) >= share) return angle_rad;
  }
  return 0;
}

double zeroAngle_rad(const ImpulseCurve& curve) {
  return firstCrossing([&](double angle_rad) { return curve.at(angle_rad); }, 1e-9, 1, 2e-3);
}

}  // namespace

// Numbers here were computed for this project with another program, on a grid of angles: peaks and angles at
// which curves part are known to its step.
TEST_GROUP(ImpulseCurve) {};

TEST(ImpulseCurve, HasTheKnownPeaks) {
  DOUBLES_EQUAL(4.606030e-4, cylinder(kNormal).peak(), 5e-11);
  DOUBLES_EQUAL(-1, cylinder(kNormal).relative(0), 0);
  DOUBLES_EQUAL(1.390287e-4, cylinder(kTangential).peak(), 1e-10);
  DOUBLES_EQUAL(1, std::abs(cylinder(kTangential).relative(0.1129)), 1e-6);
  DOUBLES_EQUAL(5.810695e-4, plane(kNormal).peak(), 5e-11);
  DOUBLES_EQUAL(1.452674e-4, plane(kTangential).peak(), 5e-11);
}

TEST(ImpulseCurve, ChangesItsSignWhereItIsKnownTo) {
  DOUBLES_EQUAL(11.0805, zeroAngle_rad(cylinder(kNormal)) / kRadPerDeg, 5e-5);
  DOUBLES_EQUAL(15.0135, zeroAngle_rad(cylinder(kTangential)) / kRadPerDeg, 5e-5);
  DOUBLES_EQUAL(3.3 / 12.7, zeroAngle_rad(plane(kNormal)), 1e-12);
  DOUBLES_EQUAL(14.89, zeroAngle_rad(plane(kNormal)) / kRadPerDeg, 5e-3);
}

TEST(ImpulseCurve, TangentialCurvesPartAtTheKnownAngles) {
  DOUBLES_EQUAL(0.3862, partingAngle_rad(cylinder(kTangential), plane(kTangential), 0.05), kGrid_rad);
  DOUBLES_EQUAL(0.4262, partingAngle_rad(cylinder(kTangential), plane(kTangential), 0.10), kGrid_rad);
}

// x = r_s theta in place of r_b theta: the half plane's curve is wider by r_b / r_s.
TEST(ImpulseCurve, WithTheGaugesArcTheTangentialCurvesPartAtOnce) {
  DOUBLES_EQUAL(0.017, firstApart_rad(kGaugeRadius_m, 0.05, true), 5e-4);
  DOUBLES_EQUAL(0.037, firstApart_rad(kGaugeRadius_m, 0.10, true), 5e-4);
  DOUBLES_EQUAL(0.3862, firstApart_rad(kDefaultFinger.outer_radius_m, 0.05, true), kGrid_rad);
}

TEST(ImpulseCurve, UnscaledTangentialCurvesPartByATenthAtTheAngleThePaperGives) {
  DOUBLES_EQUAL(0.4009, firstApart_rad(kDefaultFinger.outer_radius_m, 0.10, false), kGrid_rad);
}

TEST(ImpulseCurve, NormalCurvesPartMuchEarlier) {
  const ImpulseCurve finger = cylinder(kNormal), flat = plane(kNormal);
  DOUBLES_EQUAL(0.0883, partingAngle_rad(finger, flat, 0.05), kGrid_rad);
  DOUBLES_EQUAL(0.1272, partingAngle_rad(finger, flat, 0.10), kGrid_rad);
  CHECK_TRUE(partingAngle_rad(finger, flat, 0.215) > 0);
  CHECK_TRUE(std::isnan(partingAngle_rad(finger, flat, 0.225)));
}

TEST(ImpulseCurve, IsEvenOrOddAsItsLoad) {
  for (const auto component : {StrainComponent::kRadial, StrainComponent::kHoop, StrainComponent::kShear})
    for (const auto load : {kNormal, kTangential}) {
      const bool even = (component == StrainComponent::kShear) == (load == kTangential);
      for (const auto& curve : {ImpulseCurve::ofCylinder(kDefaultFinger, kGaugeRadius_m, component, load),
                                ImpulseCurve::ofHalfPlane(kDefaultFinger, kGaugeRadius_m, component, load)})
        DOUBLES_EQUAL(curve.at(0.2), (even ? 1 : -1) * curve.at(-0.2), 1e-17);
    }
}

// The finger's gauges lie above the core, where a half plane goes on: alike only in kind.
TEST(ImpulseCurve, FingerAndHalfPlaneAgreeInSign) {
  for (const auto load : {kNormal, kTangential}) CHECK_TRUE(cylinder(load).at(0.1) * plane(load).at(0.1) > 0);
  CHECK_TRUE(cylinder(kNormal).at(0) < 0);
}

// A peak narrower than 2e-3 rad, in closed form: e_rr of a tangential load is, with t = x / depth,
// t (1 - nu - nu t^2) / (1 + t^2)^2 / (pi mu depth), largest where nu t^4 - 3 t^2 + 1 - nu = 0.
TEST(ImpulseCurve, FindsThePeaksOfShallowGauges) {
  model::Annulus<double> finger = kDefaultFinger;
  finger.poisson_ratio = 0.3;
  constexpr double kShallow_m = 12.68e-3, kExact = 0.038368;
  const auto peak = [&](auto make, model::Traction load) {
    return make(finger, kShallow_m, StrainComponent::kRadial, load).peak();
  };
  DOUBLES_EQUAL(kExact, peak(ImpulseCurve::ofHalfPlane, kTangential), 5e-7);
  DOUBLES_EQUAL(kExact, peak(ImpulseCurve::ofCylinder, kTangential), 0.02 * kExact);
}

TEST(ImpulseCurve, CurvesThatAgreeNeverPart) {
  CHECK_TRUE(std::isnan(partingAngle_rad(plane(kNormal), plane(kNormal), 1e-9)));
}
