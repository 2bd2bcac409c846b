#include "firmware/board/cortex_m/startup.hpp"
#include "firmware/board/mps2/semihosting.hpp"

namespace strainfinger::board {

/// A test image that goes wrong ends the emulator: no test passes by restarting.
extern "C" void wentWrong() { mps2::endEmulator(99); }

[[gnu::section(".vectors"), gnu::used]] constinit const auto kVectors = vectorTable<16>(stack_top, wentWrong);

}  // namespace strainfinger::board
