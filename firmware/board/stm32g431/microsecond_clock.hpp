#pragma once
// hal::Clock on TIM2, which has 32 bits: RM0440 chapter 30.

#include "firmware/board/stm32g431/clock_tree.hpp"
#include "firmware/board/stm32g431/registers/timers.hpp"
#include "hal/clock.hpp"

namespace strainfinger::stm32g431 {

/// Contract: hal/clock.hpp. Counts from start() on.
template <RegisterBus Bus>
class MicrosecondClock {
 public:
  explicit MicrosecondClock(Bus bus) : bus_(bus) {}

  void start() noexcept {
    enableClock(bus_, Rcc::Apb1Enr1::tim2(1));
    bus_.write(Tim2::Psc::address, kCore_hz / 1'000'000 - 1);
    bus_.write(Tim2::Arr::address, 0xFFFF'FFFF);
    write(bus_, Tim2::Egr::update(1));  // the prescaler counts from the next update on: this one
    write(bus_, Tim2::Cr1::enable(1));
  }

  std::uint32_t now_us() const noexcept { return bus_.read(Tim2::Cnt::address); }

 private:
  [[no_unique_address]] Bus bus_;
};

}  // namespace strainfinger::stm32g431
