#include <cassert>
#include <utility>

#include "firmware/app/run.hpp"
#include "firmware/app/slcan_port.hpp"
#include "firmware/app/whole_tables.hpp"
#include "firmware/board/cortex_m/crash.hpp"
#include "firmware/board/cortex_m/linked_tables.hpp"
#include "firmware/board/cortex_m/startup.hpp"
#include "firmware/board/cortex_m/system_control.hpp"
#include "firmware/board/mps2/console.hpp"
#include "firmware/board/mps2/semihosting.hpp"
#include "firmware/board/mps2/settings.hpp"
#include "firmware/board/mps2/timer.hpp"
#include "firmware/board/mps2/uart.hpp"
#include "firmware/board/mps2/watchdog.hpp"
#include "firmware/board/mps2/world.hpp"

namespace strainfinger::mps2 {
namespace {

using Can = firmware::SlcanPort<Uart>;
using TheWorld = World<Uart, Can, Timer>;

constexpr std::array<unsigned, 5> kWakingInterrupts{kUart1Interrupt, kUart1Interrupt + 1, kUart2Interrupt,
                                                    kUart2Interrupt + 1, kTimer1Interrupt};

[[noreturn]] void hang() {
  for (;;) asm volatile("");
}

void doHarm(Harm harm) {
  switch (harm) {
    case Harm::kHardFault:
      *reinterpret_cast<std::uint32_t volatile*>(0xF0000000) = 0;
      return;
    case Harm::kAssertion:
      assert(false);
      return;
    case Harm::kStackOverflow:
      asm volatile("sub sp, %0\n push {r0-r7}" ::"r"(2048));
      return;
    case Harm::kHang:
      hang();
  }
}

void act(const WorldRecord& record, Can& can) {
  switch (record.kind) {
    case RecordKind::kHarm:
      return doHarm(static_cast<Harm>(record.payload[0]));
    case RecordKind::kBus:
      return can.setBus({.state = static_cast<hal::CanState>(record.payload[0]),
                         .txErrors = record.payload[1],
                         .rxErrors = record.payload[2]});
    case RecordKind::kEnd:
      endEmulator(record.payload[0]);
    default:
      return;
  }
}

/// A restart that was asked for leaves it in memory that a reset leaves alone: the board has no register for
/// that.
[[gnu::section(".noinit")]] std::uint32_t restartMark;
constexpr std::uint32_t kAskedFor = 0x4B534152;

bool wasAskedToRestart() { return std::exchange(restartMark, 0) == kAskedFor; }

[[noreturn]] void restart() {
  restartMark = kAskedFor;
  board::resetSystem();
}

[[gnu::noinline]] void greet(const firmware::LastRun& last) {
  Console console;
  console << "strainfinger on mps2: restarts " << last.restarts << ", crash "
          << static_cast<std::uint32_t>(last.crash) << " at 0x";
  console.hex(last.crash_address);
  console << "\n";
}

Timer timer;

/// Ends the emulator when its command line asks for a node that cannot be. Starts the timer if it asks for
/// one.
[[gnu::noinline]] firmware::FingerSettings readSettings(const Timer*& chosen) {
  std::array<char, 64> text;
  const std::string_view words(text.data(), commandLine(text));
  if (isTimed(words)) {
    timer.start();
    chosen = &timer;
  }
  const auto node = nodeOf(words);
  if (!node) {
    Console() << "node= must be 1 to 63\n";
    endEmulator(2);
  }
  return settingsOf(*node);
}

}  // namespace

[[noreturn]] void run() {
  for (const unsigned interrupt : kWakingInterrupts) board::enableInterrupt(interrupt);
  static Uart bus(kUart1), world_line(kUart2);
  const firmware::LastRun last = board::takeLastRun();
  greet(last);
  const Timer* chosenTimer = nullptr;
  static const firmware::FingerSettings settings = readSettings(chosenTimer);
  const bool wasAsked = wasAskedToRestart();
  static Can can(bus, wasAsked || last.restarts != 0);  // the host has not closed it
  world_line.put(kReady);
  static TheWorld world(world_line, can, chosenTimer);
  static Watchdog watchdog(world, wasAsked ? ResetCause::kSoftware : firmware::resetCause(last));
  const auto wait = [] {
    bus.clearInterrupts();
    world_line.clearInterrupts();
    Timer::clearInterrupt();
    for (const unsigned interrupt : kWakingInterrupts) board::forgetInterrupt(interrupt);
    can.poll();
    if (!world.poll([](const WorldRecord& record) { act(record, can); }) && !can.hasArrived()) {
      watchdog.rest();
      board::sleep();
    }
    watchdog.run();
    if (watchdog.starved()) board::crash(Crash::kStarved, 0);
  };
  watchdog.run();
  firmware::runFinger(firmware::ifWhole(board::kLinkedTables), settings, last, world, can, world, watchdog,
                      hal::noStore, hal::noStore, firmware::BoardActions{wait, [] { restart(); }});
}

}  // namespace strainfinger::mps2

namespace strainfinger::board {

[[gnu::section(".vectors"), gnu::used]] constinit const auto kVectors = [] {
  auto table = vectorTable<16>(stack_top, faultHandler);
  table.nonMaskable = watchdogHandler;
  return table;
}();

void runBoard() { mps2::run(); }

}  // namespace strainfinger::board
