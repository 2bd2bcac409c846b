#include "host/system/metronome.hpp"

#include <CppUTest/TestHarness.h>

using namespace std::chrono_literals;
using strainfinger::system::Metronome;
using Clock = std::chrono::steady_clock;

TEST_GROUP(Metronome){};

TEST(Metronome, ABeatTakesItsPeriodAndNoLessInTheSum) {
  const auto start = Clock::now();
  Metronome metronome(2ms);
  std::uint64_t beats = 0;
  for (int i = 0; i < 10; ++i) beats += metronome.wait();
  const auto elapsed = Clock::now() - start;
  CHECK_TRUE(beats >= 10);
  CHECK_TRUE(elapsed >= beats * 2ms);
}

// The bound is loose for busy machines; sleeping through the lateness again would take 40 ms.
TEST(Metronome, ALateCallerIsToldOfEveryBeatAtOnce) {
  Metronome metronome(2ms);
  std::this_thread::sleep_for(21ms);
  const auto late = Clock::now();
  CHECK_TRUE(metronome.wait() >= 10);
  CHECK_TRUE(Clock::now() - late < 20ms);
}

TEST(Metronome, LatenessDoesNotMoveTheBeat) {
  const auto start = Clock::now();
  Metronome metronome(10ms);
  std::this_thread::sleep_for(15ms);
  std::uint64_t beats = metronome.wait();
  beats += metronome.wait();
  const auto elapsed = Clock::now() - start;
  CHECK_TRUE(elapsed >= beats * 10ms);
  CHECK_TRUE(elapsed < (beats + 1) * 10ms + 50ms);
}
