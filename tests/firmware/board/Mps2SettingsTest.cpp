#include "firmware/board/mps2/settings.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::mps2;

namespace {

int node(std::string_view commandLine) { return nodeOf(commandLine).value_or(0); }

}  // namespace

TEST_GROUP(Mps2Settings) {};

TEST(Mps2Settings, TheNodeIsOnTheCommandLine) {
  LONGS_EQUAL(2, node("image node=2"));
  LONGS_EQUAL(63, node("image node=63"));
}

TEST(Mps2Settings, WithoutOneItIsTheFirst) {
  LONGS_EQUAL(kFirstNode, node("image"));
  LONGS_EQUAL(kFirstNode, node(""));
}

TEST(Mps2Settings, WhatIsNoNodeIsRefused) {
  for (const char* words : {"node=", "node=0", "node=64", "node=256", "node=257", "node=-1", "node=x",
                            "node=2x", "node=2 node=3"})
    CHECK_FALSE(nodeOf(words));
}

TEST(Mps2Settings, TimeIsTheTimersWhenAskedFor) {
  CHECK_TRUE(isTimed("image time=timer node=2"));
  CHECK_FALSE(isTimed("image node=2"));
}

TEST(Mps2Settings, AnEmulatedFingerSaysWhatItIs) {
  const firmware::FingerSettings settings = settingsOf(7);
  LONGS_EQUAL(7, settings.node);
  CHECK_TRUE(settings.standingFlags.has(FingerFlag::kSimulated));
  CHECK_TRUE(settings.standingFlags.has(FingerFlag::kUncalibrated));
}
