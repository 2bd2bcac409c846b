#include "host/model/impulse_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "host/base/failure.hpp"
#include "host/model/series.hpp"
#include "tests/host/model/exact_field.hpp"
#include "tests/host/model/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::model;
using namespace strainfinger::testing;

namespace {

constexpr double kDegree = std::numbers::pi / 180;

constexpr std::array<std::pair<StrainComponent, Row>, 3> kComponents{
    {{StrainComponent::kRadial, kErr}, {StrainComponent::kHoop, kEtt}, {StrainComponent::kShear, kErt}}};

ImpulseResponse radial() { return {kDefaultFinger, kGaugeRadius_m, StrainComponent::kRadial}; }

/// Of both loads, relative to the peak of the normal one.
double worstError(const ImpulseResponse& response, const ExactField& exact, Row row, double width_rad,
                  double gauge_rad) {
  const SurfaceLoad press{1, 0, 0, width_rad}, drag{0, 1, 0, width_rad};
  double worst = 0, peak = 0;
  for (const double angle_rad : {0.0, 0.02, -0.1, 0.2, 0.5, -1.0, 2.0, 3.1}) {
    const long double normal = exact.at(press, angle_rad, gauge_rad)[row];
    const long double tangential = exact.at(drag, angle_rad, gauge_rad)[row];
    const auto value = response.at(angle_rad);
    worst = std::max({worst, static_cast<double>(std::abs(normal - value.normal)),
                      static_cast<double>(std::abs(tangential - value.tangential))});
    peak = std::max(peak, std::abs(value.normal));
  }
  return worst / peak;
}

}  // namespace

TEST_GROUP(ImpulseResponse) {};

// The bar is 1e-13 of the peak; reached are 3e-15.
TEST(ImpulseResponse, AgreesWithExactSums) {
  constexpr Annulus<double> kFinger{8.9e-3, 12.7e-3, 8.3e4, 0.47};
  for (const double radius_m : {8.9001e-3, 9.4e-3, 11.5e-3}) {
    const ExactField exact(kFinger, radius_m);
    for (const auto& [component, row] : kComponents) {
      const ImpulseResponse point(kFinger, radius_m, component);
      CHECK_TRUE(worstError(point, exact, row, 0, 0) < 2e-14);
      const ImpulseResponse spread(kFinger, radius_m, component, 0.3 * radius_m,
                                   0.2 * kFinger.outer_radius_m);
      CHECK_TRUE(worstError(spread, exact, row, 0.2, 0.3) < 2e-14);
    }
  }
}

// 42,800 harmonics, as one sum 1.7e-13 of the peak off; slopes too.
TEST(ImpulseResponse, KeepsItsDigitsCloseToTheSurface) {
  constexpr double kRadius_m = 12.7e-3 * (1 - 1e-3);
  const ImpulseResponse response(kDefaultFinger, kRadius_m, StrainComponent::kRadial);
  CHECK_TRUE(response.harmonics() > 30'000);
  const double unit = response.at(0).normal, slopeUnit = unit / 1e-3;
  for (const double angle_rad : {0.0, 3e-4, -1e-3, 0.01, -2.0}) {
    long double normal = 0, tangential = 0, slope = 0;
    visitMultiples<long double>(angle_rad, response.harmonics(), [&](int n, long double c, long double s) {
      normal += response.even()[n] * c;
      tangential += response.odd()[n] * s;
      slope -= n * response.even()[n] * s;
    });
    const auto found = response.at(angle_rad);
    DOUBLES_EQUAL(0, (found.normal - static_cast<double>(normal)) / unit, 5e-15);
    DOUBLES_EQUAL(0, (found.tangential - static_cast<double>(tangential)) / unit, 5e-15);
    DOUBLES_EQUAL(0, (found.normalSlope - static_cast<double>(slope)) / slopeUnit, 5e-15);
  }
}

// Computed for this project from the boundary-value problem in 60 digits.
TEST(ImpulseResponse, ReproducesTheDefaultFinger) {
  const ImpulseResponse response = radial();
  DOUBLES_EQUAL(-460.6030e-6, response.at(0).normal, 0.00005e-6);
  DOUBLES_EQUAL(-307.47e-6, response.at(5 * kDegree).normal, 0.005e-6);
  DOUBLES_EQUAL(-44.597e-6, response.at(10 * kDegree).normal, 0.0005e-6);
  DOUBLES_EQUAL(130.53e-6, response.at(20 * kDegree).normal, 0.005e-6);
  DOUBLES_EQUAL(0.2733e-6, response.at(180 * kDegree).normal, 0.00005e-6);
}

TEST(ImpulseResponse, CrossesZeroAtElevenDegrees) {
  const ImpulseResponse response = radial();
  CHECK_TRUE(response.at(11.08045 * kDegree).normal < 0);
  CHECK_TRUE(response.at(11.08055 * kDegree).normal > 0);
}

TEST(ImpulseResponse, IsEvenOrOddByComponentAndLoad) {
  for (const auto& [component, row] : kComponents) {
    const ImpulseResponse response(kDefaultFinger, kGaugeRadius_m, component);
    const auto left = response.at(-0.2), right = response.at(0.2);
    const double parity = component == StrainComponent::kShear ? -1 : 1;
    DOUBLES_EQUAL(parity * left.normal, right.normal, 1e-17);
    DOUBLES_EQUAL(-parity * left.tangential, right.tangential, 1e-17);
  }
}

TEST(ImpulseResponse, SlopesAreTheDerivatives) {
  constexpr double kStep_rad = 1e-5;
  for (const auto& [component, row] : kComponents) {
    const ImpulseResponse response(kDefaultFinger, kGaugeRadius_m, component);
    for (const double angle_rad : {-0.5, 0.0, 0.1, 0.3, 2.0}) {
      const auto before = response.at(angle_rad - kStep_rad), after = response.at(angle_rad + kStep_rad);
      const auto value = response.at(angle_rad);
      const double limit = 1e-10;  // third derivative (of order 1) times step^2, and rounding / step
      DOUBLES_EQUAL((after.normal - before.normal) / (2 * kStep_rad), value.normalSlope, limit);
      DOUBLES_EQUAL((after.tangential - before.tangential) / (2 * kStep_rad), value.tangentialSlope, limit);
    }
  }
}

TEST(ImpulseResponse, OfALongGaugeIsTheMeanOfPoints) {
  constexpr double kArc_m = 2e-3;
  constexpr int kPoints = 2000;
  const ImpulseResponse point = radial(),
                        arc(kDefaultFinger, kGaugeRadius_m, StrainComponent::kRadial, kArc_m);
  double sum = 0;
  for (int i = 0; i < kPoints; ++i)
    sum += point.at(0.1 + ((i + 0.5) / kPoints - 0.5) * kArc_m / kGaugeRadius_m).normal;
  DOUBLES_EQUAL(sum / kPoints, arc.at(0.1).normal, 1e-10);  // midpoint rule: curvature * step^2 / 24
}

TEST(ImpulseResponse, ATightToleranceCostsHarmonics) {
  const ImpulseResponse coarse(kDefaultFinger, kGaugeRadius_m, StrainComponent::kRadial, 0, 0, 1e-6);
  CHECK_TRUE(coarse.harmonics() < 70 && radial().harmonics() < 140);
  DOUBLES_EQUAL(radial().at(0.1).normal, coarse.at(0.1).normal, 1e-6 * 4.6e-4);
}

TEST(ImpulseResponse, RefusesTheSurface) {
  CHECK_THROWS(Failure, ImpulseResponse(kDefaultFinger, 12.7e-3, StrainComponent::kRadial));
  CHECK_THROWS(Failure, ImpulseResponse(kDefaultFinger, 12.7e-3, StrainComponent::kShear, 1e-3, 1e-3));
}

TEST(ImpulseResponse, RefusesWhatIsOutsideItsDomain) {
  CHECK_THROWS(Failure, ImpulseResponse(kDefaultFinger, 8e-3, StrainComponent::kRadial));
  CHECK_THROWS(Failure, ImpulseResponse(kDefaultFinger, 9.4e-3, StrainComponent::kRadial, -1e-3));
  CHECK_THROWS(Failure, ImpulseResponse(kDefaultFinger, 9.4e-3, StrainComponent::kRadial, 0, 0.1));
}
