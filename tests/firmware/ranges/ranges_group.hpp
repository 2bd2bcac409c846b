#pragma once
// What the proofs of ranges share: bounds of all that a type holds, and that no result has left its word.

#include <cmath>
#include <cstdint>

#include "firmware/core/packed.hpp"

#include <CppUTest/TestHarness.h>

namespace strainfinger::firmware {

/// Eight readings of a ring, the last of them the outer pair's difference over sqrt(2): see ProblemTest.
inline const double kReadingsLength = std::exp2(14.6);
/// All readings of a ring.
inline const double kRingLength = std::exp2(15.5) + 3;  // rounded: 32 of them, by half a step each

struct RangesGroup : Utest {
  void setup() override {
    overflows = 0;
    choices = {};  // a test that failed left them where it was
  }
  static void checkNone() { LONGS_EQUAL(0, overflows); }

  static Number anyOf(int bits) {
    return {-(std::int64_t{1} << (bits - 1)), (std::int64_t{1} << (bits - 1)) - 1};
  }
};

}  // namespace strainfinger::firmware
