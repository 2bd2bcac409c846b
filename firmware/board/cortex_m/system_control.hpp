#pragma once
// The few registers and instructions of a Cortex-M that every board uses (Armv7-M ARM, B3.2, B3.4).

#include <cstdint>

namespace strainfinger::board {

/// Resets the processor and its peripherals; memory keeps what is in it.
[[noreturn]] inline void resetSystem() {
  constexpr std::uint32_t kKey = 0x05FA0000, kRequest = 1u << 2;
  asm volatile("dsb" ::: "memory");
  *reinterpret_cast<std::uint32_t volatile*>(0xE000ED0C) = kKey | kRequest;  // AIRCR
  for (;;) asm volatile("dsb");
}

/// Exceptions go through the table at `address`, a multiple of 512, wherever a bootloader left them. A
/// processor without the register has its table at 0 and ignores the write.
inline void useVectors(std::uint32_t address) {
  *reinterpret_cast<std::uint32_t volatile*>(0xE000ED08) = address;  // VTOR
  asm volatile("dsb\n isb" ::: "memory");
}

/// Makes the 16 KiB below `address`, which is a multiple of that, a place where every access is a fault; all
/// else stays as it is (memory protection unit, Armv7-M ARM, B3.5; region 0).
inline void forbidBelow(std::uint32_t address) {
  constexpr std::uint32_t kSize = 1u << 14, kNoAccess = 0, kSizeField = 13u << 1, kEnableRegion = 1;
  constexpr std::uint32_t kEnable = 1, kDefaultMap = 1u << 2;
  auto* const unit = reinterpret_cast<std::uint32_t volatile*>(0xE000ED94);  // CTRL, RNR, RBAR, RASR
  unit[1] = 0;
  unit[2] = address - kSize;
  unit[3] = kNoAccess | kSizeField | kEnableRegion;
  unit[0] = kEnable | kDefaultMap;
  asm volatile("dsb\n isb" ::: "memory");
}

/// From here on interrupts end sleep() but run no handler.
inline void maskInterrupts() { asm volatile("cpsid i" ::: "memory"); }

/// Until an enabled interrupt is pending.
inline void sleep() { asm volatile("dsb\n wfi" ::: "memory"); }

inline void enableInterrupt(unsigned number) {
  reinterpret_cast<std::uint32_t volatile*>(0xE000E100)[number / 32] = 1u << number % 32;  // NVIC_ISER
}
inline void forgetInterrupt(unsigned number) {
  reinterpret_cast<std::uint32_t volatile*>(0xE000E280)[number / 32] = 1u << number % 32;  // NVIC_ICPR
}

}  // namespace strainfinger::board
