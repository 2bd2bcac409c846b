// The finger board: what is on it, put together.

#include "firmware/app/run.hpp"
#include "firmware/board/cortex_m/crash.hpp"
#include "firmware/board/cortex_m/linked_tables.hpp"
#include "firmware/board/cortex_m/startup.hpp"
#include "firmware/board/stm32g431/can_rates.hpp"
#include "firmware/board/stm32g431/clock_tree.hpp"
#include "firmware/board/stm32g431/fdcan_port.hpp"
#include "firmware/board/stm32g431/flash_layout.hpp"
#include "firmware/board/stm32g431/flash_store.hpp"
#include "firmware/board/stm32g431/gauge_converter.hpp"
#include "firmware/board/stm32g431/microsecond_clock.hpp"
#include "firmware/board/stm32g431/registers/memory_bus.hpp"
#include "firmware/board/stm32g431/send_rules.hpp"
#include "firmware/board/stm32g431/watchdog.hpp"

namespace strainfinger::stm32g431 {
namespace {

using Clock = MicrosecondClock<MemoryBus>;
using Can = FdcanPort<MemoryBus, Clock, sendRule>;
using Adc = GaugeConverter<MemoryBus>;
using Store = FlashStore<MemoryBus>;
using Watchdog = IndependentWatchdog<MemoryBus, Clock>;

/// Of the image; settings that were kept take their place.
constexpr firmware::FingerSettings kSettings{.node = STRAINFINGER_NODE,
                                             .standingFlags = {FingerFlag::kUncalibrated}};
static_assert(kSettings.node >= kFirstNode && kSettings.node <= kLastNode);
static_assert(canTiming(ClockSource::kCrystal, STRAINFINGER_BITRATE), "not a bit rate of can_rates.hpp");
static_assert(samplingAt(STRAINFINGER_SAMPLE_RATE), "not a rate of sampling.hpp");

constexpr MemoryBus kBus;
EccFaults eccFaults;

/// RAM keeps its contents over any reset but that of its supply.
bool ramSurvived() {
  [[gnu::section(".noinit")]] static std::uint32_t mark;
  constexpr std::uint32_t kMark = 0x4B524D53;
  const bool survived = mark == kMark;
  mark = kMark;
  return survived;
}

/// Those that were flashed for this finger if they are whole, else the image's.
const TableImage& tables() {
  const auto& flashed = *reinterpret_cast<const TableImage*>(kTablePages.address());
  const bool whole = checkTableImage(flashed) == TableFault::kNone && eccFaults.count == 0;
  return whole ? flashed : board::kLinkedTables;
}

// Not inlined, these: what they need on the stack would be there for ever.

[[gnu::noinline]] ClockSource startClocks(Clock& clock) {
  const std::optional<ClockSource> source = ClockTree(kBus).start();
  if (!source) board::crash(Crash::kAssertion, 0);
  clock.start();
  return *source;
}

[[gnu::noinline]] Watchdog& startWatchdog(const Clock& clock, const firmware::LastRun& last) {
  const ResetCause flagged = takeResetCause(kBus, ramSurvived());
  static Watchdog watchdog(kBus, clock, last.crash == Crash::kNone ? flagged : firmware::resetCause(last));
  static_cast<void>(watchdog.start());
  return watchdog;
}

/// If the controller doesn't answer there is nobody to tell: the port stays down.
[[gnu::noinline]] Can& startCan(const Clock& clock, ClockSource source, std::uint8_t node) {
  modify(kBus, Rcc::Ahb2Enr::gpioA(1));
  makeAlternate(kBus, kCanRx, kCanFunction, Gpio::kUp);  // an unconnected bus is a silent one
  makeAlternate(kBus, kCanTx, kCanFunction, Gpio::kNone);
  static Can can(kBus, clock);
  const auto listensTo = identifiersFor(node);
  static_cast<void>(can.start({.timing = *canTiming(source, STRAINFINGER_BITRATE), .listensTo = listensTo}));
  return can;
}

[[gnu::noinline]] firmware::FingerSettings keptSettings(Store& store) {
  return firmware::startedWith(kSettings, firmware::SettingsStore(store).load());
}

/// If a converter doesn't answer, the finger says that samples are missing, and the watchdog starves.
[[gnu::noinline]] Adc& startAdc() {
  static Adc adc(kBus);
  static_cast<void>(adc.start(*samplingAt(STRAINFINGER_SAMPLE_RATE)));
  return adc;
}

[[noreturn]] void run() {
  static Clock clock(kBus);
  const firmware::LastRun last = board::takeLastRun();
  const ClockSource source = startClocks(clock);
  Watchdog& watchdog = startWatchdog(clock, last);
  static Store store(kBus, eccFaults, kConfigurationPages.first, kConfigurationPages.count);
  const firmware::FingerSettings settings = keptSettings(store);
  Can& can = startCan(clock, source, settings.node);
  firmware::runFinger(tables(), settings, last, startAdc(), can, clock, watchdog, store, [&] {
    can.poll();
    if (watchdog.isStarved()) board::crash(Crash::kStarved, 0);
  });
}

/// Raised by the flash for a double ECC error, which is the reader's to handle; otherwise by nothing that is
/// known.
extern "C" void nonMaskableHandler() {
  if (!takeEccFault(kBus, eccFaults)) board::crash(Crash::kHardFault, 0);
}

}  // namespace
}  // namespace strainfinger::stm32g431

namespace strainfinger::board {

/// No interrupt is used.
[[gnu::section(".vectors"), gnu::used]] constinit const auto kVectors = [] {
  auto table = vectorTable<0>(stack_top, faultHandler);
  table.nonMaskable = stm32g431::nonMaskableHandler;
  return table;
}();

void runBoard() { stm32g431::run(); }

}  // namespace strainfinger::board
