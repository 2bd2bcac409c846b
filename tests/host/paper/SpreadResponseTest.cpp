#include "host/paper/spread_response.hpp"

#include <array>
#include <cmath>
#include <numbers>

#include "common/quantities.hpp"
#include "host/model/impulse_response.hpp"
#include "tests/host/model/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::paper;
using model::Profile;

TEST_GROUP(SpreadResponse) {
  static constexpr double kGauge_m = 9.4e-3;
  const model::Annulus<double>& finger = testing::kDefaultFinger;
  const model::ImpulseResponse line{finger, kGauge_m, StrainComponent::kRadial};

  /// Many line loads, by Chebyshev's rules: at cosines, weighted by the profile. Second moments are a^2/4 of
  /// an ellipse, c^2/2 of a punch.
  SpreadResponse::Value asLines(double angle_rad, double width_m, Profile profile) const {
    constexpr int kNodes = 40;
    const bool isPunch = profile == Profile::kPunch;
    const double half_rad = width_m / 2 / finger.outer_radius_m / (isPunch ? std::numbers::sqrt2 : 1);
    SpreadResponse::Value sum{};
    double weights = 0;
    for (int i = 0; i < kNodes; ++i) {
      const double at = std::numbers::pi * (i + 0.5) / kNodes;
      const double weight = isPunch ? 1 : std::sin(at) * std::sin(at);
      const auto value = line.at(angle_rad - half_rad * std::cos(at));
      sum.normal += weight * value.normal;
      sum.tangential += weight * value.tangential;
      weights += weight;
    }
    sum.normal /= weights;
    sum.tangential /= weights;
    return sum;
  }
};

// Both series end at 1e-12 of a peak of 4.6e-4.
TEST(SpreadResponse, IsASumOfLineLoads) {
  for (const double width_m : {0.5e-3, 2e-3, 6e-3})
    for (const Profile profile : {Profile::kEllipse, Profile::kPunch})
      for (const double angle_rad : {0.0, 0.1, -0.4, 2.0}) {
        const auto known = asLines(angle_rad, width_m, profile);
        const auto found = SpreadResponse(finger, kGauge_m, width_m, profile).at(angle_rad);
        DOUBLES_EQUAL(known.normal, found.normal, 1e-15);
        DOUBLES_EQUAL(known.tangential, found.tangential, 1e-15);
      }
}

TEST(SpreadResponse, OfNoWidthIsTheImpulseResponse) {
  const auto found = SpreadResponse(finger, kGauge_m, 0).at(0.2);
  DOUBLES_EQUAL(line.at(0.2).normal, found.normal, 1e-15);
  DOUBLES_EQUAL(line.at(0.2).tangentialSlope, found.tangentialSlope, 1e-14);
}

TEST(SpreadResponse, OfShearIsItsImpulseResponse) {
  const model::ImpulseResponse shear{finger, kGauge_m, StrainComponent::kShear};
  const auto known = shear.at(0.2);
  const auto found = SpreadResponse(finger, kGauge_m, 0, Profile::kEllipse, StrainComponent::kShear).at(0.2);
  DOUBLES_EQUAL(known.normal, found.normal, 1e-15);
  DOUBLES_EQUAL(known.tangential, found.tangential, 1e-15);
  DOUBLES_EQUAL(known.normalSlope, found.normalSlope, 1e-14);
  DOUBLES_EQUAL(known.tangentialSlope, found.tangentialSlope, 1e-14);
}

// Central differences: their error is the third derivative's, 1e-7 of the slopes here.
TEST(SpreadResponse, ItsSlopesAreItsDerivatives) {
  constexpr double kStep = 1e-5, kStep_m = 1e-6, kWidth_m = 3e-3;
  for (const Profile profile : {Profile::kEllipse, Profile::kPunch}) {
    const SpreadResponse response(finger, kGauge_m, kWidth_m, profile);
    const auto here = response.at(0.15), after = response.at(0.15 + kStep),
               before = response.at(0.15 - kStep);
    DOUBLES_EQUAL((after.normal - before.normal) / (2 * kStep), here.normalSlope, 1e-9);
    DOUBLES_EQUAL((after.tangential - before.tangential) / (2 * kStep), here.tangentialSlope, 1e-9);
    const auto wider = SpreadResponse(finger, kGauge_m, kWidth_m + kStep_m, profile).at(0.15);
    const auto narrower = SpreadResponse(finger, kGauge_m, kWidth_m - kStep_m, profile).at(0.15);
    DOUBLES_EQUAL((wider.normal - narrower.normal) / (2 * kStep_m), here.normalPerWidth, 1e-7);
    DOUBLES_EQUAL((wider.tangential - narrower.tangential) / (2 * kStep_m), here.tangentialPerWidth, 1e-7);
  }
}
