#pragma once
// Ending the emulator (Arm semihosting specification, SYS_EXIT_EXTENDED).

#include <array>
#include <cstdint>

namespace strainfinger::mps2 {

[[noreturn]] inline void endEmulator(std::uint32_t status) {
  constexpr std::uint32_t kExitExtended = 0x20, kApplicationExit = 0x20026;
  const std::array<std::uint32_t, 2> reason{kApplicationExit, status};
  register std::uint32_t operation asm("r0") = kExitExtended;
  register const void* parameters asm("r1") = reason.data();
  for (;;) asm volatile("bkpt 0xab" : "+r"(operation) : "r"(parameters) : "memory");
}

}  // namespace strainfinger::mps2
