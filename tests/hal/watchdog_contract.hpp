#pragma once
// What can be tested of hal::Watchdog's contract without a reset, for any backend:
//
//   struct MyBench {
//     MyWatchdog& watchdog();
//   };
//   WATCHDOG_CONTRACT(MyWatchdog, MyBench)

#include <CppUTest/TestHarness.h>

#include "hal/watchdog.hpp"

namespace strainfinger::contract {

template <typename Bench>
class WatchdogContract {
 public:
  void theResetCauseStays() {
    const hal::ResetCause cause = bench_.watchdog().resetCause();
    for (int i = 0; i < 3; ++i) bench_.watchdog().feed();
    CHECK_TRUE(bench_.watchdog().resetCause() == cause);
  }

 private:
  Bench bench_;
};

}  // namespace strainfinger::contract

#define WATCHDOG_CONTRACT(Backend, Bench)                     \
  TEST_GROUP(Watchdog_##Backend) {                            \
    strainfinger::contract::WatchdogContract<Bench> contract; \
  };                                                          \
  TEST(Watchdog_##Backend, TheResetCauseStays) { contract.theResetCauseStays(); }
