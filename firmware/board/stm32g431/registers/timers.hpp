#pragma once
// Timers: TIM1 (RM0440 chapter 29), TIM2 and TIM3 (chapter 30).

#include "firmware/board/stm32g431/registers/register.hpp"

namespace strainfinger::stm32g431 {

enum TimerOutput : std::uint32_t { kAtUpdate = 2 };
enum TimerSlaveMode : std::uint32_t { kCountInput = 7 };  ///< counts the edges of the trigger input
enum TimerInput : std::uint32_t { kItr0 = 0 };            ///< TIM1's TRGO for TIM2 and TIM3

/// What these timers have in common, RM0440 sections 29.6 and 30.5.
template <std::uint32_t kBase>
struct Timer {
  struct Cr1 : Register<kBase + 0x00> {
    static constexpr Field<Cr1, 0> enable{};
  };
  struct Cr2 : Register<kBase + 0x04> {
    static constexpr Field<Cr2, 4, 3> triggerOutput{};  ///< MMS: TimerOutput
  };
  struct Smcr : Register<kBase + 0x08> {
    static constexpr Field<Smcr, 0, 3> slaveMode{};     ///< SMS: TimerSlaveMode
    static constexpr Field<Smcr, 4, 3> triggerInput{};  ///< TS: TimerInput
  };
  struct Egr : Register<kBase + 0x14> {
    static constexpr Field<Egr, 0>
        update{};  ///< loads the prescaler, restarts the count, gives an update event
  };
  struct Cnt : Register<kBase + 0x24> {
    static constexpr Field<Cnt, 0, 16> count16{};
  };
  struct Psc : Register<kBase + 0x28> {};  ///< divides the timer's clock by this + 1
  struct Arr : Register<kBase + 0x2C> {};  ///< the last count before it starts again from 0
};

using Tim1 = Timer<0x4001'2C00>;
using Tim2 = Timer<0x4000'0000>;  ///< 32 bits
using Tim3 = Timer<0x4000'0400>;  ///< 16 bits

}  // namespace strainfinger::stm32g431
