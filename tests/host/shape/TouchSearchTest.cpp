#include "host/shape/touch_search.hpp"

#include <cmath>

#include "host/simulation/noise.hpp"
#include "tests/host/shape/rings.hpp"
#include "tests/under_sanitizers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::shape;
using namespace strainfinger::testing;

TEST_GROUP(TouchSearch) {
  const simulation::Noise random{20260};  // the seed

  Eigen::VectorXd noiseOf(int gauges, std::uint64_t sample, double sigma) const {
    Eigen::VectorXd noise(gauges);
    for (int i = 0; i < gauges; ++i) noise[i] = sigma * random.at(sample, static_cast<std::uint32_t>(i));
    return noise;
  }

  static double offBy(double a_rad, double b_rad) {
    return std::abs(std::remainder(a_rad - b_rad, 2 * std::numbers::pi));
  }

  static void findsTouchesAllAround(const config::FingerConfig& config) {
    const TouchModel model(config);
    const TouchSearch search(model, 1);
    for (int i = 0; i < 40; i += kSanitized ? 8 : 1) {
      const Touch truth{0.157 * i + 0.01, 10, 10 * std::sin(i), momentOfWidth(0.008 * i)};
      const auto found = search.search(ellipseStrains(config, truth), 1e-6 * peakStrain(config));
      CHECK_TRUE(found.has_value());
      DOUBLES_EQUAL(0, offBy(truth.angle_rad, found->best.touch.angle_rad), 1e-6);
      DOUBLES_EQUAL(truth.moment_rad2, found->best.touch.moment_rad2, 1e-6);
    }
  }
};

TEST(TouchSearch, FindsTouchesAllAroundTheRing) {
  for (const int gauges : {16, 24, 32}) findsTouchesAllAround(ringOf(0.7, gauges));
}

TEST(TouchSearch, FindsTouchesAllAroundAFingerAsBuilt) { findsTouchesAllAround(asBuilt(ringOf(0.7, 16))); }

TEST(TouchSearch, FindsTouchesAllAroundAnUnevenRing) {
  config::FingerConfig config = ringOf(0.7, 24);
  for (int i = 0; i < 24; ++i) config.gauges.angles_deg.push_back(15 * i + 3 * (1 + std::sin(3.0 * i)));
  findsTouchesAllAround(config);
}

TEST(TouchSearch, NoiseIsNoTouch) {
  const config::FingerConfig config = ringOf(0.7, 32);
  const TouchModel model(config);
  const TouchSearch search(model, 1);
  for (int i = 0; i < randomCases(200); ++i)
    CHECK_FALSE(search.search(noiseOf(32, static_cast<std::uint64_t>(i), 1e-5), 1e-5).has_value());
  CHECK_FALSE(search.search(Eigen::VectorXd::Zero(32), 1e-5).has_value());
}

TEST(TouchSearch, ATouchThatPullsIsNone) {
  const config::FingerConfig config = ringOf(0.7, 32);
  const TouchModel model(config);
  const auto found = TouchSearch(model, 0).search(ellipseStrains(config, {1, -10, 0, 0}), 1e-5);
  CHECK_TRUE(!found || offBy(1, found->best.touch.angle_rad) > 0.1);
}

// 32 gauges over a layer that is thin for them: several touches fit, and the sigmas say so.
TEST(TouchSearch, AnAmbiguousTouchNamesItsRival) {
  const config::FingerConfig config = ringOf(0.85, 32);
  const TouchModel model(config);
  const TouchSearch search(model, 1);
  const double noise = 0.1 * peakStrain(config);
  int rivals = 0, covered = 0;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const Touch truth{0.1585 * static_cast<double>(i), 10, 0, momentOfWidth(4e-3 / kSurface_m)};
    const auto found = search.search(ellipseStrains(config, truth) + noiseOf(32, i, noise), noise);
    const double sigma = std::sqrt(found->best.covariance(0, 0));
    covered += offBy(truth.angle_rad, found->best.touch.angle_rad) < 2 * sigma;
    rivals += found->rivalAngle_rad.has_value();
    if (found->rivalAngle_rad) CHECK_TRUE(offBy(*found->rivalAngle_rad, truth.angle_rad) < 1);
  }
  CHECK_TRUE(rivals > 8);
  CHECK_TRUE(covered > 34);
}

// Of two touches that fit alike the one that friction allows: 16 gauges, nearly over one.
TEST(TouchSearch, FrictionDecides) {
  const config::FingerConfig config = ringOf(0.7, 16);
  const TouchModel model(config);
  const TouchSearch slippery(model, 0.1), rough(model, 10);
  const double noise = 1e-2 * peakStrain(config) * 10;
  int slips = 0, slipsOfTheRough = 0;
  for (std::uint64_t i = 0; i < 60; ++i) {
    const Touch truth{0.0654 * static_cast<double>(i), 10, 0, 0};
    const Eigen::VectorXd strains = ellipseStrains(config, truth) + noiseOf(16, i, noise);
    const auto ratio = [&](const TouchSearch& search) {
      const auto found = search.search(strains, noise);
      return std::abs(found->best.touch.tangential_n_per_m) / found->best.touch.normal_n_per_m;
    };
    slips += ratio(slippery) > 0.4;
    slipsOfTheRough += ratio(rough) > 0.4;
  }
  CHECK_TRUE(slips < slipsOfTheRough);
}

// Where one in a hundred used to be told wrong without a word: a tenth of a pitch beside a gauge, 1 % of
// noise.
TEST(TouchSearch, BandsHoldTheRival) {
  const config::FingerConfig config = ringOf(0.7, 16);
  const TouchModel model(config);
  const TouchSearch search(model, 1);
  const double noise = 0.1 * peakStrain(config);
  int rivals = 0;
  for (std::uint64_t i = 0; i < 40; ++i) {
    const Touch truth{0.0817 + 0.157 * static_cast<double>(i), 10, -2, momentOfWidth(1e-3 / kSurface_m)};
    const auto found = search.search(ellipseStrains(config, truth) + noiseOf(16, i, noise), noise);
    if (!found->rivalAngle_rad) continue;
    ++rivals;
    CHECK_TRUE(offBy(*found->rivalAngle_rad, found->best.touch.angle_rad) <=
               1.65 * std::sqrt(found->best.covariance(0, 0)));
  }
  CHECK_TRUE(rivals > 3);
}
