#include "host/simulation/strain_fit.hpp"

#include <algorithm>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::simulation;

TEST_GROUP(StrainFit) {
  config::FingerConfig config_;

  static can::TouchReport pressed(double angle_deg, double normal_n) {
    can::TouchReport touch;
    touch.angle_deg = angle_deg;
    touch.normal_n = normal_n;
    touch.tangential_n = 0;
    return touch;
  }
  static std::ptrdiff_t deepest(const std::vector<double>& readings) {
    return std::min_element(readings.begin(), readings.end()) - readings.begin();
  }
};

TEST(StrainFit, TheGaugeUnderThePressIsCompressedMost) {
  const auto readings = StrainFit(config_).readings(pressed(90, 0.4));  // gauge 4 of 16
  LONGS_EQUAL(16, readings.size());
  LONGS_EQUAL(4, deepest(readings));
  CHECK_TRUE(readings[4] < 0);
  DOUBLES_EQUAL(readings[3], readings[5], 1e-12);
}

TEST(StrainFit, TwiceTheForceIsTwiceTheStrain) {
  const StrainFit fit(config_);
  const auto once = fit.readings(pressed(33, 0.2)), twice = fit.readings(pressed(33, 0.4));
  for (std::size_t i = 0; i < once.size(); ++i) DOUBLES_EQUAL(2 * once[i], twice[i], 1e-9);
}

TEST(StrainFit, ASecondContactAddsItsStrains) {
  const StrainFit fit(config_);
  can::TouchReport both = pressed(45, 0.3);
  both.second = pressed(225, 0.1);
  const auto one = fit.readings(pressed(45, 0.3)), other = fit.readings(pressed(225, 0.1)),
             sum = fit.readings(both);
  for (std::size_t i = 0; i < sum.size(); ++i) DOUBLES_EQUAL(one[i] + other[i], sum[i], 1e-12);
}

TEST(StrainFit, OfAContactThatIsNotKnownThereIsNothing) {
  for (const double reading : StrainFit(config_).readings(can::TouchReport{})) DOUBLES_EQUAL(0, reading, 0);
}

TEST(StrainFit, ItIsTheFingerAsDrawn) {
  config::FingerConfig other = config_;
  other.as_built.gain = 0.1;
  const auto drawn = StrainFit(config_).readings(pressed(10, 0.3)),
             told = StrainFit(other).readings(pressed(10, 0.3));
  for (std::size_t i = 0; i < drawn.size(); ++i) DOUBLES_EQUAL(drawn[i], told[i], 0);
}
