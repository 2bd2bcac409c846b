#pragma once
// Registers where they are: in the processor's memory.

#include "firmware/board/stm32g431/registers/register.hpp"

namespace strainfinger::stm32g431 {

struct MemoryBus {
  static std::uint32_t read(std::uint32_t address) noexcept {
    return *reinterpret_cast<const volatile std::uint32_t*>(address);
  }
  static void write(std::uint32_t address, std::uint32_t value) noexcept {
    *reinterpret_cast<volatile std::uint32_t*>(address) = value;
  }
  static std::uint32_t addressOf(void* memory) noexcept { return reinterpret_cast<std::uintptr_t>(memory); }
};

static_assert(RegisterBus<MemoryBus>);

}  // namespace strainfinger::stm32g431
