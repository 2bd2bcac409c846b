#include "host/paper/sensing.hpp"

#include <array>

#include "tests/host/model/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::paper;
using testing::kDefaultFinger;
using testing::kGaugeRadius_m;

// Known numbers were computed for this project with another program, to the digits given and over another
// sample of phases.
TEST_GROUP(Sensing) {
  static model::Annulus<double> finger(double alpha) { return {alpha * 12.7e-3, 12.7e-3, 8.3e4, 0.5}; }
  static double gauge_m(double alpha) { return alpha * 12.7e-3 + 0.5e-3; }
};

TEST(Sensing, WidthsLowerThePeak) {
  constexpr std::array<std::array<double, 3>, 6> kKnown{
      {{0.5, 0.5, 0.2}, {1, 1.9, 0.9}, {2, 7.4, 3.3}, {3, 15, 6.9}, {4, 25, 10.8}, {6, 44, 17.5}}};
  for (const auto& [width_mm, lower, differ] : kKnown) {
    const WidthEffect found = widthEffect(kDefaultFinger, kGaugeRadius_m, width_mm * 1e-3);
    // at 6 mm the exact pressure, known there, differs by 0.6 %
    DOUBLES_EQUAL(lower, 100 * found.lowersPeak, lower < 10 ? 0.06 : 0.8);
    DOUBLES_EQUAL(differ, 100 * found.differsAtWorst, lower < 40 ? 0.06 : 0.2);
  }
}

TEST(Sensing, WidthsAreKnownAsWellAsTheyCanBe) {
  struct Known {
    double alpha;
    int gauges;
    double width_mm, sigma;
  };
  constexpr std::array kKnown{Known{0.70, 32, 2, 0.14},  Known{0.70, 32, 4, 0.039},
                              Known{0.70, 64, 2, 0.085}, Known{0.85, 64, 2, 0.038},
                              Known{0.85, 64, 4, 0.019}, Known{0.93, 64, 4, 0.085}};
  for (const auto& [alpha, gauges, width_mm, sigma] : kKnown)
    DOUBLES_EQUAL(sigma, widthSigma(finger(alpha), gauge_m(alpha), gauges, width_mm * 1e-3), 0.05 * sigma);
}

// From the appendix's formulas with 40 digits, over the same phases.
TEST(Sensing, ShearMakesWidthsBetterKnown) {
  DOUBLES_EQUAL(0.3150, widthSigma(kDefaultFinger, kGaugeRadius_m, 16, 2e-3), 5e-5);
  DOUBLES_EQUAL(0.1249, widthSigma(kDefaultFinger, kGaugeRadius_m, 16, 2e-3, true), 5e-5);
}

TEST(Sensing, ThreeReadingsAreOftenTwofold) {
  DOUBLES_EQUAL(0.69, ambiguousShare(kDefaultFinger, kGaugeRadius_m, 16), 0.05);
  DOUBLES_EQUAL(0.002, ambiguousShare(kDefaultFinger, kGaugeRadius_m, 24), 0.005);
  DOUBLES_EQUAL(0.60, ambiguousShare(kDefaultFinger, kGaugeRadius_m, 32), 0.05);
}

// To leading order (J0(x / sqrt 2) - 2 J1(x)/x) = -x^4/768: the fourth power of the width.
TEST(Sensing, KindsDifferByTheFourthPowerOfTheWidth) {
  const double narrow = kindEffect(kDefaultFinger, kGaugeRadius_m, 0.25e-3),
               wide = kindEffect(kDefaultFinger, kGaugeRadius_m, 0.5e-3);
  DOUBLES_EQUAL(16, wide / narrow, 0.2);
}
