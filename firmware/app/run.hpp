#pragma once
// A board's main(): the same on every board.

#include "firmware/app/announce.hpp"
#include "firmware/app/finger.hpp"

namespace strainfinger::firmware {

/// The version of this build, from the project's CMakeLists.txt.
inline constexpr Version kFirmwareVersion{STRAINFINGER_VERSION_MAJOR, STRAINFINGER_VERSION_MINOR};

/// Says that there are no tables, for ever. Not inlined: what it needs would be on the stack of every other
/// run.
template <hal::GaugeAdc Adc, hal::CanPort Can, hal::Clock Clock, hal::Watchdog Watchdog, typename Wait>
[[noreturn, gnu::noinline]] void runWithoutTables(std::uint8_t node, Announcement<InfoFrame>& info, Adc& adc,
                                                  Can& can, const Clock& clock, Watchdog& watchdog,
                                                  Wait wait) {
  Announcement<HeartbeatFrame> heartbeat(withoutTables(), node, clock.now_us());
  hal::SampleSet unused{};
  for (;;) {
    if (adc.read(unused)) watchdog.feed();
    static_cast<void>(can.receive());  // a port may stand still while a frame waits
    heartbeat.step(can, clock.now_us());
    info.step(can, clock.now_us());
    wait();
  }
}

/// Runs the finger on these tables, which are whole, for ever. Without tables (nullptr) it says so in its
/// heartbeats and does nothing else. `wait` is called when there is nothing to do: it may sleep until
/// the next interrupt.
template <hal::GaugeAdc Adc, hal::CanPort Can, hal::Clock Clock, hal::Watchdog Watchdog,
          hal::NonVolatile Store, typename Wait>
[[noreturn]] void runFinger(const TableImage* tables, const FingerSettings& settings, const LastRun& last,
                            Adc& adc, Can& can, const Clock& clock, Watchdog& watchdog, Store& store,
                            Wait wait) {
  static Announcement<InfoFrame> info(
      infoFrame(watchdog.resetCause(), last, kFirmwareVersion, settings.board), settings.node,
      clock.now_us());
  if (tables == nullptr) runWithoutTables(settings.node, info, adc, can, clock, watchdog, wait);
  static Finger finger(*tables, settings, adc, can, clock, watchdog, store);
  for (;;) {
    if (!finger.step()) wait();
    info.step(can, clock.now_us());
  }
}

}  // namespace strainfinger::firmware
