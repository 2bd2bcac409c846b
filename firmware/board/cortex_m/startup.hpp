#pragma once
// From reset to the board's main(): the part that is the same on every Cortex-M.

#include <array>
#include <cstddef>
#include <cstdint>

namespace strainfinger::board {

/// Where execution starts: takes over the exceptions, guards the stack, sets up initialised and cleared
/// memory, then runs the board.
extern "C" [[noreturn]] void resetHandler();

/// Each board's own.
[[noreturn]] void runBoard();

using Handler = void (*)();

/// Initial stack pointer, then the system exceptions in the order of the Armv7-M ARM, B1.5.2, then the
/// interrupts.
template <std::size_t Interrupts>
struct VectorTable {
  const void* stackTop;
  Handler reset;
  Handler nonMaskable;
  Handler hardFault;
  Handler memoryFault;
  Handler busFault;
  Handler usageFault;
  std::array<Handler, 4> reserved7to10;
  Handler supervisorCall;
  Handler debugMonitor;
  Handler reserved13;
  Handler pendSupervisorCall;
  Handler sysTick;
  std::array<Handler, Interrupts> interrupts;
};

/// A table whose every exception is `unexpected`; boards then put their own in.
template <std::size_t Interrupts>
consteval VectorTable<Interrupts> vectorTable(const void* stackTop, Handler unexpected) {
  VectorTable<Interrupts> table{stackTop,   resetHandler, unexpected, unexpected, unexpected,
                                unexpected, unexpected,   {},         unexpected, unexpected,
                                nullptr,    unexpected,   unexpected, {}};
  table.interrupts.fill(unexpected);
  return table;
}

}  // namespace strainfinger::board

extern "C" const std::uint32_t stack_top[];  ///< from sections.ld
