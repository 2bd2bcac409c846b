#include "firmware/board/cortex_m/crash.hpp"

#include "firmware/board/cortex_m/startup.hpp"
#include "firmware/board/cortex_m/system_control.hpp"

extern "C" const std::uint32_t stack_bottom[];  // from sections.ld

namespace strainfinger::board {
namespace {

[[gnu::section(".noinit")]] firmware::CrashRecord record;

constexpr std::size_t kFrameWords = 8;  // r0-r3, r12, lr, pc, xPSR: Armv7-M ARM, B1.5.6
constexpr std::size_t kFramePc = 6;

}  // namespace

firmware::LastRun takeLastRun() { return record.take(); }

firmware::LastRun noteHang() {
  record.write(Crash::kHang, 0);
  return record.take();
}

void crash(Crash cause, std::uint32_t address) {
  record.write(cause, address);
  resetSystem();
}

/// `frame`: what the processor stacked, if there was stack.
extern "C" [[noreturn, gnu::used]] void crashWithFrame(const std::uint32_t* frame, Crash cause) {
  if (frame < stack_bottom || frame + kFrameWords > stack_top) crash(Crash::kStackOverflow, 0);
  crash(cause, frame[kFramePc]);
}

// Crash::kHardFault and Crash::kHang, on a stack begun anew.
static_assert(static_cast<int>(Crash::kHardFault) == 1 && static_cast<int>(Crash::kHang) == 4);
extern "C" [[gnu::naked]] void faultHandler() {
  asm volatile("mrs r0, msp\n ldr r1, =stack_top\n mov sp, r1\n movs r1, #1\n b crashWithFrame");
}
extern "C" [[gnu::naked]] void watchdogHandler() {
  asm volatile("mrs r0, msp\n ldr r1, =stack_top\n mov sp, r1\n movs r1, #4\n b crashWithFrame");
}

}  // namespace strainfinger::board

namespace {
constexpr std::uint32_t kCallBytes = 4;  ///< of a BL
}

// What the C library calls when an assertion fails, and when it gives up.
extern "C" [[noreturn]] void __assert_func(const char*, int, const char*, const char*) {
  strainfinger::board::crash(
      strainfinger::Crash::kAssertion,
      (reinterpret_cast<std::uint32_t>(__builtin_return_address(0)) & ~1u) - kCallBytes);
}
extern "C" [[noreturn]] void abort() { __assert_func(nullptr, 0, nullptr, nullptr); }
