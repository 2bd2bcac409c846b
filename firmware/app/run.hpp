#pragma once
// A board's main(): the same on every board.

#include "common/table_image.hpp"
#include "firmware/app/finger.hpp"

namespace strainfinger::firmware {

/// Refuses tables that are not whole; else runs the finger on them, for ever. `wait` is called when there is
/// nothing to do: it may sleep until the next interrupt.
template <typename Adc, typename Can, typename Clock, typename Watchdog, typename Wait>
[[noreturn]] void runFinger(const TableImage& tables, const FingerSettings& settings, Adc& adc, Can& can,
                            const Clock& clock, Watchdog& watchdog, Wait wait) {
  static Finger finger(tables, settings, adc, can, clock, watchdog);
  for (;;) {
    if (!finger.step()) wait();
  }
}

}  // namespace strainfinger::firmware
