#pragma once
// Oscillators, PLL and supply as registers: RM0440 chapters 5 to 7.

#include "firmware/board/stm32g431/registers/clocks.hpp"
#include "firmware/board/stm32g431/registers/flash.hpp"
#include "tests/firmware/board/stm32g431/fake_registers.hpp"

namespace strainfinger::doubles {

/// As after a reset. Each clock is ready when it is switched on, if it starts at all. What the manual forbids
/// fails the test.
class FakeClocks {
 public:
  FakeRegisters registers;
  bool crystalStarts = true;
  bool internalStarts = true;
  bool pllLocks = true;
  bool pllStops = true;
  bool switches = true;

  FakeClocks() {
    registers.add<Rcc::Cr>(st::RCC_CR_HSION | st::RCC_CR_HSIRDY);
    registers.add<Rcc::Cfgr>(st::RCC_CFGR_SW_HSI | st::RCC_CFGR_SWS_HSI);
    registers.add<Rcc::PllCfgr>(0x1000);
    registers.add<Rcc::Ccipr>();
    registers.add<stm32g431::Pwr::Cr1>(st::PWR_CR1_VOS_0);
    registers.add<stm32g431::Pwr::Sr2>();
    registers.add<stm32g431::Pwr::Cr5>(st::PWR_CR5_R1MODE);
    registers.add<stm32g431::Flash::Acr>();
    registers.onRead<Rcc::Cr>([this](std::uint32_t word) { return settled(word); });
    registers.onWrite<Rcc::Cr>(
        [this](std::uint32_t before, std::uint32_t written) { return control(before, written); });
    registers.onWrite<Rcc::PllCfgr>([this](std::uint32_t, std::uint32_t written) {
      FakeRegisters::require((control() & (st::RCC_CR_PLLON | st::RCC_CR_PLLRDY)) == 0,
                             "written while the PLL runs", Rcc::PllCfgr::address);
      return written;
    });
    registers.onRead<Rcc::Cfgr>([this](std::uint32_t word) { return switched(word); });
    registers.onWrite<Rcc::Cfgr>(
        [this](std::uint32_t before, std::uint32_t written) { return select(before, written); });
  }

  /// The bootloader in ROM leaves the PLL running, from the internal oscillator, and the processor on it.
  void bootloaderHasRun() {
    registers.word<Rcc::Cr>() |= st::RCC_CR_PLLON | st::RCC_CR_PLLRDY;
    registers.word<Rcc::PllCfgr>() = st::RCC_PLLCFGR_PLLREN | st::RCC_PLLCFGR_PLLSRC_HSI;
    registers.word<Rcc::Cfgr>() = st::RCC_CFGR_SW_PLL | st::RCC_CFGR_SWS_PLL;
  }

  /// The crystal stops. True: it was watched, which raises the NMI; the processor then has the internal
  /// oscillator.
  bool crystalStops() {
    const bool isWatched = (control() & st::RCC_CR_CSSON) != 0 && (control() & st::RCC_CR_HSERDY) != 0;
    crystalStarts = false;
    if (!isWatched) return false;
    registers.word<Rcc::Cr>() &=
        ~(st::RCC_CR_HSEON | st::RCC_CR_HSERDY | st::RCC_CR_PLLON | st::RCC_CR_PLLRDY);
    registers.word<Rcc::Cfgr>() = st::RCC_CFGR_SW_HSI | st::RCC_CFGR_SWS_HSI;
    return true;
  }

  /// Of the processor, by the formula of section 7.4.4.
  double core_hz() {
    const std::uint32_t pll = registers.word<Rcc::PllCfgr>();
    if (status() != st::RCC_CFGR_SWS_PLL) return status() == st::RCC_CFGR_SWS_HSI ? 16e6 : 24e6;
    const double input_hz = (pll & st::RCC_PLLCFGR_PLLSRC) == st::RCC_PLLCFGR_PLLSRC_HSE ? 24e6 : 16e6;
    const double pll_hz = input_hz / (field(pll, st::RCC_PLLCFGR_PLLM) + 1) *
                          field(pll, st::RCC_PLLCFGR_PLLN) / (2 * (field(pll, st::RCC_PLLCFGR_PLLR) + 1));
    const std::uint32_t halving = registers.word<Rcc::Cfgr>() & st::RCC_CFGR_HPRE;
    return halving == st::RCC_CFGR_HPRE_DIV1 ? pll_hz : pll_hz / 2;
  }

 private:
  using Rcc = stm32g431::Rcc;
  static constexpr std::uint32_t kCyclesAtHalf = 170;  ///< 1 us

  static std::uint32_t field(std::uint32_t word, std::uint32_t mask) {
    return (word & mask) / (mask & -mask);
  }
  std::uint32_t control() { return registers.word<Rcc::Cr>(); }
  std::uint32_t status() { return registers.word<Rcc::Cfgr>() & st::RCC_CFGR_SWS; }

  std::uint32_t settled(std::uint32_t word) {
    word = follow(word, st::RCC_CR_HSION, st::RCC_CR_HSIRDY, internalStarts);
    word = follow(word, st::RCC_CR_HSEON, st::RCC_CR_HSERDY, crystalStarts);
    if (!pllStops) return word | st::RCC_CR_PLLRDY;
    return follow(word, st::RCC_CR_PLLON, st::RCC_CR_PLLRDY, pllLocks);
  }
  static std::uint32_t follow(std::uint32_t word, std::uint32_t on, std::uint32_t ready, bool works) {
    return works && (word & on) != 0 ? word | ready : word & ~ready;
  }

  /// A clock in use can't be switched off, nor the watch over the crystal.
  std::uint32_t control(std::uint32_t before, std::uint32_t written) {
    written |= before & st::RCC_CR_CSSON;
    if (status() == st::RCC_CFGR_SWS_PLL) written |= before & (st::RCC_CR_PLLON | st::RCC_CR_HSEON);
    if ((written & ~before & st::RCC_CR_PLLON) != 0) {
      const bool fromCrystal =
          (registers.word<Rcc::PllCfgr>() & st::RCC_PLLCFGR_PLLSRC) == st::RCC_PLLCFGR_PLLSRC_HSE;
      FakeRegisters::require((written & (fromCrystal ? st::RCC_CR_HSERDY : st::RCC_CR_HSIRDY)) != 0,
                             "PLL started before its input", Rcc::Cr::address);
    }
    return written;
  }

  std::uint32_t select(std::uint32_t before, std::uint32_t written) {
    const auto require = [](bool isAllowed, const char* what) {
      FakeRegisters::require(isAllowed, what, Rcc::Cfgr::address);
    };
    const bool toPll = (written & st::RCC_CFGR_SW) == st::RCC_CFGR_SW_PLL;
    const bool isHalved = (written & st::RCC_CFGR_HPRE) == st::RCC_CFGR_HPRE_DIV2;
    if (toPll && (before & st::RCC_CFGR_SW) != st::RCC_CFGR_SW_PLL) {
      require((control() & st::RCC_CR_PLLRDY) != 0, "switched to a PLL that has not locked");
      require((registers.word<Rcc::PllCfgr>() & st::RCC_PLLCFGR_PLLREN) != 0,
              "switched to an output that is off");
      require((registers.word<stm32g431::Pwr::Cr1>() & st::PWR_CR1_VOS) == st::PWR_CR1_VOS_0,
              "not in voltage range 1");
      require((registers.word<stm32g431::Pwr::Cr5>() & st::PWR_CR5_R1MODE) == 0,
              "above 150 MHz without boost");
      require((registers.word<stm32g431::Flash::Acr>() & st::FLASH_ACR_LATENCY) >= st::FLASH_ACR_LATENCY_4WS,
              "too few wait states");
      require(isHalved, "above 150 MHz at once");
      switchedAt_ = registers.accesses;
    } else if (toPll && !isHalved) {
      require(registers.accesses - switchedAt_ >= kCyclesAtHalf, "less than 1 us at half speed");
    }
    return written;
  }

  std::uint32_t switched(std::uint32_t word) const {
    if (!switches) return word;
    const std::uint32_t wanted = field(word, st::RCC_CFGR_SW);
    return (word & ~st::RCC_CFGR_SWS) | wanted * (st::RCC_CFGR_SWS & -st::RCC_CFGR_SWS);
  }

  std::uint32_t switchedAt_ = 0;
};

}  // namespace strainfinger::doubles
