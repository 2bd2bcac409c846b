#pragma once
// What an emulated board can ask the emulator for (Arm semihosting specification 2.0).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace strainfinger::mps2 {

inline std::uint32_t semihost(std::uint32_t operation, const void* parameters) {
  register std::uint32_t first asm("r0") = operation;
  register const void* second asm("r1") = parameters;
  asm volatile("bkpt 0xab" : "+r"(first) : "r"(second) : "memory");
  return first;
}

[[noreturn]] inline void endEmulator(std::uint32_t status) {
  constexpr std::uint32_t kExitExtended = 0x20, kApplicationExit = 0x20026;
  const std::array<std::uint32_t, 2> reason{kApplicationExit, status};
  for (;;) semihost(kExitExtended, reason.data());
}

/// The emulator's command line (`-semihosting-config arg=..`), as far as it fits; returns its length.
inline std::size_t commandLine(std::span<char> text) {
  constexpr std::uint32_t kGetCommandLine = 0x15;
  struct {
    char* text;
    std::size_t size;
  } buffer{text.data(), text.size()};
  return semihost(kGetCommandLine, &buffer) == 0 ? buffer.size : 0;
}

}  // namespace strainfinger::mps2
