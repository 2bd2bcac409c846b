// The finger board: what is on it, put together.

#include "firmware/app/run.hpp"
#include "firmware/app/whole_tables.hpp"
#include "firmware/board/cortex_m/crash.hpp"
#include "firmware/board/cortex_m/linked_tables.hpp"
#include "firmware/board/cortex_m/startup.hpp"
#include "firmware/board/cortex_m/system_control.hpp"
#include "firmware/board/stm32g431/can_rates.hpp"
#include "firmware/board/stm32g431/clock_tree.hpp"
#include "firmware/board/stm32g431/fdcan_port.hpp"
#include "firmware/board/stm32g431/flash_layout.hpp"
#include "firmware/board/stm32g431/flash_store.hpp"
#include "firmware/board/stm32g431/flashed_tables.hpp"
#include "firmware/board/stm32g431/gauge_converter.hpp"
#include "firmware/board/stm32g431/microsecond_clock.hpp"
#include "firmware/board/stm32g431/registers/memory_bus.hpp"
#include "firmware/board/stm32g431/send_rules.hpp"
#include "firmware/board/stm32g431/unique_id.hpp"
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
                                             .samplePeriod_us = 1'000'000 / STRAINFINGER_SAMPLE_RATE,
                                             .bitrate = STRAINFINGER_BITRATE,
                                             .standingFlags = {FingerFlag::kUncalibrated},
                                             .takesTables = true};
static_assert(kSettings.node >= kFirstNode && kSettings.node <= kLastNode);
static_assert(canTiming(ClockSource::kCrystal, STRAINFINGER_BITRATE), "not a bit rate of can_rates.hpp");
constexpr bool kCanFd = STRAINFINGER_CAN_FD;
static_assert(samplingAt(STRAINFINGER_SAMPLE_RATE), "not a rate of sampling.hpp");

constexpr MemoryBus kBus;
EccErrors eccErrors;

/// RAM keeps its contents over any reset but that of its supply.
bool ramSurvived() {
  [[gnu::section(".noinit")]] static std::uint32_t mark;
  constexpr std::uint32_t kMark = 0x4B524D53;
  const bool survived = mark == kMark;
  mark = kMark;
  return survived;
}

// Not inlined, these: what they need on the stack would be there for ever.

[[gnu::noinline]] const TableImage* tables() {
  return readableTables(kBus, eccErrors, [] {
    return firmware::ifWhole(
        firmware::tablesOf(*reinterpret_cast<const TableImage*>(kTablePages.address()), board::kLinkedTables),
        kGauges);
  });
}

/// A watchdog that resets leaves no record: what it ended hung, nobody knows where.
[[gnu::noinline]] firmware::LastRun lastRun(ResetCause flagged) {
  const firmware::LastRun recorded = board::takeLastRun();
  return recorded.crash == Crash::kNone && flagged == ResetCause::kWatchdog ? board::noteHang() : recorded;
}

[[gnu::noinline]] ClockSource startClocks(Clock& clock) {
  const std::optional<ClockSource> source = ClockTree(kBus).start();
  if (!source) board::crash(Crash::kAssertion, 0);
  clock.start();
  return *source;
}

[[gnu::noinline]] Watchdog& watchdogAfter(const firmware::LastRun& last, ResetCause flagged,
                                          const Clock& clock) {
  static Watchdog watchdog(kBus, clock, last.crash == Crash::kNone ? flagged : firmware::resetCause(last));
  return watchdog;
}

/// If the controller doesn't answer, or the clock that started is too far off for the bit rate, there is
/// nobody to tell: the port stays down.
[[gnu::noinline]] Can& startCan(const Clock& clock, ClockSource source, std::uint8_t node) {
  connectCan(kBus);
  static Can can(kBus, clock);
  const auto listensTo = identifiersFor(node);
  const std::optional<BitTiming> timing = canTiming(source, STRAINFINGER_BITRATE);
  const std::optional<BitTiming> data = kCanFd ? fdDataTiming(source) : std::nullopt;
  if (timing) static_cast<void>(can.start({.timing = *timing, .dataTiming = data, .listensTo = listensTo}));
  return can;
}

/// `areClocksRight`: the crystal's, and the watchdog's of its own.
[[gnu::noinline]] firmware::FingerSettings settingsWith(Store& store, bool areClocksRight) {
  firmware::FingerSettings settings =
      firmware::startedWith(kSettings, firmware::SettingsStore(store).found());
  settings.standingFaults.set(FingerFault::kClock, !areClocksRight);
  settings.board = shortNumber(uniqueId(kBus));
  return settings;
}

/// If a converter doesn't answer, the finger says that samples are missing, and the watchdog starves.
[[gnu::noinline]] Adc& startAdc() {
  static Adc adc(kBus);
  static_cast<void>(adc.start(*samplingAt(STRAINFINGER_SAMPLE_RATE)));
  return adc;
}

[[noreturn]] void run() {
  static Clock clock(kBus);
  const ResetCause flagged = takeResetCause(kBus, ramSurvived());
  const firmware::LastRun last = lastRun(flagged);
  const ClockSource source = startClocks(clock);
  Watchdog& watchdog = watchdogAfter(last, flagged, clock);
  const bool isWatched = watchdog.start();
  static Store store(kBus, eccErrors, kConfigurationPages.first, kConfigurationPages.count);
  const firmware::FingerSettings settings = settingsWith(store, isWatched && source == ClockSource::kCrystal);
  Can& can = startCan(clock, source, settings.node);
  static Store tableStore(kBus, eccErrors, kTablePages.first, kTablePages.count);
  const auto wait = [&] {
    can.poll();
    noteEccErrors(kBus, eccErrors);
    if (watchdog.isStarved()) board::crash(Crash::kStarved, 0);
  };
  const TableImage* const image = tables();
  Adc& adc = startAdc();  // last: sample sets come from here on
  firmware::runFinger(image, settings, last, adc, can, clock, watchdog, store, tableStore,
                      firmware::BoardActions{wait, [] { board::resetSystem(); }});
}

/// Raised by the flash for words that it cannot read, and, without an address, by the crystal when it stops.
extern "C" void nonMaskableHandler() {
  const std::uint32_t before = eccErrors.unreadable;
  if (survivesNmi(kBus, eccErrors)) return;
  board::crash(Crash::kHardFault, eccErrors.unreadable == before ? 0 : kFlashBegin + eccErrors.lastOffset);
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
