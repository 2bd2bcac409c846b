#pragma once
// CMSDK APB UART (Arm Cortex-M System Design Kit TRM, DDI 0479D, 4.3): one byte of buffer either way.

#include <cstdint>
#include <optional>

namespace strainfinger::mps2 {

/// Base addresses and interrupts (application notes AN385 and AN386): UART0 is for people, UART1 the CAN bus,
/// UART2 the world. Each has a receive interrupt and, following it, a send interrupt.
inline constexpr std::uintptr_t kUart0 = 0x40004000, kUart1 = 0x40005000, kUart2 = 0x40006000;
inline constexpr unsigned kUart1Interrupt = 2, kUart2Interrupt = 4;

struct UartRegisters {
  std::uint32_t volatile data;
  std::uint32_t volatile state;
  std::uint32_t volatile control;
  std::uint32_t volatile interrupts;  ///< reading: pending; writing 1s clears
  std::uint32_t volatile baudDivider;
};

/// A serial line. Neither end of it ever waits.
class Uart {
 public:
  explicit Uart(std::uintptr_t address) : registers_(*reinterpret_cast<UartRegisters*>(address)) {
    registers_.baudDivider = kSmallestDivider;
    registers_.control = kSend | kReceive | kSendInterrupt | kReceiveInterrupt;
  }

  /// False: the buffer is full, nothing was taken.
  bool put(std::uint8_t byte) noexcept {
    if ((registers_.state & kSendFull) != 0) return false;
    registers_.data = byte;
    return true;
  }

  std::optional<std::uint8_t> get() noexcept {
    if ((registers_.state & kReceiveFull) == 0) return std::nullopt;
    return static_cast<std::uint8_t>(registers_.data);
  }

  void clearInterrupts() noexcept { registers_.interrupts = kSendInterrupted | kReceiveInterrupted; }

 private:
  static constexpr std::uint32_t kSmallestDivider = 16;
  static constexpr std::uint32_t kSend = 1, kReceive = 2, kSendInterrupt = 4, kReceiveInterrupt = 8;
  static constexpr std::uint32_t kSendFull = 1, kReceiveFull = 2;
  static constexpr std::uint32_t kSendInterrupted = 1, kReceiveInterrupted = 2;

  UartRegisters& registers_;
};

}  // namespace strainfinger::mps2
