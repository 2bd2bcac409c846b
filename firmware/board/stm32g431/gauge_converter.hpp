#pragma once
// hal::GaugeAdc on ADC1 and ADC2 together: RM0440 chapters 12, 13, 21, 29 and 30.
//
//   TIM1 --trigger--> ADC1 + ADC2 --pair by pair--> DMA --> two sets in memory, filled in turn
//     \--trigger--> TIM3 counts
//
// No interrupt: what DMA has filled is seen from its flags and its count, and TIM3 tells how many sets there
// were while nobody looked, even while the processor stood still for an erasing flash page.
//
// A word that DMA misses shifts all that follow to other gauges, and one of a pair alone puts the second
// converter's results beside the first's of another gauge. So both converters overwrite (an overrun then
// leaves their pairs together), their overrun flags are looked at with each set, and after one everything
// begins anew with the first gauge.

#include <array>
#include <cstdint>

#include "firmware/board/stm32g431/pinout.hpp"
#include "firmware/board/stm32g431/registers/adc.hpp"
#include "firmware/board/stm32g431/registers/clocks.hpp"
#include "firmware/board/stm32g431/registers/timers.hpp"
#include "firmware/board/stm32g431/sampling.hpp"
#include "hal/gauge_adc.hpp"

namespace strainfinger::stm32g431 {

/// Contract: hal/gauge_adc.hpp. Holds one complete set while the next is converted. read() must come at least
/// every 32,767 sets for overruns() to be right. 12-bit conversions: the upper rail is code 0xFFF0.
///
/// The first set after the converters have stood still is never handed out, and lost but for that of the
/// start: their first conversion may be wrong (errata ES0431, "wrong ADC result if conversion done late after
/// calibration or previous conversion").
template <RegisterBus Bus>
class GaugeConverter {
 public:
  explicit GaugeConverter(Bus bus) : bus_(bus) {}
  GaugeConverter(const GaugeConverter&) = delete;  // DMA knows where it is
  GaugeConverter& operator=(const GaugeConverter&) = delete;

  /// Calibrates and starts; `plan` must be possible. False: a converter doesn't answer, nothing runs.
  [[nodiscard]] bool start(const SamplingPlan& plan) noexcept {
    enableClocks();
    connectPins();
    powerUp();
    if (!calibrate<Adc1>() || !calibrate<Adc2>()) return false;
    waitCycles<Adc1::Isr>(bus_, kAfterCalibration_cycles);
    if (!enable<Adc1>() || !enable<Adc2>()) return false;
    configure<Adc1>(plan, kEvenGauges, kTim1Trgo);
    configure<Adc2>(plan, kOddGauges, kSlave);
    prepareTimers(plan);
    prepareDma();
    run();
    return true;
  }

  bool read(hal::SampleSet& set) noexcept {
    if (get(bus_, Dma1::Isr::halves1) == 0) {
      keepInStep();
      return false;
    }
    write(bus_, Dma1::Ifcr::halves1(Dma1::Ifcr::halves1.max));
    for (int attempt = 0; attempt < 2; ++attempt) {
      const std::uint16_t sets = completed();
      if (sets == taken_) break;
      const auto pairs = copyOf(sets);
      if (completed() != sets) continue;  // DMA may be about to write over it
      if (isOutOfStep(sets)) break;
      return take(sets, pairs, set);
    }
    keepInStep();
    return false;
  }

  std::uint32_t overruns() const noexcept { return overruns_; }

  /// How often the converters had to begin anew, since start. The sets that it cost are among overruns().
  std::uint32_t resynchronisations() const noexcept { return resynchronisations_; }

 private:
  using Pairs = std::array<std::uint32_t, kPairs>;
  static constexpr std::uint32_t kWords = 2 * kPairs;

  static constexpr std::uint32_t kRegulator_cycles = kCore_hz / 1'000'000 * 20;  ///< 20 us, DS12589
  static constexpr std::uint32_t kAfterCalibration_cycles = 4 * (kCore_hz / kAdc_hz);
  static constexpr std::uint32_t kCalibrationPolls =
      10'000;                                           ///< takes 116 of the converter's cycles, 928 of ours
  static constexpr std::uint32_t kReadyPolls = 10'000;  ///< takes about 1 us
  static constexpr std::uint32_t kStopPolls = 10'000;   ///< takes a few of the converter's cycles
  /// A trigger that comes too soon after the start isn't seen: 16 of the converter's cycles are plenty.
  static constexpr std::uint32_t kAfterStart_cycles = 16 * (kCore_hz / kAdc_hz);
  static constexpr std::uint32_t kSlave = 0;  ///< no trigger of its own

  void enableClocks() noexcept {
    enableClock(bus_, Rcc::Ahb1Enr::dma1(1) | Rcc::Ahb1Enr::dmamux(1));
    enableClock(bus_, Rcc::Ahb2Enr::adc12(1) | Rcc::Ahb2Enr::gpioA(1) | Rcc::Ahb2Enr::gpioB(1) |
                          Rcc::Ahb2Enr::gpioC(1));
    enableClock(bus_, Rcc::Apb1Enr1::tim3(1));
    enableClock(bus_, Rcc::Apb2Enr::tim1(1));
  }

  void connectPins() noexcept {
    for (std::uint32_t pair = 0; pair < kPairs; ++pair) {
      makeAnalog(bus_, kEvenGauges[pair].pin);
      makeAnalog(bus_, kOddGauges[pair].pin);
    }
  }

  /// RM0440 sections 21.4.6 and 21.7.3.
  void powerUp() noexcept {
    using Ccr = Adc12::Ccr;
    write(bus_, Adc1::Cr::deepPowerDown(0));
    write(bus_, Adc2::Cr::deepPowerDown(0));
    write(bus_, regulated<Adc1>());
    write(bus_, regulated<Adc2>());
    waitCycles<Adc1::Isr>(bus_, kRegulator_cycles);
    write(bus_, Ccr::dual(Adc12::kRegularSimultaneous) | Ccr::dmaCircular(1) | Ccr::clockMode(0) |
                    Ccr::prescaler(Adc12::kDivideBy8));
  }

  /// Control bits are set by writing 1 and ignore 0: this writes them all with 0 and keeps the regulator on.
  template <typename Converter>
  static constexpr auto regulated() {
    return Converter::Cr::regulatorOn(1);
  }

  template <typename Converter>
  bool calibrate() noexcept {
    write(bus_, regulated<Converter>() | Converter::Cr::calibrate(1));
    return waitFor(bus_, Converter::Cr::calibrate, 0, kCalibrationPolls);
  }

  template <typename Converter>
  bool enable() noexcept {
    write(bus_, Converter::Isr::ready(1));
    write(bus_, regulated<Converter>() | Converter::Cr::enable(1));
    return waitFor(bus_, Converter::Isr::ready, 1, kReadyPolls);
  }

  template <typename Converter>
  void configure(const SamplingPlan& plan, const std::array<Input, kPairs>& inputs,
                 std::uint32_t trigger) noexcept {
    using Cfgr = typename Converter::Cfgr;
    using Cfgr2 = typename Converter::Cfgr2;
    write(bus_, Cfgr::trigger(trigger) | Cfgr::triggerEdge(trigger != kSlave) | Cfgr::overwrite(1) |
                    Cfgr::injectedQueueOff(1));
    write(bus_, Cfgr2::oversample(1) | Cfgr2::ratio(plan.oversamplingLog2 - 1) |
                    Cfgr2::shift(plan.oversamplingLog2 - 4));  // 12 + log2 bits become 16
    const std::uint32_t time =
        static_cast<std::uint32_t>(plan.sampleTime) * 0x0924'9249;  // for every channel
    bus_.write(Converter::Smpr1::address, time);
    bus_.write(Converter::Smpr2::address, time & 0x07FF'FFFF);
    bus_.write(Converter::Sqr1::address, (kPairs - 1) | sequence(inputs, 0, 4, 6));
    bus_.write(Converter::Sqr2::address, sequence(inputs, 4, 4, 0));
  }

  /// Channels of `count` inputs, 6 bits each.
  static constexpr std::uint32_t sequence(const std::array<Input, kPairs>& inputs, std::uint32_t first,
                                          std::uint32_t count, unsigned shift) {
    std::uint32_t bits = 0;
    for (std::uint32_t i = 0; i < count; ++i)
      bits |= static_cast<std::uint32_t>(inputs[first + i].channel) << (shift + 6 * i);
    return bits;
  }

  /// The update loads TIM1's prescaler. It is a trigger, too, but nobody listens yet.
  void prepareTimers(const SamplingPlan& plan) noexcept {
    write(bus_, Tim3::Smcr::slaveMode(kCountInput) | Tim3::Smcr::triggerInput(kItr0));
    bus_.write(Tim3::Arr::address, 0xFFFF);
    bus_.write(Tim1::Psc::address, kCore_hz / 1'000'000 - 1);
    bus_.write(Tim1::Arr::address, plan.period_us() - 1);
    write(bus_, Tim1::Cr2::triggerOutput(kAtUpdate));
    write(bus_, Tim1::Egr::update(1));
  }

  void prepareDma() noexcept {
    write(bus_, Dmamux::C0cr::request(Dmamux::kAdc1));
    bus_.write(Dma1::Cpar1::address, Adc12::Cdr::address);
    bus_.write(Dma1::Cmar1::address, bus_.addressOf(const_cast<std::uint32_t*>(&words_[0])));
  }

  /// From a standstill: memory waits for the first gauge, then the converters for the trigger, then TIM3
  /// counts, and TIM1, which gives the triggers, is last.
  void run() noexcept {
    using Ccr = Dma1::Ccr1;
    write(bus_, Dma1::Cndtr1::left(kWords));
    write(bus_, Ccr::circular(1) | Ccr::incrementMemory(1) | Ccr::peripheralSize(Dma1::kWord) |
                    Ccr::memorySize(Dma1::kWord) | Ccr::priority(Dma1::kHighest) | Ccr::enable(1));
    modify(bus_, Adc12::Ccr::dmaMode(Adc12::kBothInAWord));
    write(bus_, regulated<Adc1>() | Adc1::Cr::start(1));
    waitCycles<Adc1::Isr>(bus_, kAfterStart_cycles);
    write(bus_, Tim3::Cnt::count16(0));
    write(bus_, Tim3::Cr1::enable(1));
    write(bus_, Tim1::Cnt::count16(0));
    write(bus_, Tim1::Cr1::enable(1));
    taken_ = 0;
    isFirst_ = true;
  }

  /// Ends run(). The master's stop is both converters' (RM0440 section 21.7.3), and without a DMA mode no
  /// request of theirs is left to carry an old result to the first gauge's place.
  bool stop() noexcept {
    write(bus_, Tim1::Cr1::enable(0));
    write(bus_, Tim3::Cr1::enable(0));
    write(bus_, regulated<Adc1>() | Adc1::Cr::stop(1));
    if (!waitFor(bus_, Adc1::Cr::start, 0, kStopPolls) || !waitFor(bus_, Adc2::Cr::start, 0, kStopPolls))
      return false;
    modify(bus_, Adc12::Ccr::dmaMode(Adc12::kNoDma));
    write(bus_, Dma1::Ccr1::enable(0));
    static_cast<void>(bus_.read(Adc12::Cdr::address));
    write(bus_, Dma1::Ifcr::halves1(Dma1::Ifcr::halves1.max) | Dma1::Ifcr::error1(1));
    write(bus_, Adc1::Isr::overrun(1));
    write(bus_, Adc2::Isr::overrun(1));
    return true;
  }

  /// Words may lie in other gauges' places: a converter's result was not carried away in time, DMA has
  /// given up, or there are fewer sets than were taken.
  bool isOutOfStep(std::uint16_t sets) const noexcept {
    return get(bus_, Adc1::Isr::overrun) != 0 || get(bus_, Adc2::Isr::overrun) != 0 ||
           get(bus_, Dma1::Isr::error1) != 0 || static_cast<std::int16_t>(sets - taken_) < 0;
  }

  /// Begins anew if that is needed, and counts what it costs: all sets begun and not taken.
  void keepInStep() noexcept {
    if (!isOutOfStep(completed()) || !stop()) return;
    overruns_ += static_cast<std::uint16_t>(get(bus_, Tim3::Cnt::count16) - taken_);
    ++resynchronisations_;
    run();
  }

  bool take(std::uint16_t sets, const Pairs& pairs, hal::SampleSet& set) noexcept {
    overruns_ += static_cast<std::uint16_t>(sets - taken_ - 1);
    taken_ = sets;
    if (isFirst_) {
      isFirst_ = false;
      if (resynchronisations_ != 0) ++overruns_;  // at the start nothing is lost
      return false;
    }
    unpack(pairs, set);
    return true;
  }

  /// Half of the memory that DMA is writing: 0, 1, 0, 1 .. set by set.
  std::uint32_t halfInWork() const noexcept { return (kWords - get(bus_, Dma1::Cndtr1::left)) / kPairs & 1; }

  /// Sets converted since start, modulo 2^16: as many as there were triggers, less the one in work. That one
  /// is in work shows in the half.
  std::uint16_t completed() const noexcept {
    std::uint32_t triggers = 0;
    std::uint32_t half = halfInWork();
    for (std::uint32_t before = half ^ 1; before != half;) {
      before = half;
      triggers = get(bus_, Tim3::Cnt::count16);
      half = halfInWork();
    }
    return static_cast<std::uint16_t>(triggers - ((triggers ^ half) & 1));
  }

  /// The newest of `sets` sets: the even ones are in the upper half, counted from 1.
  Pairs copyOf(std::uint16_t sets) const noexcept {
    const std::uint32_t from = (sets & 1) != 0 ? 0 : kPairs;
    Pairs pairs;
    for (std::uint32_t pair = 0; pair < kPairs; ++pair) pairs[pair] = words_[from + pair];
    return pairs;
  }

  static void unpack(const Pairs& pairs, hal::SampleSet& set) noexcept {
    for (std::uint32_t pair = 0; pair < kPairs; ++pair) {
      set[2 * pair] = static_cast<std::uint16_t>(pairs[pair]);
      set[2 * pair + 1] = static_cast<std::uint16_t>(pairs[pair] >> 16);
    }
  }

  [[no_unique_address]] Bus bus_;
  volatile std::uint32_t words_[kWords] = {};  ///< written by DMA
  std::uint16_t taken_ = 0;                    ///< completed() when a set was handed out last
  std::uint32_t overruns_ = 0;
  std::uint32_t resynchronisations_ = 0;
  bool isFirst_ = true;  ///< the next set is the first since the converters stood still
};

}  // namespace strainfinger::stm32g431
