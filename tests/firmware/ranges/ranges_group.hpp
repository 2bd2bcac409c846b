#pragma once
// What the proofs of ranges share: nothing has left its word, and no way through the code is forgotten.

#include <cstdint>

#include "firmware/core/integers.hpp"

#include <CppUTest/TestHarness.h>

namespace strainfinger::firmware {

/// Of a sum of squared residuals by one step, as far as bounds know; and what a step leaves.
inline constexpr Exact kMostReduction = Exact{1} << 59;
inline constexpr Exact kMostLeft = Exact{1} << 48;

struct RangesGroup : Utest {
  void setup() override {
    overflows = 0;
    choices = {};  // a test that failed left them where it was
  }
  static void checkNone() { LONGS_EQUAL(0, overflows); }
  /// That the proof watches: what ran last was beyond the domain.
  static void checkSome() {
    CHECK_TRUE_TEXT(overflows > 0, "beyond its domain, and no overflow was noted");
    overflows = 0;
  }
  static void checkWithin(const auto& number, Exact least, Exact most) {
    CHECK_TRUE(number.least() >= least && number.most() <= most);
  }

  template <typename T = Number>
  static T within(std::int64_t size) {
    return {-Exact{size}, Exact{size}};
  }
};

}  // namespace strainfinger::firmware
