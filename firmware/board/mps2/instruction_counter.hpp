#pragma once
// Instructions of a piece of work, exactly, on an emulator that runs with `-icount shift=10,sleep=off`: an
// instruction then takes 1024 ns of its time, and timer 0 counts 40 ns.

#include <cstdint>

namespace strainfinger::mps2 {

/// CMSDK APB timer (Cortex-M System Design Kit TRM, DDI 0479D, 4.1), counting down from its largest value.
class InstructionCounter {
 public:
  InstructionCounter() {
    registers()[kReload] = ~0u;
    registers()[kValue] = ~0u;
    registers()[kControl] = 1;
    const std::uint32_t begin = now();
    overhead_ = now() - begin;
  }

  /// Instructions that `work` takes.
  template <typename Work>
  [[gnu::always_inline]] std::uint32_t of(Work work) const {
    const std::uint32_t begin = now();
    work();
    const std::uint32_t ticks = now() - begin - overhead_;
    return (ticks * 40 + 512) / 1024;
  }

 private:
  enum Register : std::uint8_t { kControl, kValue, kReload };
  static std::uint32_t volatile* registers() { return reinterpret_cast<std::uint32_t volatile*>(0x40000000); }
  static std::uint32_t now() {
    asm volatile("" ::: "memory");
    const std::uint32_t value = ~registers()[kValue];
    asm volatile("" ::: "memory");
    return value;
  }
  std::uint32_t overhead_;
};

}  // namespace strainfinger::mps2
