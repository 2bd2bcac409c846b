#include "host/paper/spectrum.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

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

constexpr auto kRadial = StrainComponent::kRadial;
constexpr auto kShear = StrainComponent::kShear;

/// The paper's fig. 5: r_b of the default finger, gauges 0.5 mm above the core.
Spectra spectraFor(double alpha) {
  model::Annulus<double> finger = kDefaultFinger;
  finger.core_radius_m = alpha * finger.outer_radius_m;
  return cylinderSpectra(finger, finger.core_radius_m + 0.5e-3);
}

}  // namespace

TEST_GROUP(Spectrum) {
  const Spectra cylinder = cylinderSpectra(kDefaultFinger, kGaugeRadius_m);
  const Spectra plane = halfPlaneSpectra(kDefaultFinger, kGaugeRadius_m);

  static double share(const Spectra& spectra, int n, StrainComponent component, model::Traction load) {
    const auto values = spectra.col(column(component, load));
    return std::abs(values[n]) / values.cwiseAbs().maxCoeff();
  }
};

// Numbers here were computed for this project with another program and arithmetic; the tolerance is half of
// the last digit given.
TEST(Spectrum, CutsOffNormalStrainAtTheTwentieth) {
  const CutOffs found = cutOffs(cylinder, kRadial);
  LONGS_EQUAL(19, found.normal.last);
  LONGS_EQUAL(20, found.tangential.last);
  DOUBLES_EQUAL(19.29, found.normal.interpolated, 0.005);
  DOUBLES_EQUAL(20.36, found.tangential.interpolated, 0.005);
}

TEST(Spectrum, CutsOffShearStrainEarlier) {
  const CutOffs found = cutOffs(cylinder, kShear);
  LONGS_EQUAL(15, found.normal.last);
  LONGS_EQUAL(3, found.tangential.last);
  DOUBLES_EQUAL(15.72, found.normal.interpolated, 0.005);
  DOUBLES_EQUAL(3.975, found.tangential.interpolated, 0.0005);
}

TEST(Spectrum, KnowsWhatIsLeftAtTheTwentieth) {
  DOUBLES_EQUAL(0.08302, share(cylinder, 20, kRadial, kNormal), 5e-6);
  DOUBLES_EQUAL(0.10845, share(cylinder, 20, kRadial, kTangential), 5e-6);
  DOUBLES_EQUAL(0.03524, share(cylinder, 20, kShear, kNormal), 5e-6);
  DOUBLES_EQUAL(0.00896, share(cylinder, 20, kShear, kTangential), 5e-6);
}

TEST(Spectrum, ComparesTangentialWithNormalLoads) {
  DOUBLES_EQUAL(0.601, cutOffs(cylinder, kRadial).ratio(), 5e-4);
  DOUBLES_EQUAL(3.029, cutOffs(cylinder, kShear).ratio(), 5e-4);
}

// tau_rt / p of 1.825373472 and 1.417029153 at n = 0 and 1, by the paper's eq. 1 and in 60 digits.
TEST(Spectrum, IsOfAnImpulseWhoseConstantTermIsHalfOfTheOthers) {
  const auto shear = cylinder.col(column(kShear, kTangential)) * 2 * kDefaultFinger.shear_modulus_pa;
  DOUBLES_EQUAL(1.825373472 / 2, shear[0], 1e-9);
  DOUBLES_EQUAL(1.417029153, shear[1], 1e-9);
}

// The half plane's spectrum is a density: no wave number is apart from the others.
TEST(Spectrum, OfTheHalfPlaneHasNoConstantTermOfItsOwn) {
  DOUBLES_EQUAL(1, plane(0, column(kShear, kTangential)) * 2 * kDefaultFinger.shear_modulus_pa, 1e-15);
}

TEST(Spectrum, VanishesOnTheCoreWithoutStretchOrChangeOfVolume) {
  const double core_m = kDefaultFinger.core_radius_m;
  model::Annulus<double> soft = kDefaultFinger;
  soft.poisson_ratio = 0.3;
  CHECK_TRUE(vanishes(kDefaultFinger, core_m, kRadial));
  CHECK_TRUE(vanishes(kDefaultFinger, core_m, StrainComponent::kHoop));
  CHECK_TRUE(vanishes(soft, core_m, StrainComponent::kHoop));
  CHECK_FALSE(vanishes(soft, core_m, kRadial));
  CHECK_FALSE(vanishes(kDefaultFinger, core_m, kShear));
  CHECK_FALSE(vanishes(kDefaultFinger, kGaugeRadius_m, kRadial));
}

TEST(Spectrum, IncompressibleHoopStrainIsMinusTheRadialOne) {
  for (const auto load : {kNormal, kTangential}) {
    const auto radial = cylinder.col(column(kRadial, load));
    const auto hoop = cylinder.col(column(StrainComponent::kHoop, load));
    DOUBLES_EQUAL(0, (radial + hoop).cwiseAbs().maxCoeff(), 0);
  }
}

TEST(Spectrum, CutsOffTheHalfPlaneEarlier) {
  LONGS_EQUAL(18, cutOffs(plane, kRadial).normal.last);
  LONGS_EQUAL(11, cutOffs(plane, kRadial).tangential.last);
}

// Harmonic n as the wave number n / r_s, not n / r_b.
TEST(Spectrum, CutsOffTheHalfPlaneEarlierStillWithTheGaugesArc) {
  const HalfPlane rubber = halfPlaneOf(kDefaultFinger, kGaugeRadius_m);
  const auto last = [&](model::Traction load) {
    std::vector<double> spectrum;
    for (int n = 0; n <= 60; ++n)
      spectrum.push_back(rubber.atWaveNumber(n / kGaugeRadius_m)(static_cast<int>(kRadial), load));
    return cutOff(spectrum).last;
  };
  LONGS_EQUAL(13, last(kNormal));
  LONGS_EQUAL(8, last(kTangential));
}

TEST(Spectrum, RisesWithTheRadiusOfTheCore) {
  // alpha, cut-offs of e_rr and e_rt under normal and tangential loads, tangential over normal maximum
  constexpr std::array<std::array<double, 7>, 8> kKnown{{{0.50, 9.96, 9.73, 7.84, 2.57, 0.817, 2.504},
                                                         {0.60, 13.46, 13.67, 10.62, 2.99, 0.699, 2.629},
                                                         {0.70, 19.23, 20.29, 15.66, 3.97, 0.601, 3.027},
                                                         {0.80, 31.11, 33.22, 27.80, 6.26, 0.584, 3.428},
                                                         {0.85, 44.13, 46.75, 43.65, 9.03, 0.616, 3.793},
                                                         {0.90, 77.39, 79.29, 88.05, 16.96, 0.714, 4.693},
                                                         {0.93, 150.84, 143.58, 168.79, 92.79, 0.918, 3.718},
                                                         {0.95, 450.3, 365.0, 459.4, 277.25, 1.494, 2.785}}};
  for (const auto& known : kKnown) {
    const Spectra spectra = spectraFor(known[0]);
    const CutOffs radial = cutOffs(spectra, kRadial), shear = cutOffs(spectra, kShear);
    const double digit = known[0] == 0.95 ? 0.05 : 0.005;
    DOUBLES_EQUAL(known[1], radial.normal.interpolated, digit);
    DOUBLES_EQUAL(known[2], radial.tangential.interpolated, digit);
    DOUBLES_EQUAL(known[3], shear.normal.interpolated, digit);
    DOUBLES_EQUAL(known[4], shear.tangential.interpolated, digit);
    DOUBLES_EQUAL(known[5], radial.ratio(), 5e-4);
    DOUBLES_EQUAL(known[6], shear.ratio(), 6e-4);
  }
}

TEST(Spectrum, LeavesNothingOut) {
  for (const double alpha : {0.3, 0.7, 0.95}) {
    const Spectra spectra = spectraFor(alpha);
    for (const auto& column : spectra.colwise())
      CHECK_TRUE(std::abs(column[column.size() - 1]) < 1e-5 * column.cwiseAbs().maxCoeff());
  }
}

TEST_GROUP(CutOff) {};

TEST(CutOff, IsTheLastIndexAtATenthNotTheFirstBelow) {
  const std::vector spectrum{3.0, -10.0, 0.5, -2.0, 1.0, 0.5, 0.0};
  const CutOff found = cutOff(spectrum);
  DOUBLES_EQUAL(10, found.maximum, 0);
  LONGS_EQUAL(4, found.last);
  DOUBLES_EQUAL(4, found.interpolated, 0);
}

TEST(CutOff, InterpolatesMagnitudesByAStraightLine) {
  DOUBLES_EQUAL(1.25, cutOff(std::vector{10.0, -1.2, 0.4}).interpolated, 1e-15);
}

TEST(CutOff, CountsTheConstantTerm) { LONGS_EQUAL(0, cutOff(std::vector{10.0, 0.9, 0.1}).last); }

TEST(CutOff, NothingHasNone) {
  LONGS_EQUAL(-1, cutOff(std::vector{0.0, 0.0}).last);
  CHECK_TRUE(std::isnan(cutOff(std::vector{0.0, 0.0}).interpolated));
}
