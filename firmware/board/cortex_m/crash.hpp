#pragma once
// When the firmware goes wrong: what happened is kept in memory that a reset leaves alone, and it starts
// again.

#include <cstdint>

#include "firmware/app/crash_record.hpp"

namespace strainfinger::board {

/// How the run before this one ended. Once, at start.
firmware::LastRun takeLastRun();

/// Records that the run before this one hung, where its watchdog could not, and returns that.
firmware::LastRun noteHang();

/// Records and restarts.
[[noreturn]] void crash(Crash cause, std::uint32_t address);

/// For the vector table: every fault and every interrupt that nobody expects. The stack is not trusted; a
/// stack that left its memory is what went wrong.
extern "C" void faultHandler();

/// For a watchdog's interrupt, shortly before it resets: what was being done then is where it hangs.
extern "C" void watchdogHandler();

}  // namespace strainfinger::board
