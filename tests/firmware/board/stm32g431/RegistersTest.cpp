// Our registers and constants against those of ST's headers.
#include <span>

#include "tests/firmware/board/stm32g431/register_comparisons.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::stm32g431;

namespace {

void checkAll(std::span<const Comparison> comparisons) {
  for (const Comparison& each : comparisons) LONGS_EQUAL_TEXT(each.theirs, each.ours, each.name);
}

}  // namespace

TEST_GROUP(Registers) {};

TEST(Registers, HaveStsAddressesAndMasks) { checkAll(kRegisters); }

TEST(Registers, TakeStsValues) { checkAll(kConstants); }
