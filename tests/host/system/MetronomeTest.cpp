#include "host/system/metronome.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace std::chrono_literals;
using strainfinger::system::Metronome;
using Clock = std::chrono::steady_clock;

TEST_GROUP(Metronome) {
  /// A busy machine may wake a sleeper late, but not every time.
  template <typename Measure>
  static Clock::duration shortestOf(Measure measure) {
    Clock::duration shortest = measure();
    for (int i = 1; i < 10; ++i) shortest = std::min(shortest, measure());
    return shortest;
  }
};

TEST(Metronome, ABeatTakesItsPeriodAndNoLessInTheSum) {
  const auto start = Clock::now();
  Metronome metronome(2ms);
  std::uint64_t beats = 0;
  for (int i = 0; i < 10; ++i) beats += metronome.wait();
  const auto elapsed = Clock::now() - start;
  CHECK_TRUE(beats >= 10);
  CHECK_TRUE(elapsed >= beats * 2ms);
}

// Sleeping through the lateness again would take 20 ms.
TEST(Metronome, ALateCallerIsToldOfEveryBeatAtOnce) {
  const auto late = shortestOf([] {
    Metronome metronome(2ms);
    std::this_thread::sleep_for(21ms);
    const auto begin = Clock::now();
    CHECK_TRUE(metronome.wait() >= 10);
    return Clock::now() - begin;
  });
  CHECK_TRUE(late < 10ms);
}

// Were the beat moved by it, the second would come 5 ms late.
TEST(Metronome, LatenessDoesNotMoveTheBeat) {
  const auto late = shortestOf([] {
    const auto start = Clock::now();
    Metronome metronome(10ms);
    std::this_thread::sleep_for(15ms);
    std::uint64_t beats = metronome.wait();
    beats += metronome.wait();
    return Clock::now() - start - static_cast<int>(beats) * 10ms;
  });
  CHECK_TRUE(late >= 0ms);
  CHECK_TRUE(late < 4ms);
}
