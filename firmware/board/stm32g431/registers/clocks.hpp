#pragma once
// Clocks and supply: RCC (RM0440 chapter 7), PWR (chapter 6).

#include "firmware/board/stm32g431/registers/register.hpp"

namespace strainfinger::stm32g431 {

/// Reset and clock control, RM0440 section 7.4.
struct Rcc {
  static constexpr std::uint32_t base = 0x4002'1000;

  struct Cr : Register<base + 0x00> {
    static constexpr Field<Cr, 8> hsiOn{};
    static constexpr Field<Cr, 10> hsiReady{};
    static constexpr Field<Cr, 16> hseOn{};
    static constexpr Field<Cr, 17> hseReady{};
    static constexpr Field<Cr, 19>
        clockSecurity{};  ///< CSSON: NMI when HSE stops; only a reset takes it back
    static constexpr Field<Cr, 24> pllOn{};
    static constexpr Field<Cr, 25> pllReady{};
  };
  struct Cfgr : Register<base + 0x08> {
    static constexpr Field<Cfgr, 0, 2> systemClock{};        ///< SystemClock: wanted
    static constexpr Field<Cfgr, 2, 2> systemClockStatus{};  ///< SystemClock: in use
    static constexpr Field<Cfgr, 4, 4> ahbPrescaler{};       ///< AhbPrescaler
    static constexpr Field<Cfgr, 8, 3> apb1Prescaler{};      ///< 0: 1
    static constexpr Field<Cfgr, 11, 3> apb2Prescaler{};     ///< 0: 1
  };
  enum SystemClock : std::uint32_t { kHsi = 1, kPll = 3 };
  enum AhbPrescaler : std::uint32_t { kWhole = 0, kHalf = 8 };

  struct PllCfgr : Register<base + 0x0C> {
    static constexpr Field<PllCfgr, 0, 2> source{};      ///< PllSource
    static constexpr Field<PllCfgr, 4, 4> divideIn{};    ///< M - 1
    static constexpr Field<PllCfgr, 8, 7> multiply{};    ///< N
    static constexpr Field<PllCfgr, 24> outputOn{};      ///< PLLREN
    static constexpr Field<PllCfgr, 25, 2> divideOut{};  ///< R / 2 - 1
  };
  enum PllSource : std::uint32_t { kPllFromHsi = 2, kPllFromHse = 3 };

  struct Ahb1Enr : Register<base + 0x48> {
    static constexpr Field<Ahb1Enr, 0> dma1{};
    static constexpr Field<Ahb1Enr, 2> dmamux{};
  };
  struct Ahb2Enr : Register<base + 0x4C> {
    static constexpr Field<Ahb2Enr, 0> gpioA{};
    static constexpr Field<Ahb2Enr, 1> gpioB{};
    static constexpr Field<Ahb2Enr, 2> gpioC{};
    static constexpr Field<Ahb2Enr, 13> adc12{};
  };
  struct Apb1Enr1 : Register<base + 0x58> {
    static constexpr Field<Apb1Enr1, 0> tim2{};
    static constexpr Field<Apb1Enr1, 1> tim3{};
    static constexpr Field<Apb1Enr1, 25> fdcan{};
    static constexpr Field<Apb1Enr1, 28> pwr{};
  };
  struct Apb2Enr : Register<base + 0x60> {
    static constexpr Field<Apb2Enr, 11> tim1{};
  };

  struct Ccipr : Register<base + 0x88> {
    static constexpr Field<Ccipr, 24, 2> fdcanClock{};  ///< FdcanClock
    static constexpr Field<Ccipr, 28, 2> adc12Clock{};  ///< Adc12Clock
  };
  enum FdcanClock : std::uint32_t { kFdcanFromHse = 0, kFdcanFromPclk1 = 2 };
  enum Adc12Clock : std::uint32_t { kAdc12FromSystemClock = 2 };

  /// Flags of the last reset; they stay until `remove` is written, over further resets.
  struct Csr : Register<base + 0x94> {
    static constexpr Field<Csr, 23> remove{};
    static constexpr Field<Csr, 25> optionBytes{};
    static constexpr Field<Csr, 26> pin{};  ///< set by every reset: all of them pull the pin
    static constexpr Field<Csr, 27> brownOut{};
    static constexpr Field<Csr, 28> software{};
    static constexpr Field<Csr, 29> independentWatchdog{};
    static constexpr Field<Csr, 30> windowWatchdog{};
    static constexpr Field<Csr, 31> lowPower{};
  };
};

/// Gives peripherals their clock. It runs two cycles after the enable bit is set, and until then their
/// registers ignore what is written: reading the bit back takes that long (RM0440 section 7.2.17).
template <typename EnableRegister>
void enableClock(const RegisterBus auto& bus, Bits<EnableRegister> peripherals) noexcept {
  modify(bus, peripherals);
  static_cast<void>(bus.read(EnableRegister::address));
}

/// Power control, RM0440 section 6.4.
struct Pwr {
  static constexpr std::uint32_t base = 0x4000'7000;

  struct Cr1 : Register<base + 0x00> {
    static constexpr Field<Cr1, 9, 2> voltageRange{};  ///< 1: range 1
  };
  struct Sr2 : Register<base + 0x14> {
    static constexpr Field<Sr2, 10> voltageChanging{};  ///< VOSF
  };
  struct Cr5 : Register<base + 0x80> {
    static constexpr Field<Cr5, 8> normalMode{};  ///< R1MODE; 0: boost, needed above 150 MHz
  };
};

}  // namespace strainfinger::stm32g431
