#pragma once
// Watchdog and identity: IWDG (RM0440 chapter 42), device signature (chapter 48), debug support (chapter 47).

#include "firmware/board/stm32g431/registers/register.hpp"

namespace strainfinger::stm32g431 {

/// Independent watchdog, RM0440 section 42.4.
struct Iwdg {
  static constexpr std::uint32_t base = 0x4000'3000;

  struct Kr : Register<base + 0x00> {};
  enum Key : std::uint32_t { kFeed = 0xAAAA, kUnlock = 0x5555, kStart = 0xCCCC };
  struct Pr : Register<base + 0x04> {};   ///< divides the 32 kHz by 4 << this
  struct Rlr : Register<base + 0x08> {};  ///< 12 bits
  struct Sr : Register<base + 0x0C> {
    static constexpr Field<Sr, 0, 3> updating{};  ///< Pr, Rlr, window
  };
};

/// 96 bits that no other device has, RM0440 section 48.1.
struct UniqueIdWords {
  static constexpr std::uint32_t base = 0x1FFF'7590;
};

/// RM0440 section 47.16.
struct Dbgmcu {
  struct Apb1Fzr1 : Register<0xE004'2008> {  ///< what stands still while a debugger holds the processor
    static constexpr Field<Apb1Fzr1, 0> stopTim2{};
    static constexpr Field<Apb1Fzr1, 12> stopWatchdog{};
  };
};

}  // namespace strainfinger::stm32g431
