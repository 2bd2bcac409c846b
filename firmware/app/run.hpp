#pragma once
// A board's main(): the same on every board.

#include "firmware/app/announce.hpp"
#include "firmware/app/finger.hpp"
#include "firmware/app/without_tables.hpp"

namespace strainfinger::firmware {

/// The version of this build, from the project's CMakeLists.txt.
inline constexpr Version kFirmwareVersion{STRAINFINGER_VERSION_MAJOR, STRAINFINGER_VERSION_MINOR};

/// What a board does besides.
/// `wait()` is called when there is nothing to do: it may sleep until the next interrupt. `restart()` resets
/// the board.
template <typename Wait, typename Restart>
struct BoardActions {
  Wait wait;
  Restart restart;
};

/// Not at once: the answer to who asked for it is still on its way.
template <hal::GaugeAdc Adc, hal::Clock Clock, typename Actions>
[[noreturn]] void restartSoon(Adc& adc, const Clock& clock, Actions& board) {
  constexpr std::uint32_t kAfter_us = 50'000;
  hal::SampleSet unused;
  const std::uint32_t asked_us = clock.now_us();
  while (clock.now_us() - asked_us < kAfter_us)
    if (!adc.read(unused)) board.wait();
  for (;;) board.restart();
}

/// Says that there are no tables, and takes some, until it is told to start anew. Not inlined: what it needs
/// would be on the stack of every other run.
template <hal::GaugeAdc Adc, hal::CanPort Can, hal::Clock Clock, hal::Watchdog Watchdog,
          hal::NonVolatile TableStore, typename Actions>
[[noreturn, gnu::noinline]] void runWithoutTables(const NoTables& from, Announcement<InfoFrame>& info,
                                                  Adc& adc, Can& can, const Clock& clock, Watchdog& watchdog,
                                                  TableStore& store, Actions& board) {
  WithoutTables finger(from, can, store, clock.now_us());
  hal::SampleSet unused{};
  while (!finger.isLeaving()) {
    if (adc.read(unused)) watchdog.feed();
    finger.step(clock.now_us());
    info.step(can, clock.now_us());
    board.wait();
  }
  restartSoon(adc, clock, board);
}

/// Runs the finger on these tables, which are whole, until it is told to start anew. Without tables
/// (nullptr), or when it is told to take others, it does so. The stores: for settings, and for tables, from
/// their first byte on.
template <hal::GaugeAdc Adc, hal::CanPort Can, hal::Clock Clock, hal::Watchdog Watchdog,
          hal::NonVolatile Store, hal::NonVolatile TableStore, typename Actions>
[[noreturn]] void runFinger(const TableImage* tables, const FingerSettings& settings, const LastRun& last,
                            Adc& adc, Can& can, const Clock& clock, Watchdog& watchdog, Store& store,
                            TableStore& tableStore, Actions board) {
  static Announcement<InfoFrame> info(
      infoFrame(watchdog.resetCause(), last, kFirmwareVersion, settings.board), settings.node,
      clock.now_us());
  if (tables != nullptr) {
    static Finger finger(*tables, settings, adc, can, clock, watchdog, store);
    while (finger.leaving() == Leaving::kStays) {
      if (!finger.step()) board.wait();
      info.step(can, clock.now_us());
    }
    if (finger.leaving() == Leaving::kRestarts) restartSoon(adc, clock, board);
    runWithoutTables({settings.node, true, finger.eraseBudget(), finger.uptime_s()}, info, adc, can, clock,
                     watchdog, tableStore, board);
  }
  runWithoutTables({settings.node, false, EraseBudget::after(watchdog.resetCause()), 0}, info, adc, can,
                   clock, watchdog, tableStore, board);
}

}  // namespace strainfinger::firmware
