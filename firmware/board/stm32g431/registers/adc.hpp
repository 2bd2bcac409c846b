#pragma once
// Converters and what carries their results to memory: ADC (RM0440 chapter 21), DMA (chapter 12), DMAMUX
// (chapter 13).

#include "firmware/board/stm32g431/registers/register.hpp"

namespace strainfinger::stm32g431 {

/// What starts a conversion, RM0440 table of section 21.4.18.
enum AdcTrigger : std::uint32_t { kTim1Trgo = 9 };

/// One converter, RM0440 section 21.7.
template <std::uint32_t kBase>
struct Adc {
  struct Isr : Register<kBase + 0x00> {
    static constexpr Field<Isr, 0> ready{};    ///< ADRDY; cleared by writing 1
    static constexpr Field<Isr, 4> overrun{};  ///< OVR: DMA had yet to take the last; cleared by writing 1
  };
  struct Cr : Register<kBase + 0x08> {
    static constexpr Field<Cr, 0> enable{};
    static constexpr Field<Cr, 2> start{};
    static constexpr Field<Cr, 4> stop{};  ///< ADSTP; falls back to 0, with start, when nothing converts
    static constexpr Field<Cr, 28> regulatorOn{};
    static constexpr Field<Cr, 29> deepPowerDown{};  ///< 1 after reset
    static constexpr Field<Cr, 31> calibrate{};      ///< falls back to 0 when done
  };
  struct Cfgr : Register<kBase + 0x0C> {
    static constexpr Field<Cfgr, 5, 5> trigger{};         ///< EXTSEL: AdcTrigger
    static constexpr Field<Cfgr, 10, 2> triggerEdge{};    ///< EXTEN; 1: rising
    static constexpr Field<Cfgr, 12> overwrite{};         ///< OVRMOD; 1: a new result replaces one not taken
    static constexpr Field<Cfgr, 31> injectedQueueOff{};  ///< JQDIS
  };
  struct Cfgr2 : Register<kBase + 0x10> {
    static constexpr Field<Cfgr2, 0> oversample{};  ///< ROVSE
    static constexpr Field<Cfgr2, 2, 3> ratio{};    ///< OVSR: 2^(this + 1) conversions
    static constexpr Field<Cfgr2, 5, 4> shift{};    ///< OVSS: sum >> this
  };
  struct Smpr1 : Register<kBase + 0x14> {};  ///< 3 bits a channel, 0 .. 9
  struct Smpr2 : Register<kBase + 0x18> {};  ///< 3 bits a channel, 10 .. 18
  struct Sqr1 : Register<kBase + 0x30> {};   ///< bits 0-3: length - 1, then 6 bits a conversion, 1 .. 4
  struct Sqr2 : Register<kBase + 0x34> {};   ///< conversions 5 .. 9
};

using Adc1 = Adc<0x5000'0000>;
using Adc2 = Adc<0x5000'0100>;

/// Both converters together, RM0440 section 21.8.
struct Adc12 {
  static constexpr std::uint32_t base = 0x5000'0300;

  struct Ccr : Register<base + 0x08> {
    static constexpr Field<Ccr, 0, 5> dual{};        ///< Dual
    static constexpr Field<Ccr, 13> dmaCircular{};   ///< DMACFG
    static constexpr Field<Ccr, 14, 2> dmaMode{};    ///< MDMA: DmaMode
    static constexpr Field<Ccr, 16, 2> clockMode{};  ///< 0: from the kernel clock, through the prescaler
    static constexpr Field<Ccr, 18, 4> prescaler{};  ///< PRESC: Prescaler
  };
  enum Dual : std::uint32_t { kRegularSimultaneous = 6 };
  enum DmaMode : std::uint32_t { kNoDma = 0, kBothInAWord = 2 };
  enum Prescaler : std::uint32_t { kDivideBy8 = 4 };

  struct Cdr : Register<base + 0x0C> {};  ///< ADC1's result below, ADC2's above
};

/// DMA1, its channel 1, RM0440 section 12.6.
struct Dma1 {
  static constexpr std::uint32_t base = 0x4002'0000;

  struct Isr : Register<base + 0x00> {
    static constexpr Field<Isr, 1, 2> halves1{};  ///< TCIF1, HTIF1: channel 1 has filled a half
    static constexpr Field<Isr, 3> error1{};      ///< TEIF1
  };
  struct Ifcr : Register<base + 0x04> {
    static constexpr Field<Ifcr, 1, 2> halves1{};
    static constexpr Field<Ifcr, 3> error1{};
  };
  struct Ccr1 : Register<base + 0x08> {
    static constexpr Field<Ccr1, 0> enable{};
    static constexpr Field<Ccr1, 5> circular{};
    static constexpr Field<Ccr1, 7> incrementMemory{};
    static constexpr Field<Ccr1, 8, 2> peripheralSize{};
    static constexpr Field<Ccr1, 10, 2> memorySize{};
    static constexpr Field<Ccr1, 12, 2> priority{};
  };
  enum Size : std::uint32_t { kWord = 2 };
  enum Priority : std::uint32_t { kHighest = 3 };

  struct Cndtr1 : Register<base + 0x0C> {
    static constexpr Field<Cndtr1, 0, 16> left{};  ///< transfers to go until it starts again
  };
  struct Cpar1 : Register<base + 0x10> {};
  struct Cmar1 : Register<base + 0x14> {};
};

/// Which request drives DMA1's channel 1, RM0440 section 13.6; requests: section 13.3.2.
struct Dmamux {
  struct C0cr : Register<0x4002'0800> {
    static constexpr Field<C0cr, 0, 8> request{};
  };
  enum Request : std::uint32_t { kAdc1 = 5 };
};

}  // namespace strainfinger::stm32g431
