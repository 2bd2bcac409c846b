#pragma once
// ADC1, ADC2, DMA1's channel 1 with its multiplexer, and the timers that pace them, as registers.

#include <array>

#include "firmware/board/stm32g431/gauge_converter.hpp"
#include "tests/firmware/board/stm32g431/fake_registers.hpp"

namespace strainfinger::doubles {

/// Does what RM0440 chapters 12, 13, 21, 29 and 30 say of them, and nothing unless it is enabled, selected
/// and clocked. What the manual forbids fails the test. Codes come from `voltages`: what each channel of each
/// converter sees.
class FakeConverters {
 public:
  FakeRegisters registers;
  std::array<std::array<std::uint16_t, 19>, 2> voltages{};  ///< 12-bit codes by converter and channel
  bool calibrates = true;
  bool getsReady = true;
  bool stops = true;

  FakeConverters() {
    addPins();
    addConverter<stm32g431::Adc1>(0);
    addConverter<stm32g431::Adc2>(1);
    addCommon();
    addDma();
    addTimer<stm32g431::Tim1>();
    addTimer<stm32g431::Tim3>();
    registers.onWrite<stm32g431::Tim1::Egr>([this](std::uint32_t, std::uint32_t written) {
      if (written & st::TIM_EGR_UG) update();
      return 0;
    });
  }

  /// All that a set needs is on.
  bool isRunning() { return isStarted() && isPaced(); }

  /// TIM1 from one update to the next. [cycles]
  std::uint32_t period_cycles() { return (prescaler_ + 1) * (registers.word<stm32g431::Tim1::Arr>() + 1); }

  /// From a trigger to the last result, by the formula of section 21.4.16. [half cycles of the converters'
  /// clock]
  std::uint32_t busy_halfCycles() {
    static constexpr std::array kSample_halfCycles{5, 13, 25, 49, 95, 185, 495, 1281};
    std::uint32_t sum = 0;
    for (std::uint32_t index = 0; index < length<stm32g431::Adc1>(); ++index)
      sum +=
          static_cast<std::uint32_t>(kSample_halfCycles.at(sampleTime(channel<stm32g431::Adc1>(index))) + 25);
    return sum * ratio<stm32g431::Adc1>();
  }

  /// TIM1's period ends.
  void trigger() {
    if (isPaced()) update();
  }

  /// So many conversions of the set in work end and go to memory.
  void convert(std::uint32_t pairs) {
    for (; pairs > 0 && isBusy_; --pairs) endConversion();
  }

  /// One more conversion period: the set that was begun ends, the next trigger comes.
  void finishSet() {
    convert(stm32g431::kPairs);
    trigger();
  }

  /// DMA comes too late for the next pair's result of one converter.
  void loseNextOf(std::size_t converter) { loses_ = converter; }
  /// DMA meets a bus error.
  void failTransfer() {
    registers.word<Dma1::Isr>() |= st::DMA_ISR_TEIF1;
    registers.word<Dma1::Ccr1>() &= ~st::DMA_CCR_EN;
  }
  /// A trigger that the converters don't see.
  void missTrigger() {
    isDeaf_ = true;
    trigger();
    isDeaf_ = false;
  }

 private:
  using Dma1 = stm32g431::Dma1;
  using Ccr = stm32g431::Adc12::Ccr;
  static constexpr std::uint32_t kRegulatorCycles =
      3400;  ///< 20 us of 170 MHz; an access is a cycle at least
  static constexpr std::uint32_t kCyclesAfterCalibration = 4 * 8;
  static constexpr std::uint32_t kDeafCycles = 16;  ///< after ADSTART
  static constexpr std::uint32_t kNoMemory = 0xBAD0'0BAD;
  static constexpr std::size_t kNone = 2;

  struct Converter {
    std::uint32_t poweredAt = 0;
    std::uint32_t calibratedAt = 0;
    bool isCalibrated = false;
    std::uint32_t lag = 0;  ///< results that it holds back, since an overrun without OVRMOD
  };

  void addPins() {
    for (const std::uint32_t port : {st::GPIOA_BASE, st::GPIOB_BASE, st::GPIOC_BASE})
      registers.addRange(port, 0x28, 0x5555'5555);
  }

  void addCommon() {
    registers.add<Ccr>();
    registers.add<stm32g431::Adc12::Cdr>();
    registers.onWrite<Ccr>([this](std::uint32_t before, std::uint32_t written) {
      const std::uint32_t changed = before ^ written;
      const std::uint32_t whileStopped = st::ADC_CCR_MDMA | st::ADC_CCR_DMACFG;
      if (changed & whileStopped)
        FakeRegisters::require(!isStarted(), "written while converting", Ccr::address);
      if (changed & ~whileStopped)
        FakeRegisters::require(!isEnabled<stm32g431::Adc1>() && !isEnabled<stm32g431::Adc2>(),
                               "written while a converter is enabled", Ccr::address);
      return written;
    });
  }

  void addDma() {
    registers.add<stm32g431::Dmamux::C0cr>();
    registers.add<Dma1::Isr>();
    registers.add<Dma1::Ifcr>();
    registers.onWrite<Dma1::Ifcr>([this](std::uint32_t, std::uint32_t ones) {
      registers.word<Dma1::Isr>() &= ~ones;
      return 0;
    });
    addFrozenWhileEnabled<Dma1::Ccr1>(st::DMA_CCR_EN);
    addFrozenWhileEnabled<Dma1::Cndtr1>();
    addFrozenWhileEnabled<Dma1::Cpar1>();
    addFrozenWhileEnabled<Dma1::Cmar1>();
  }

  /// But for the bits `free`.
  template <typename Reg>
  void addFrozenWhileEnabled(std::uint32_t free = 0) {
    registers.add<Reg>();
    registers.onWrite<Reg>([this, free](std::uint32_t before, std::uint32_t written) {
      const bool isDisabled = (written & free) == 0 && free != 0;
      if (((before ^ written) & ~free) != 0 && !isDisabled)
        FakeRegisters::require((registers.word<Dma1::Ccr1>() & st::DMA_CCR_EN) == 0,
                               "written while DMA is enabled", Reg::address);
      if (std::is_same_v<Reg, Dma1::Cndtr1>) reload_ = written;
      return written;
    });
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
    registers.onWrite<typename T::Smcr>([this](std::uint32_t, std::uint32_t written) {
      FakeRegisters::require((registers.word<typename T::Cr1>() & st::TIM_CR1_CEN) == 0,
                             "input selected while the timer counts", T::Smcr::address);
      return written;
    });
  }

  template <typename Adc>
  void addConverter(std::size_t which) {
    using Cr = typename Adc::Cr;
    registers.add<typename Adc::Isr>();
    registers.add<Cr>(st::ADC_CR_DEEPPWD);
    addFrozenWhileStarted<typename Adc::Cfgr>();
    addFrozenWhileStarted<typename Adc::Cfgr2>();
    addFrozenWhileStarted<typename Adc::Smpr1>();
    addFrozenWhileStarted<typename Adc::Smpr2>();
    addFrozenWhileStarted<typename Adc::Sqr1>();
    addFrozenWhileStarted<typename Adc::Sqr2>();
    registers.onWrite<typename Adc::Isr>(
        [](std::uint32_t before, std::uint32_t ones) { return before & ~ones; });
    registers.onWrite<Cr>([this, which](std::uint32_t before, std::uint32_t written) {
      return control<Adc>(which, before, written);
    });
    registers.onRead<Cr>([this, which](std::uint32_t word) { return settle<Adc>(which, word); });
  }

  template <typename Reg>
  void addFrozenWhileStarted() {
    registers.add<Reg>();
    registers.onWrite<Reg>([this](std::uint32_t, std::uint32_t written) {
      FakeRegisters::require(!isStarted(), "written while converting", Reg::address);
      return written;
    });
  }

  /// Bits that start something are set by 1 and not changed by 0. Sections 21.4.6 to 21.4.10 and 21.7.3.
  template <typename Adc>
  std::uint32_t control(std::size_t which, std::uint32_t before, std::uint32_t written) {
    const auto require = [](bool isAllowed, const char* what) {
      FakeRegisters::require(isAllowed, what, Adc::Cr::address);
    };
    Converter& converter = converters_[which];
    const std::uint32_t kSetters = st::ADC_CR_ADEN | st::ADC_CR_ADSTART | st::ADC_CR_ADSTP | st::ADC_CR_ADCAL;
    const std::uint32_t rising = written & ~before;
    const bool isPowered = (before & st::ADC_CR_ADVREGEN) != 0 && (before & st::ADC_CR_DEEPPWD) == 0;
    if (before & st::ADC_CR_ADEN)
      require((written & st::ADC_CR_ADVREGEN) != 0, "regulator switched off while enabled");
    if (rising & st::ADC_CR_ADVREGEN) {
      require((before & st::ADC_CR_DEEPPWD) == 0, "regulator switched on in deep power down");
      converter.poweredAt = registers.accesses;
    }
    if (written & st::ADC_CR_ADCAL) {
      require(isPowered && registers.accesses - converter.poweredAt >= kRegulatorCycles,
              "calibrated before the regulator is stable");
      require((before & st::ADC_CR_ADEN) == 0, "calibrated while enabled");
      require((registers.word<Ccr>() & (st::ADC_CCR_PRESC | st::ADC_CCR_CKMODE)) != 0, "clocked too fast");
    }
    if (rising & st::ADC_CR_ADEN) {
      require((before & st::ADC_CR_ADCAL) == 0 && converter.isCalibrated, "enabled before it was calibrated");
      require(registers.accesses - converter.calibratedAt >= kCyclesAfterCalibration,
              "enabled too soon after its calibration");
      if (getsReady) registers.word<typename Adc::Isr>() |= st::ADC_ISR_ADRDY;
    }
    if (rising & st::ADC_CR_ADSTART) {
      require((registers.word<typename Adc::Isr>() & st::ADC_ISR_ADRDY) != 0, "started before it is ready");
      require(which == 0, "a slave is started by its master");
      startedAt_ = registers.accesses;
      if (isDual()) registers.word<stm32g431::Adc2::Cr>() |= st::ADC_CR_ADSTART;
    }
    if (written & st::ADC_CR_ADSTP) {
      require((before & st::ADC_CR_ADSTART) != 0, "stopped while it stands still");
      require(which == 0, "a slave is stopped by its master");
    }
    return (written & ~kSetters) | ((before | written) & kSetters);
  }

  /// What hardware clears, by the time that somebody looks.
  template <typename Adc>
  std::uint32_t settle(std::size_t which, std::uint32_t word) {
    if ((word & st::ADC_CR_ADCAL) != 0 && calibrates) {
      word &= ~st::ADC_CR_ADCAL;
      converters_[which].isCalibrated = true;
      converters_[which].calibratedAt = registers.accesses;
    }
    if ((word & st::ADC_CR_ADSTP) != 0 && stops) {
      word &= ~(st::ADC_CR_ADSTP | st::ADC_CR_ADSTART);
      if (isDual()) registers.word<stm32g431::Adc2::Cr>() &= ~st::ADC_CR_ADSTART;
      isBusy_ = false;
    }
    return word;
  }

  template <typename Adc>
  bool isEnabled() {
    return (registers.word<typename Adc::Cr>() & st::ADC_CR_ADEN) != 0;
  }
  bool isDual() { return (registers.word<Ccr>() & st::ADC_CCR_DUAL) == st::LL_ADC_MULTI_DUAL_REG_SIMULT; }
  bool isStarted() { return (registers.word<stm32g431::Adc1::Cr>() & st::ADC_CR_ADSTART) != 0; }
  bool isPaced() { return (registers.word<stm32g431::Tim1::Cr1>() & st::TIM_CR1_CEN) != 0; }

  /// TIM1's update event: its prescaler is loaded, its output told to TIM3 and the converters.
  void update() {
    prescaler_ = registers.word<stm32g431::Tim1::Psc>();
    if ((registers.word<stm32g431::Tim1::Cr2>() & st::TIM_CR2_MMS) != st::LL_TIM_TRGO_UPDATE) return;
    count();
    const std::uint32_t selection = registers.word<stm32g431::Adc1::Cfgr>();
    const bool isHeard =
        !isDeaf_ && isStarted() && registers.accesses - startedAt_ >= kDeafCycles &&
        (selection & st::ADC_CFGR_EXTEN) == st::ADC_CFGR_EXTEN_0 &&
        (selection & st::ADC_CFGR_EXTSEL) == (st::LL_ADC_REG_TRIG_EXT_TIM1_TRGO & st::ADC_CFGR_EXTSEL);
    if (!isHeard || isBusy_) return;
    isBusy_ = true;
    done_ = 0;
  }

  void count() {
    const std::uint32_t selection = registers.word<stm32g431::Tim3::Smcr>();
    if ((registers.word<stm32g431::Tim3::Cr1>() & st::TIM_CR1_CEN) == 0) return;
    const bool countsTriggers = (selection & st::TIM_SMCR_SMS) == st::LL_TIM_CLOCKSOURCE_EXT_MODE1 &&
                                (selection & st::TIM_SMCR_TS) == st::LL_TIM_TS_ITR0;
    std::uint32_t& count = registers.word<stm32g431::Tim3::Cnt>();
    count = (count + (countsTriggers ? 1 : period_cycles())) % (registers.word<stm32g431::Tim3::Arr>() + 1);
  }

  void endConversion() {
    if (loses_ == kNone) {
      transfer();
    } else {
      lose(loses_);
      loses_ = kNone;
    }
    if (++done_ >= length<stm32g431::Adc1>()) isBusy_ = false;
  }

  /// With OVRMOD the new result takes the old one's place and a word is missing; without, the converter keeps
  /// the old one and is a result late from then on.
  void lose(std::size_t which) {
    const std::uint32_t modes[] = {registers.word<stm32g431::Adc1::Cfgr>(),
                                   registers.word<stm32g431::Adc2::Cfgr>()};
    (which == 0 ? registers.word<stm32g431::Adc1::Isr>() : registers.word<stm32g431::Adc2::Isr>()) |=
        st::ADC_ISR_OVR;
    if ((modes[which] & st::ADC_CFGR_OVRMOD) != 0) return;
    ++converters_[which].lag;
    transfer();
  }

  /// What DMA carries: both results, oversampled; then flags and its count.
  void transfer() {
    const std::uint32_t control = registers.word<Dma1::Ccr1>();
    const bool isRequested = (registers.word<Ccr>() & st::ADC_CCR_MDMA) == st::ADC_DMAACCESSMODE_12_10_BITS &&
                             registers.word<stm32g431::Dmamux::C0cr>() == st::DMA_REQUEST_ADC1;
    std::uint32_t& left = registers.word<Dma1::Cndtr1>();
    if (!isRequested || (control & st::DMA_CCR_EN) == 0 || left == 0) {
      registers.word<stm32g431::Adc1::Isr>() |= st::ADC_ISR_OVR;
      return;
    }
    *target(control, reload_ - left) = source(control);
    const bool goesRound =
        (control & st::DMA_CCR_CIRC) != 0 && (registers.word<Ccr>() & st::ADC_CCR_DMACFG) != 0;
    --left;
    if (2 * left == reload_) registers.word<Dma1::Isr>() |= st::DMA_ISR_HTIF1;
    if (left == 0) {
      registers.word<Dma1::Isr>() |= st::DMA_ISR_TCIF1;
      if (goesRound) left = reload_;
    }
  }

  std::uint32_t source(std::uint32_t control) {
    const std::uint32_t word = resultOf<stm32g431::Adc1>(0) | resultOf<stm32g431::Adc2>(1) << 16;
    if (registers.word<Dma1::Cpar1>() != st::ADC12_COMMON_CDR) return kNoMemory;
    const bool isWord = (control & st::DMA_CCR_PSIZE) == st::DMA_PDATAALIGN_WORD &&
                        (control & st::DMA_CCR_MSIZE) == st::DMA_MDATAALIGN_WORD;
    return isWord ? word : word & 0xFF;
  }

  std::uint32_t* target(std::uint32_t control, std::uint32_t index) {
    static std::uint32_t nowhere;
    const bool isKnown =
        registers.word<Dma1::Cmar1>() == FakeRegisters::kMemoryAddress && registers.memory != nullptr;
    FakeRegisters::require(isKnown && index < 2 * stm32g431::kPairs, "DMA writes elsewhere",
                           Dma1::Cmar1::address);
    if (!isKnown || index >= 2 * stm32g431::kPairs) return &nowhere;
    return static_cast<std::uint32_t*>(registers.memory) + ((control & st::DMA_CCR_MINC) != 0 ? index : 0);
  }

  template <typename Adc>
  std::uint32_t resultOf(std::size_t which) {
    if (!isEnabled<Adc>() || (which == 1 && !isDual())) return 0;
    const std::uint32_t index = (done_ + length<Adc>() - converters_[which].lag) % length<Adc>();
    const std::uint32_t settings = registers.word<typename Adc::Cfgr2>();
    const std::uint32_t shift = (settings & st::ADC_CFGR2_OVSS) / (st::ADC_CFGR2_OVSS & -st::ADC_CFGR2_OVSS);
    return voltages[which].at(channel<Adc>(index)) * ratio<Adc>() >> shift;
  }

  template <typename Adc>
  std::uint32_t ratio() {
    const std::uint32_t settings = registers.word<typename Adc::Cfgr2>();
    if ((settings & st::ADC_CFGR2_ROVSE) == 0) return 1;
    return 2U << (settings & st::ADC_CFGR2_OVSR) / (st::ADC_CFGR2_OVSR & -st::ADC_CFGR2_OVSR);
  }
  template <typename Adc>
  std::uint32_t length() {
    return (registers.word<typename Adc::Sqr1>() & st::ADC_SQR1_L) + 1;
  }
  template <typename Adc>
  std::uint32_t channel(std::uint32_t index) {
    return (index < 4 ? registers.word<typename Adc::Sqr1>() >> (6 + 6 * index)
                      : registers.word<typename Adc::Sqr2>() >> (6 * (index - 4))) &
           0x1F;
  }
  std::uint32_t sampleTime(std::uint32_t channel) {
    return (channel < 10 ? registers.word<stm32g431::Adc1::Smpr1>() >> 3 * channel
                         : registers.word<stm32g431::Adc1::Smpr2>() >> 3 * (channel - 10)) &
           7;
  }

  std::array<Converter, 2> converters_{};
  std::uint32_t startedAt_ = 0;
  std::uint32_t prescaler_ = 0;  ///< of TIM1, in force
  std::uint32_t reload_ = 0;     ///< transfers of DMA before it goes round
  std::uint32_t done_ = 0;       ///< pairs of the set in work
  std::size_t loses_ = kNone;
  bool isBusy_ = false;  ///< a set is in work
  bool isDeaf_ = false;
};

}  // namespace strainfinger::doubles
