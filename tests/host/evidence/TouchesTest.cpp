#include "host/base/angles.hpp"
#include "host/evidence/touches.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/evidence/accuracy.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::evidence;
using simulation::Touch;

TEST_GROUP(Touches) {
  static constexpr double kDegree = std::numbers::pi / 180;
  config::Gauges gauges;
  TouchRanges ranges;

  template <typename Check>
  void checkEach(Check check) {
    const TouchDraws draws(gauges, ranges, 1);
    for (std::uint64_t number = 0; number < 3200; ++number) check(draws.at(number));
  }
  /// The nearest gauge's angle to the touch [deg], signed.
  double fromGauge_deg(const Touch& touch) const {
    double nearest = 360;
    for (int i = 0; i < gauges.count; ++i) {
      const double apart = shortWay_rad(touch.angle_rad, gauges.angle_rad(i)) / kDegree;
      if (std::abs(apart) < std::abs(nearest)) nearest = apart;
    }
    return nearest;
  }
  static double lean_deg(const Touch& touch) {
    return std::atan2(touch.tangential_n_per_m, touch.normal_n_per_m) / kDegree;
  }
};

TEST(Touches, CoverTheRingAndTheCone) {
  std::array<int, 32> places{}, leans{};
  checkEach([&](const Touch& touch) {
    DOUBLES_EQUAL(30, std::hypot(touch.normal_n_per_m, touch.tangential_n_per_m), 1e-12);
    DOUBLES_EQUAL(0, *touch.width_m, 0);
    const double turns = touch.angle_rad / (2 * std::numbers::pi);
    ++places[static_cast<std::size_t>((turns - std::floor(turns)) * 32)];
    ++leans[static_cast<std::size_t>((lean_deg(touch) + 45) / 90 * 32)];
  });
  for (const int count : places) CHECK_TRUE(count > 50 && count < 150);  // 100 expected, 5 sigma
  for (const int count : leans) CHECK_TRUE(count > 50 && count < 150);
}

TEST(Touches, AreAFunctionOfSeedAndNumber) {
  const TouchDraws draws(gauges, ranges, 1), same(gauges, ranges, 1), other(gauges, ranges, 2);
  CHECK_TRUE(draws.at(7) == same.at(7));
  CHECK_FALSE(draws.at(7) == draws.at(8));
  CHECK_FALSE(draws.at(7) == other.at(7));
}

TEST(Touches, LieAndLeanFromTheNearestGaugeAsAsked) {
  ranges.offset_pitch = {0.1, 0.2};
  ranges.lean_deg = {10, 30};
  int beyond = 0;
  checkEach([&](const Touch& touch) {
    const double offset = fromGauge_deg(touch), lean = lean_deg(touch);
    CHECK_TRUE(std::abs(offset) >= 0.1 * 22.5 - 1e-9 && std::abs(offset) <= 0.2 * 22.5 + 1e-9);
    CHECK_TRUE(std::abs(lean) >= 10 - 1e-9 && std::abs(lean) <= 30 + 1e-9);
    CHECK_TRUE(offset * lean > 0);
    beyond += offset > 0;
  });
  CHECK_TRUE(beyond > 1460 && beyond < 1740);  // 5 sigma
}

TEST(Touches, OfARingThatIsNotEvenLieInItsGaps) {
  gauges.angles_deg.clear();
  for (int i = 0; i < 16; ++i) gauges.angles_deg.push_back(22.5 * i + (i % 2 == 0 ? 5 : 0));
  ranges.offset_pitch = {0.5, 0.5};
  checkEach([&](const Touch& touch) {
    const double away = std::abs(fromGauge_deg(touch));
    CHECK_TRUE(std::abs(away - 27.5 / 2) < 1e-9 || std::abs(away - 17.5 / 2) < 1e-9);
  });
}

TEST(Touches, LoadsAreOfAllOrdersOfMagnitudeAlike) {
  ranges.load_n_per_m = {2, 50};
  int light = 0;
  checkEach([&](const Touch& touch) {
    const double load = std::hypot(touch.normal_n_per_m, touch.tangential_n_per_m);
    CHECK_TRUE(load >= 2 - 1e-9 && load <= 50 + 1e-9);
    light += load < 10;
  });
  CHECK_TRUE(light > 1460 && light < 1740);
}

TEST(Touches, WidthsAndProfileAreAsAsked) {
  ranges.width_m = {1e-3, 6e-3};
  ranges.profile = model::Profile::kUniform;
  double least = 1, most = 0;
  checkEach([&](const Touch& touch) {
    least = std::min(least, *touch.width_m);
    most = std::max(most, *touch.width_m);
    CHECK_TRUE(touch.profile == model::Profile::kUniform);
  });
  DOUBLES_EQUAL(1e-3, least, 2e-5);
  DOUBLES_EQUAL(6e-3, most, 2e-5);
}
