#include "host/system/stop_signal.hpp"

#include <CppUTest/TestHarness.h>

using strainfinger::system::StopSignal;

namespace {

int outer = 0;
void countOuter(int) { ++outer; }

}  // namespace

TEST_GROUP(StopSignal){};

TEST(StopSignal, NobodyAskedAtFirst) { CHECK_FALSE(StopSignal().asked()); }

TEST(StopSignal, InterruptAndTerminateAskToStop) {
  for (const int signal : {SIGINT, SIGTERM}) {
    const StopSignal stop;
    std::raise(signal);
    CHECK_TRUE(stop.asked());
  }
}

TEST(StopSignal, LaterOnesStartAfresh) {
  {
    const StopSignal stop;
    std::raise(SIGINT);
  }
  CHECK_FALSE(StopSignal().asked());
}

TEST(StopSignal, ThePreviousHandlerIsBackAfterwards) {
  const auto before = std::signal(SIGTERM, countOuter);
  { const StopSignal stop; }
  std::raise(SIGTERM);
  std::signal(SIGTERM, before);
  LONGS_EQUAL(1, outer);
}
