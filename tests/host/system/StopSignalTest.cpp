#include "host/system/stop_signal.hpp"

#include <CppUTest/TestHarness.h>

using strainfinger::system::StopSignal;

namespace {

int outer = 0;
void countOuter(int) { ++outer; }

}  // namespace

TEST_GROUP(StopSignal) {};

TEST(StopSignal, NobodyAskedAtFirst) { CHECK_FALSE(StopSignal().asked()); }

TEST(StopSignal, InterruptTerminateAndHangUpAskToStop) {
  const auto before = std::signal(SIGHUP, SIG_DFL);  // the test may run under nohup
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    const StopSignal stop;
    std::raise(signal);
    CHECK_TRUE(stop.asked());
  }
  std::signal(SIGHUP, before);
}

TEST(StopSignal, UnderNohupAHangUpIsNoReasonToStop) {
  const auto before = std::signal(SIGHUP, SIG_IGN);
  {
    const StopSignal stop;
    std::raise(SIGHUP);
    CHECK_FALSE(stop.asked());
  }
  CHECK_TRUE(std::signal(SIGHUP, before) == SIG_IGN);
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
