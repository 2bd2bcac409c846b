#include "firmware/app/run.hpp"
#include "firmware/board/cortex_m/linked_tables.hpp"
#include "firmware/board/cortex_m/startup.hpp"

namespace strainfinger::board {
namespace {

struct NoAdc {
  bool read(hal::SampleSet& set) noexcept {
    set[0] = 1;
    return true;
  }
  std::uint32_t overruns() const noexcept { return 0; }
};
struct NoCan {
  bool send(const CanFrame&) noexcept { return true; }
  std::optional<CanFrame> receive() noexcept { return std::nullopt; }
  hal::CanStatus status() const noexcept { return {}; }
};
struct NoClock {
  std::uint32_t now_us() const noexcept { return 0; }
};
struct NoWatchdog {
  void feed() noexcept {}
  hal::ResetCause resetCause() const noexcept { return {}; }
};
NoAdc adc;
NoCan can;
NoClock clock_;
NoWatchdog dog;

}  // namespace

extern "C" void spin() {
  for (;;) {
  }
}

[[gnu::section(".vectors"), gnu::used]] constinit const auto kVectors = vectorTable<16>(stack_top, spin);

void runBoard() {
  firmware::runFinger(kLinkedTables, {}, adc, can, clock_, dog, [] {});
}

}  // namespace strainfinger::board
