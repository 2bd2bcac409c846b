// What the benchmark compiles with other rules is the firmware's locator, and follows these rules.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "host/bench/make_bundle.hpp"
#include "host/bench/methods/catalogue.hpp"
#include "host/bench/score.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::bench;

TEST_GROUP(Variants) {
  static constexpr std::uint64_t kSeed = 78;
  const BenchFinger finger;
  const NoiseTables tables = tablesFor(finger, kLevelSettings[1]);

  void setup() override { std::printf("seed %llu ", static_cast<unsigned long long>(kSeed)); }

  static const Variant& named(const char* part) {
    const auto* found = std::find_if(kVariants.begin(), kVariants.end(), [&](const Variant& each) {
      return std::strstr(each.name, part) != nullptr;
    });
    CHECK_TEXT(found != kVariants.end(), part);
    return *found;
  }
  /// Visits the fits of 500 readings at 0.1 % of noise.
  template <typename Visit>
  void forEachFit(const Variant& variant, Visit visit) const {
    for (std::uint64_t i = 0; i < 500; ++i) {
      const Reading reading = readingOf(finger, kSeed, i, 1e-3);
      visit(variant.fitOf(tables.usual, reading.sample), reading);
    }
  }
  double worst_pitch(const Variant& variant) const {
    double worst = 0;
    forEachFit(variant, [&](const firmware::Fit& fit, const Reading& reading) {
      const double apart = placeOf(tables.usual.constants, fit).position_pitch - reading.truth.position_pitch;
      worst = std::max(worst, std::abs(std::remainder(apart, double{kGauges})));
    });
    return worst;
  }
  int oddestRow(const Variant& variant) const {
    std::ptrdiff_t bits = 0;
    forEachFit(variant,
               [&](const firmware::Fit& fit, const Reading&) { bits |= fit.row - tables.usual.rows.data(); });
    return 1 << std::countr_zero(static_cast<unsigned>(bits));
  }
};

// Within an eighth of a pitch: the farthest that a single step leads. A wrong branch is beyond half a pitch.
TEST(Variants, EachFindsEveryContact) {
  for (const Variant& variant : kVariants) CHECK_TEXT(worst_pitch(variant) < 0.125, variant.name);
}

TEST(Variants, MoreRowsAreMoreAccurate) {
  CHECK(worst_pitch(named("refined with 32")) < worst_pitch(named("refined with 16")));
  CHECK(worst_pitch(named("step of 2 rows")) < worst_pitch(named("one step")));
}

TEST(Variants, TheFirmwaresOwnRuleGivesTheFirmwaresAnswers) {
  forEachFit(named("64"), [&](const firmware::Fit& fit, const Reading& reading) {
    const auto own = fitOf(tables.usual, firmware::FitMode::kRefined, reading.sample);
    CHECK(fit.best == own.best);
    CHECK(fit.row == own.row);
  });
}

TEST(Variants, EachUsesItsRowsOnly) {
  LONGS_EQUAL(1, oddestRow(named("step of 2 rows")));
  LONGS_EQUAL(2, oddestRow(named("refined with 32")));
  LONGS_EQUAL(4, oddestRow(named("refined with 16")));
  LONGS_EQUAL(4, oddestRow(named("three-point with 16")));
}

// A step that is not the last is followed to its nearest row: none ends more than 5/8 of a spacing from it.
TEST(Variants, OneStepEndsWhereverItLeads) {
  const auto fromRow = [&](const Variant& variant) {
    int far = 0;
    forEachFit(variant, [&](const firmware::Fit& fit, const Reading&) {
      const int row = static_cast<int>(fit.row - tables.usual.rows.data());
      const double rows = std::abs(std::ldexp(fit.offset(kGauges), -firmware::kRowBits));
      far += std::abs(rows - row) > 0.63 ? 1 : 0;
    });
    return far;
  };
  LONGS_EQUAL(0, fromRow(named("64")));
  CHECK(fromRow(named("one step")) > 200);
}

TEST(Variants, ThreePointAnswersRestOnThree) {
  int three = 0;
  forEachFit(named("three-point with 16"), [&](const firmware::Fit& fit, const Reading&) {
    three += fit.readings == firmware::FitMode::kThreePoint ? 1 : 0;
  });
  CHECK(three > 400);
}
