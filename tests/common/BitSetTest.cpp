#include "common/bit_set.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {
enum class Lamp : std::uint8_t { kRed = 0, kGreen = 3, kBlue = 7 };
using Lamps = BitSet<Lamp>;
}  // namespace

TEST_GROUP(BitSet) {};

TEST(BitSet, IsEmptyAtFirst) {
  CHECK(Lamps{}.empty());
  LONGS_EQUAL(0, Lamps{}.raw());
}

TEST(BitSet, PutsEachBitAtItsNumber) {
  LONGS_EQUAL(0x88, (Lamps{Lamp::kBlue, Lamp::kGreen}).raw());
  LONGS_EQUAL(0x01, (Lamps{Lamp::kRed}).raw());
}

TEST(BitSet, KnowsWhatItHas) {
  const Lamps lamps{Lamp::kGreen};
  CHECK_TRUE(lamps.has(Lamp::kGreen));
  CHECK_FALSE(lamps.has(Lamp::kRed));
  CHECK_FALSE(lamps.empty());
}

TEST(BitSet, SettingAndClearingLeavesTheOtherBits) {
  Lamps lamps = Lamps::fromRaw(0xF0);
  lamps.set(Lamp::kRed);
  lamps.set(Lamp::kBlue, false);
  LONGS_EQUAL(0x71, lamps.raw());
}

TEST(BitSet, ASetOfMoreThanEightBitsHasAWiderInteger) {
  enum class Key : std::uint8_t { kFirst = 0, kLast = 15 };
  BitSet<Key, std::uint16_t> keys{Key::kLast};
  LONGS_EQUAL(0x8000, keys.raw());
  keys.set(Key::kFirst);
  keys.set(Key::kLast, false);
  LONGS_EQUAL(1, keys.raw());
}

TEST(BitSet, KeepsBitsWithoutAName) { LONGS_EQUAL(0x42, Lamps::fromRaw(0x42).raw()); }
