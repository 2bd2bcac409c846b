#pragma once
// The contract of hal::Clock as tests, for any backend:
//
//   struct MyBench {
//     MyClock& clock();
//     void pass(std::uint32_t time_us);   // so much time goes by, or a little more
//   };
//   CLOCK_CONTRACT(MyClock, MyBench)

#include <CppUTest/TestHarness.h>

#include <cstdint>

#include "hal/clock.hpp"

namespace strainfinger::contract {

template <typename Bench>
class ClockContract {
 public:
  void itCountsMicroseconds() {
    constexpr std::uint32_t kTime_us = 2000;
    const std::uint32_t start_us = bench_.clock().now_us();
    bench_.pass(kTime_us);
    const std::uint32_t elapsed_us = bench_.clock().now_us() - start_us;
    CHECK_TRUE(elapsed_us >= kTime_us);
    CHECK_TRUE(elapsed_us < 1000 * kTime_us);  // a unit off would be 1000 times; a busy machine isn't
  }

  void itNeverGoesBack() {
    std::uint32_t before_us = bench_.clock().now_us();
    for (int i = 0; i < 1000; ++i) {
      const std::uint32_t now_us = bench_.clock().now_us();
      CHECK_TRUE(now_us - before_us < UINT32_MAX / 2);
      before_us = now_us;
    }
  }

 private:
  Bench bench_;
};

}  // namespace strainfinger::contract

#define CLOCK_CONTRACT(Backend, Bench)                                             \
  TEST_GROUP(Clock_##Backend) {                                                    \
    strainfinger::contract::ClockContract<Bench> contract;                         \
  };                                                                               \
  TEST(Clock_##Backend, ItCountsMicroseconds) { contract.itCountsMicroseconds(); } \
  TEST(Clock_##Backend, ItNeverGoesBack) { contract.itNeverGoesBack(); }
