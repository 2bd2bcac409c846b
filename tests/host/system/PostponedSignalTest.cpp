#include "host/system/postponed_signal.hpp"

#include <CppUTest/TestHarness.h>

using strainfinger::system::PostponedSignal;

namespace {

int pipesBroken = 0;
void countBroken(int) { ++pipesBroken; }

}  // namespace

TEST_GROUP(PostponedSignal) {
  void (*before)(int) = std::signal(SIGPIPE, countBroken);
  void setup() override { pipesBroken = 0; }
  void teardown() override { std::signal(SIGPIPE, before); }
};

TEST(PostponedSignal, ComesWhenItMay) {
  {
    const PostponedSignal postponed(SIGPIPE);
    std::raise(SIGPIPE);
    std::raise(SIGPIPE);
    LONGS_EQUAL(0, pipesBroken);
  }
  LONGS_EQUAL(1, pipesBroken);
}

TEST(PostponedSignal, OneThatDidNotComeDoesNotComeAfterwards) {
  { const PostponedSignal postponed(SIGPIPE); }
  LONGS_EQUAL(0, pipesBroken);
}
