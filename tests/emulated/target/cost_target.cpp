// What an update costs, in instructions, scene by scene (see instruction_counter.hpp for how to run it).
// Writes CSV to UART0: the scene, instructions of one update. Command line (semihosting): how many updates
// the scenes of any kind have together.
#include <algorithm>
#include <cstddef>
#include <optional>

#include "firmware/app/finger.hpp"
#include "firmware/board/cortex_m/linked_tables.hpp"
#include "firmware/board/cortex_m/startup.hpp"
#include "firmware/board/mps2/console.hpp"
#include "firmware/board/mps2/instruction_counter.hpp"
#include "firmware/board/mps2/semihosting.hpp"
#include "tests/emulated/sample_generator.hpp"
#include "tests/emulated/target/test_image.hpp"

extern "C" std::uint32_t stack_bottom[];

namespace strainfinger::board {
namespace {

using namespace emulated;
using mps2::InstructionCounter;

constexpr std::uint32_t kUpdates = 2000;  ///< of a scene
constexpr std::uint32_t kPaint = 0x57ACC57A;

struct Adc {
  hal::SampleSet next{};
  bool read(hal::SampleSet& set) noexcept {
    set = next;
    return true;
  }
  std::uint32_t overruns() const noexcept { return 0; }
  std::uint32_t resynchronisations() const noexcept { return 0; }
};
struct Can {
  bool send(const CanFrame&) noexcept { return true; }
  std::optional<CanFrame> receive() noexcept { return std::nullopt; }
  hal::CanStatus status() const noexcept { return {.state = hal::CanState::kActive}; }
};
struct Clock {
  std::uint32_t time_us = 0;
  std::uint32_t now_us() const noexcept { return time_us; }
};
struct Watchdog {
  void feed() noexcept {}
  hal::ResetCause resetCause() const noexcept { return hal::ResetCause::kPowerOn; }
};

mps2::Console* console;
void tell(const char* what, std::uint32_t instructions) { *console << what << "," << instructions << "\n"; }

/// Noise of the default finger's tables, 6e-6 or 6.55 codes.
void addConfiguredNoise(Deflections& codes, Draws& draws) {
  Deflections noise{};
  addNoise(noise, draws, 0);  // 74 codes
  for (std::size_t gauge = 0; gauge < kGauges; ++gauge) codes[gauge] += noise[gauge] * 91 / 1024;
}

/// What touches the finger, before noise.
Deflections pressed(const GeneratedContact& contact) {
  Deflections codes{};
  press(codes, contact);
  return codes;
}

hal::SampleSet noisy(Deflections codes, std::uint32_t sample) {
  Draws draws(sample);
  addConfiguredNoise(codes, draws);
  return converted(codes, true);
}

constexpr Deflections kUntouched{};

/// 30 N/m, pulled by half as much.
GeneratedContact firmContact(std::uint32_t angle, Width width) {
  return {angle, kPeakCodesAt30_n_per_m, kPeakCodesAt30_n_per_m / 2, width};
}

/// A finger from converter to port, its updates counted. A set a millisecond, and frames as often.
class CountedFinger {
 public:
  CountedFinger(const TableImage& tables, const InstructionCounter& counter)
      : counter_(counter), finger_(tables, {.contactRate_hz = 1000}, adc_, can_, clock_, watchdog_) {
    for (std::uint32_t sample = 0; sample <= firmware::ZeroAverage::kSamples; ++sample)
      update(kUntouched, sample);
  }

  /// With the noise of this sample. Not inlined: the stack that its caller needs is the same in all scenes.
  [[gnu::noinline]] std::uint32_t update(const Deflections& codes, std::uint32_t sample) {
    return update(noisy(codes, sample));
  }

  std::uint32_t update(const hal::SampleSet& set) {
    adc_.next = set;
    clock_.time_us += 1000;
    return counter_.of([&] { finger_.step(); });
  }
  bool isSearching() const { return finger_.lastAnswer().searching; }

 private:
  const InstructionCounter& counter_;
  Adc adc_;
  Can can_;
  Clock clock_;
  Watchdog watchdog_;
  firmware::Finger<Adc, Can, Clock, Watchdog> finger_;
};

/// A new finger that has found its zero. There is room for one.
CountedFinger& newFinger(const TableImage& tables, const InstructionCounter& counter) {
  static std::optional<CountedFinger> finger;
  return finger.emplace(tables, counter);
}

void idle(const InstructionCounter& counter) {
  CountedFinger& finger = newFinger(kLinkedTables, counter);
  for (std::uint32_t sample = 0; sample < kUpdates; ++sample) tell("idle", finger.update(kUntouched, sample));
}

/// Gauges that each drift on their own, too little to be a touch: the dearest set of each interval after
/// which zeros follow, and of what then goes on for a few sets.
void drifting(const InstructionCounter& counter, const TableImage& tables, const char* what) {
  constexpr std::uint32_t kIntervals = 20;
  constexpr std::uint32_t kSets = firmware::ZeroTracker::kUntilFollowed + firmware::ZeroTracker::kEvery;
  CountedFinger& finger = newFinger(tables, counter);
  for (std::uint32_t interval = 0; interval < kIntervals; ++interval) {
    Draws draws(interval);
    Deflections drift{};
    for (std::int32_t& codes : drift) codes = static_cast<std::int32_t>(draws.below(31)) - 15;
    std::uint32_t dearest = 0;
    for (std::uint32_t set = 0; set < kSets; ++set)
      dearest = std::max(dearest, finger.update(drift, interval * kSets + set));
    tell(what, dearest);
  }
}

/// A contact held where it is once it is found: the same codes, and with noise.
void held(const InstructionCounter& counter, Width width, const char* same, const char* withNoise) {
  constexpr std::uint32_t kUntilFound = 100;
  CountedFinger& finger = newFinger(kLinkedTables, counter);
  const Deflections contact = pressed(firmContact(0x12345678, width));
  for (std::uint32_t sample = 0; sample < kUntilFound + 2 * kUpdates; ++sample) {
    const bool unchanged = sample < kUntilFound + kUpdates;
    const std::uint32_t instructions = finger.update(contact, unchanged ? 0 : sample);
    if (sample >= kUntilFound) tell(unchanged ? same : withNoise, instructions);
  }
}

/// A contact that slides by 50 um a set.
void sliding(const InstructionCounter& counter, const TableImage& tables, Width width, const char* what) {
  constexpr std::uint32_t kUntilFound = 100;
  CountedFinger& finger = newFinger(tables, counter);
  for (std::uint32_t sample = 0; sample < kUntilFound + kUpdates; ++sample) {
    const std::uint32_t instructions =
        finger.update(pressed(firmContact(sample * kTurn_q32Of50_um, width)), sample);
    if (sample >= kUntilFound) tell(what, instructions);
  }
}

/// New contacts anywhere, from an eighth of 30 N/m to all of it: the first set of each, and those during
/// which the search for other answers goes on.
void newTouches(const InstructionCounter& counter, const TableImage& tables, const char* first,
                const char* searching) {
  constexpr int kBetween = 3, kMostSets = 64;
  CountedFinger& finger = newFinger(tables, counter);
  for (std::uint32_t touch = 0; touch < kUpdates; ++touch) {
    Draws draws(touch);
    GeneratedContact contact = firmContact(draws.next(), touch % 2 == 0 ? kLine : kTwoMillimetres);
    contact.normal >>= draws.below(4);
    contact.tangential = contact.normal * (static_cast<std::int32_t>(draws.below(101)) - 50) / 100;
    const Deflections codes = pressed(contact);
    tell(first, finger.update(codes, draws.next()));
    for (int i = 0; i < kMostSets && finger.isSearching(); ++i)
      tell(searching, finger.update(codes, draws.next()));
    for (int i = 0; i < kBetween; ++i) finger.update(kUntouched, draws.next());
  }
}

/// Taps on a gauge that reads nothing, which end before the search for other answers: the untouched sets in
/// which it goes on.
void lookingBack(const InstructionCounter& counter, const TableImage& tables, const char* what) {
  constexpr std::uint32_t kTaps = kUpdates / 40, kTapSets = 6, kLooked = 40;
  CountedFinger& finger = newFinger(tables, counter);
  for (std::uint32_t tap = 0; tap < kTaps; ++tap) {
    Draws draws(tap);
    const std::uint32_t angle = draws.next();
    Deflections codes = pressed(firmContact(angle, kTwoMillimetres));
    const auto nearest = static_cast<std::size_t>((std::uint64_t{angle} * kGauges + (1u << 31)) >> 32);
    codes[nearest % kGauges] = 0;
    for (std::uint32_t set = 0; set < kTapSets; ++set) finger.update(codes, draws.next());
    for (std::uint32_t set = 0; set < kLooked; ++set) tell(what, finger.update(kUntouched, draws.next()));
  }
}

/// What a finger may be given besides one contact, held for kTouch sets each.
enum class Kind : std::uint8_t { kFaint, kPair, kDeadGauge, kHum, kAnyCodes, kEveryKind, kCount };
constexpr const char* kKindNames[] = {"any_faint", "any_pair",  "any_dead",
                                      "any_hum",   "any_codes", "any_wild"};

/// Of 50 Hz, alike on all gauges, up to 300 microstrain.
Deflections hum(std::uint32_t sample, Draws& touch) {
  constexpr std::int32_t kSine[20] = {0, 316,  601,  828,  973,  1024,  973,  828,  601,  316,
                                      0, -316, -601, -828, -973, -1024, -973, -828, -601, -316};
  const auto amplitude = static_cast<std::int32_t>(touch.below(330));
  Deflections codes;
  codes.fill(amplitude * kSine[sample % 20] / 1024);
  return codes;
}

hal::SampleSet setOf(Kind kind, std::uint32_t sample) {
  Draws touch(sample / kTouch), draws(sample);
  Deflections codes{};
  switch (kind) {
    case Kind::kFaint: {
      GeneratedContact contact = drawContact(touch, 1u << 10);
      contact.angle += sample % kTouch * kTurn_q32Of50_um;
      press(codes, contact);
      break;
    }
    case Kind::kPair:
      press(codes, drawContact(touch, 1u << 12));
      press(codes, drawContact(touch, 1u << 12));
      break;
    case Kind::kDeadGauge:
      press(codes, firmContact(touch.next() + sample % kTouch * kTurn_q32Of50_um, kTwoMillimetres));
      codes[touch.below(kGauges)] = 0;
      break;
    case Kind::kHum:
      codes = hum(sample, touch);
      if (touch.below(2) == 0) press(codes, firmContact(touch.next(), kLine));
      break;
    case Kind::kAnyCodes:
      return strange(touch.below(2) == 0 ? touch : draws);
    case Kind::kEveryKind:
    case Kind::kCount:
      return wild(draws);
  }
  return noisy(codes, sample);
}

void ofKind(const InstructionCounter& counter, const TableImage& tables, Kind kind, const char* what,
            std::uint32_t updates) {
  CountedFinger& finger = newFinger(tables, counter);
  for (std::uint32_t sample = 0; sample < updates; ++sample) tell(what, finger.update(setOf(kind, sample)));
}

/// The default finger's tables for who says that contacts are lines.
const TableImage& lineTables() {
  static TableImage tables = kLinkedTables;
  tables.constants.width_is_known = 1;
  tables.constants.known_moment_q20 = 0;
  return tables;
}

/// The same of a calibrated finger: every gauge has a depth of its own, which changes nothing but the work.
const TableImage& tablesOfDepths() {
  static TableImage tables = kLinkedTables;
  tables.depths.step_nm = 1;
  tables.depths.steps.fill(1);
  return tables;
}

}  // namespace

void runBoard() {
  std::fill(stack_bottom, static_cast<std::uint32_t*>(__builtin_frame_address(0)) - 64, kPaint);
  mps2::Console line;
  console = &line;
  const InstructionCounter counter;
  const std::uint32_t ofAnyKind = Words().number();
  idle(counter);
  drifting(counter, kLinkedTables, "drift");
  drifting(counter, tablesOfDepths(), "drift_depths");
  held(counter, kLine, "held_line", "held_line_noise");
  held(counter, kTwoMillimetres, "held_wide", "held_wide_noise");
  sliding(counter, lineTables(), kLine, "known_line");
  sliding(counter, kLinkedTables, kTwoMillimetres, "wide");
  sliding(counter, tablesOfDepths(), kTwoMillimetres, "wide_depths");
  newTouches(counter, kLinkedTables, "new", "search");
  newTouches(counter, tablesOfDepths(), "new_depths", "search_depths");
  lookingBack(counter, kLinkedTables, "look_back");
  lookingBack(counter, tablesOfDepths(), "look_back_depths");
  constexpr auto kKinds = static_cast<std::uint32_t>(Kind::kCount);
  for (std::uint32_t kind = 0; kind < kKinds; ++kind)
    ofKind(counter, kLinkedTables, static_cast<Kind>(kind), kKindNames[kind], ofAnyKind / kKinds);
  ofKind(counter, tablesOfDepths(), Kind::kPair, "any_pair_depths", ofAnyKind / kKinds);
  const auto* const touched = std::find_if(stack_bottom, const_cast<std::uint32_t*>(stack_top),
                                           [](std::uint32_t word) { return word != kPaint; });
  tell("stack_bytes", 4 * static_cast<std::uint32_t>(stack_top - touched));
  mps2::endEmulator(0);
}

}  // namespace strainfinger::board
