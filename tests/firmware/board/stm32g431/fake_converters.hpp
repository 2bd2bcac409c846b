#pragma once
// ADC1, ADC2, DMA1's channel 1 and the timers that pace them, as registers.

#include <array>

#include "firmware/board/stm32g431/gauge_converter.hpp"
#include "tests/firmware/board/stm32g431/fake_registers.hpp"

namespace strainfinger::doubles {

/// Does what RM0440 chapters 12, 13, 21, 29 and 30 say of them as far as the driver relies on it. Codes come
/// from `voltages`: what each channel of each converter sees.
class FakeConverters {
 public:
  FakeRegisters registers;
  std::array<std::array<std::uint16_t, 19>, 2> voltages{};  ///< 12-bit codes by converter and channel
  bool calibrates = true;
  bool getsReady = true;
  int violations = 0;  ///< what the manual forbids

  FakeConverters() {
    addRegisters();
    behave<stm32g431::Adc1>(0);
    behave<stm32g431::Adc2>(1);
    registers.onWrite<Dma1::Ifcr>([this](std::uint32_t, std::uint32_t ones) {
      registers.word<Dma1::Isr>() &= ~ones;
      return 0;
    });
    registers.onWrite<stm32g431::Tim1::Egr>([this](std::uint32_t, std::uint32_t) {
      trigger();
      return 0;
    });
  }

  bool isRunning() { return registers.field(stm32g431::Adc1::Cr::start) != 0; }

  /// TIM1's update: counted, and the converters begin a set if they run.
  void trigger() {
    if (registers.field(stm32g431::Tim1::Cr2::triggerOutput) != 2) return;
    if (registers.field(stm32g431::Tim3::Cr1::enable) != 0) {
      std::uint32_t& count = registers.word<stm32g431::Tim3::Cnt>();
      count = (count + 1) & registers.word<stm32g431::Tim3::Arr>();
    }
    if (isRunning()) ++begun_;
  }

  /// So many conversions of the set in work end and go to memory.
  void convert(std::uint32_t pairs) {
    for (; pairs > 0 && begun_ > 0; --pairs) transfer();
  }

  /// One more conversion period: the set that was begun ends, the next trigger comes.
  void finishSet() {
    convert(stm32g431::kPairs - done_);
    trigger();
  }

 private:
  using Dma1 = stm32g431::Dma1;

  void addRegisters() {
    registers.add<stm32g431::Rcc::Ahb1Enr>();
    registers.add<stm32g431::Rcc::Ahb2Enr>();
    registers.add<stm32g431::Rcc::Apb1Enr1>();
    registers.add<stm32g431::Rcc::Apb2Enr>();
    for (const std::uint32_t port : {0x4800'0000U, 0x4800'0400U, 0x4800'0800U})
      registers.addRange(port, 0x28, 0x5555'5555);
    registers.add<stm32g431::Adc12::Ccr>();
    registers.add<stm32g431::Dmamux::C0cr>();
    registers.add<Dma1::Isr>();
    registers.add<Dma1::Ifcr>();
    registers.add<Dma1::Ccr1>();
    registers.add<Dma1::Cndtr1>();
    registers.add<Dma1::Cpar1>();
    registers.add<Dma1::Cmar1>();
    addTimer<stm32g431::Tim1>();
    addTimer<stm32g431::Tim3>();
  }

  template <typename T>
  void addTimer() {
    registers.add<typename T::Cr1>();
    registers.add<typename T::Cr2>();
    registers.add<typename T::Smcr>();
    registers.add<typename T::Egr>();
    registers.add<typename T::Cnt>();
    registers.add<typename T::Psc>();
    registers.add<typename T::Arr>(0xFFFF);
  }

  template <typename Adc>
  void behave(std::size_t which) {
    using Cr = typename Adc::Cr;
    registers.add<typename Adc::Isr>();
    registers.add<Cr>(Cr::deepPowerDown(1).value);
    registers.add<typename Adc::Cfgr>();
    registers.add<typename Adc::Cfgr2>();
    registers.add<typename Adc::Smpr1>();
    registers.add<typename Adc::Smpr2>();
    registers.add<typename Adc::Sqr1>();
    registers.add<typename Adc::Sqr2>();
    registers.onWrite<typename Adc::Isr>(
        [](std::uint32_t before, std::uint32_t ones) { return before & ~ones; });
    registers.onWrite<Cr>([this, which](std::uint32_t before, std::uint32_t written) {
      return control<Adc>(which, before, written);
    });
    registers.onRead<Cr>(
        [this](std::uint32_t word) { return calibrates ? word & ~Cr::calibrate.mask : word; });
  }

  /// Bits that start something are set by 1 and not changed by 0. Checks the delays and orders of
  /// section 21.4.
  template <typename Adc>
  std::uint32_t control(std::size_t which, std::uint32_t before, std::uint32_t written) {
    using Cr = typename Adc::Cr;
    Converter& converter = converters_[which];
    if (Cr::regulatorOn.in(written) != 0 && Cr::deepPowerDown.in(before) != 0) ++violations;
    if (Cr::regulatorOn.in(written) != 0 && Cr::regulatorOn.in(before) == 0)
      converter.poweredAt = registers.accesses;
    if (Cr::calibrate.in(written) != 0) {
      if (Cr::enable.in(before) != 0 || registers.accesses - converter.poweredAt < kRegulatorCycles)
        ++violations;
      converter.calibratedAt = registers.accesses;
    }
    if (Cr::enable.in(written) != 0 && Cr::enable.in(before) == 0) {
      if (converter.calibratedAt == 0 || registers.accesses - converter.calibratedAt < 32) ++violations;
      if (getsReady) registers.setField(Adc::Isr::ready, 1);
    }
    if (Cr::start.in(written) != 0 && registers.field(Adc::Isr::ready) == 0) ++violations;
    const std::uint32_t setters = Cr::enable.mask | Cr::start.mask | Cr::calibrate.mask;
    return written | (before & setters);
  }

  /// What DMA carries: both results, oversampled; then flags and its count.
  void transfer() {
    auto* memory = static_cast<std::uint32_t*>(registers.memory);
    std::uint32_t& left = registers.word<Dma1::Cndtr1>();
    memory[kWords - left] = codeOf<stm32g431::Adc1>(0, done_) | codeOf<stm32g431::Adc2>(1, done_) << 16;
    left = left == 1 ? kWords : left - 1;
    if (++done_ < stm32g431::kPairs) return;
    done_ = 0;
    --begun_;
    registers.word<Dma1::Isr>() |= left == kWords ? 1U << 1 : 1U << 2;  // TCIF1, HTIF1
  }

  template <typename Adc>
  std::uint32_t codeOf(std::size_t which, std::uint32_t index) {
    const std::uint32_t bits = index < 4 ? registers.word<typename Adc::Sqr1>() >> (6 + 6 * index)
                                         : registers.word<typename Adc::Sqr2>() >> (6 * (index - 4));
    const std::uint32_t ratio = 2U << registers.field(Adc::Cfgr2::ratio);
    return voltages[which].at(bits & 0x1F) * ratio >> registers.field(Adc::Cfgr2::shift);
  }

  struct Converter {
    std::uint32_t poweredAt = 0;
    std::uint32_t calibratedAt = 0;
  };
  static constexpr std::uint32_t kWords = 2 * stm32g431::kPairs;
  static constexpr std::uint32_t kRegulatorCycles =
      3400;  ///< 20 us at 170 MHz, an access is a cycle at least

  std::array<Converter, 2> converters_{};
  std::uint32_t begun_ = 0;  ///< sets triggered and not finished
  std::uint32_t done_ = 0;   ///< pairs of the set in work
};

}  // namespace strainfinger::doubles
