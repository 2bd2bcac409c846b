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
