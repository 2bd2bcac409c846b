#include "host/session/zero_watch.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using session::ZeroWatch;

// A step of a code is 0.03 / 32768 = 0.9 microstrain, the noise of 6 microstrain 6.6 steps.
TEST_GROUP(ZeroWatch) {
  config::FingerConfig config;
  ZeroWatch watch{config.gauges};
};

TEST(ZeroWatch, TheFirstZerosAreNoOthers) {
  CHECK_FALSE(watch.haveMoved({}));
  CHECK_FALSE(watch.haveMoved({32768, 33000, 31000}));
  CHECK_FALSE(watch.haveMoved({32768, 33000, 31000}));
}

TEST(ZeroWatch, ZerosThatFollowDriftAreTheSameHoweverFarTheyCome) {
  std::uint16_t zero = 30000;
  for (int i = 0; i < 100; ++i, zero += 13) CHECK_FALSE(watch.haveMoved({32768, zero}));
}

TEST(ZeroWatch, AZeroThatJumpsIsAnotherOneOfEitherSign) {
  watch.haveMoved({32768, 33000});
  CHECK_TRUE(watch.haveMoved({32768, 33041}));
  CHECK_FALSE(watch.haveMoved({32768, 33041}));
  CHECK_TRUE(watch.haveMoved({32768, 33000}));
}

TEST(ZeroWatch, ANewZeroOfAFingerThatIsAsItWasIsTheSame) {
  watch.haveMoved({32768, 33000});
  CHECK_FALSE(watch.haveMoved({32771, 32997}));
}
