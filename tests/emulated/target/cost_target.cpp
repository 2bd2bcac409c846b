// What a sample set costs, in instructions, stage by stage (see instruction_counter.hpp for how to run it).
// Writes CSV to UART0: what was measured, instructions.
#include <algorithm>
#include <cstddef>
#include <new>

#include "firmware/app/finger.hpp"
#include "firmware/board/cortex_m/linked_tables.hpp"
#include "firmware/board/cortex_m/startup.hpp"
#include "firmware/board/mps2/console.hpp"
#include "firmware/board/mps2/instruction_counter.hpp"
#include "firmware/board/mps2/semihosting.hpp"
#include "tests/emulated/replay.hpp"
#include "tests/emulated/target/test_image.hpp"

extern "C" std::uint32_t stack_bottom[];

namespace strainfinger::board {
namespace {

using namespace emulated;
using mps2::InstructionCounter;

constexpr std::uint32_t kSamples = 2000;
constexpr std::uint32_t kFirmSamples = 40'000;  ///< of which the worst is a bar
constexpr std::uint32_t kPaint = 0x57ACC57A;

struct Adc {
  hal::SampleSet next{};
  bool read(hal::SampleSet& set) noexcept {
    set = next;
    return true;
  }
  std::uint32_t overruns() const noexcept { return 0; }
};
struct Can {
  std::uint32_t sent = 0;
  bool send(const CanFrame&) noexcept {
    ++sent;
    return true;
  }
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

/// A contact of 1/64 to all of the converter's range, or none; noise of about the default finger's.
hal::SampleSet samplesOf(std::uint32_t sample, bool touched) {
  Draws draws(sample);
  Deflections codes{};
  if (touched) {
    const std::uint32_t angle = draws.next();
    const auto normal = static_cast<std::int32_t>(((1u << 14) + draws.below(1u << 14)) >> draws.below(7));
    press(codes, {angle, normal, normal * (static_cast<std::int32_t>(draws.below(201)) - 100) / 100});
  }
  addNoise(codes, draws, 3);
  return converted(codes, false);
}

/// A firm contact: the noise is that of the default finger's tables, 6e-6 or 6.55 codes, and 0.1 % of the
/// contact's peak; load directions are within +-45 degrees.
hal::SampleSet firmSamplesOf(std::uint32_t sample) {
  Draws draws(sample);
  Deflections codes{}, noise{};
  constexpr std::int32_t kNormal = 6550;
  press(codes, {draws.next(), kNormal, kNormal * (static_cast<std::int32_t>(draws.below(201)) - 100) / 100});
  addNoise(noise, draws, 0);  // 74 codes
  for (std::size_t gauge = 0; gauge < kGauges; ++gauge) codes[gauge] += noise[gauge] * 91 / 1024;
  return converted(codes, true);
}

/// A fit, made where it stays, as in Pipeline::look().
const firmware::Fit& located(const InstructionCounter& counter, firmware::FitMode mode,
                             std::span<const std::int32_t> strains, std::uint32_t energy, const char* what) {
  alignas(firmware::Fit) static std::byte place[sizeof(firmware::Fit)];
  const firmware::Fit* fit = nullptr;
  tell(what,
       counter.of([&] { fit = new (place) firmware::Fit(locate(kLinkedTables, mode, strains, energy)); }));
  return *fit;
}

/// The stages one by one, as Pipeline::process() and TouchReporter::frames() run them.
void stages(const InstructionCounter& counter, const hal::SampleSet& set, const char* refined,
            const char* threePoint) {
  const TableConstants& constants = kLinkedTables.constants;
  static const firmware::Calibration calibration = firmware::nominalCalibration(constants);
  firmware::Readings readings;
  firmware::ContactGate gate;
  std::uint32_t energy = 0;
  tell("condition",
       counter.of([&] { condition(calibration, firmware::Codes(set).first(kGauges), readings); }));
  const auto strains = readings.strains(kGauges);
  tell("gate", counter.of([&] {
    energy = firmware::gateEnergy(constants, strains);
    gate.update(constants, energy);
  }));
  if (!gate.touched()) return;
  located(counter, firmware::FitMode::kThreePoint, strains, energy, threePoint);
  const firmware::Fit& fit = located(counter, firmware::FitMode::kRefined, strains, energy, refined);
  CanFrame contactFrame, forceFrame, patchFrame;
  tell("report", counter.of([&] {
    const auto frames =
        firmware::touchFrames(constants, estimate(constants, fit), std::nullopt, {FingerFlag::kContact}, 1);
    contactFrame = encode(frames.contact, kFirstNode);
    forceFrame = encode(frames.force, kFirstNode);
    patchFrame = encode(frames.patch, kFirstNode);
  }));
}

/// Sample sets through the whole finger, from converter to port. Of every 64, 32 are touched.
[[gnu::noinline]] void updates(const InstructionCounter& counter) {
  static Adc adc;
  static Can can;
  static Clock clock;
  static Watchdog watchdog;
  static firmware::Finger finger(kLinkedTables, {.contactRate_hz = 1000}, adc, can, clock, watchdog);
  for (std::uint32_t sample = 0; sample < kSamples + firmware::ZeroAverage::kSamples; ++sample) {
    const bool zeroing = sample < firmware::ZeroAverage::kSamples;
    const bool touched = !zeroing && sample % 64 < 32;
    adc.next = samplesOf(sample, touched);
    const bool beats = clock.time_us % 100'000 == 0;
    clock.time_us += 1000;
    const std::uint32_t before = can.sent;
    const std::uint32_t instructions = counter.of([&] { finger.step(); });
    const std::uint32_t sent = can.sent - before;
    if (zeroing || beats) continue;
    if (touched && sent == 2) tell("update_sent", instructions);
    if (!touched && sent == 0) tell("update_idle", instructions);
  }
}

}  // namespace

void runBoard() {
  std::fill(stack_bottom, static_cast<std::uint32_t*>(__builtin_frame_address(0)) - 64, kPaint);
  mps2::Console line;
  console = &line;
  const InstructionCounter counter;
  for (std::uint32_t sample = 0; sample < kFirmSamples; ++sample)
    stages(counter, firmSamplesOf(sample), "locate", "locate_three_point");
  for (std::uint32_t sample = 0; sample < kSamples; ++sample)
    stages(counter, samplesOf(sample, true), "locate_any", "locate_three_point_any");
  updates(counter);
  const auto* const touched = std::find_if(stack_bottom, const_cast<std::uint32_t*>(stack_top),
                                           [](std::uint32_t word) { return word != kPaint; });
  tell("stack_bytes", 4 * static_cast<std::uint32_t>(stack_top - touched));
  mps2::endEmulator(0);
}

}  // namespace strainfinger::board
