#include "firmware/board/stm32g431/clock_tree.hpp"

#include "tests/firmware/board/stm32g431/fake_registers.hpp"

using namespace strainfinger;
using namespace strainfinger::stm32g431;

TEST_GROUP(ClockTree) {
  doubles::FakeRegisters registers;
  bool crystalStarts = true;
  bool pllLocks = true;
  bool switches = true;

  /// Each clock becomes ready some reads after it was switched on, if at all.
  void setup() override {
    registers.add<Rcc::Cr>(Rcc::Cr::hsiOn(1).value | Rcc::Cr::hsiReady(1).value);
    registers.add<Rcc::Cfgr>(
        (Rcc::Cfgr::systemClock(Rcc::kHsi) | Rcc::Cfgr::systemClockStatus(Rcc::kHsi)).value);
    registers.add<Rcc::PllCfgr>(0x1000);
    registers.add<Rcc::Apb1Enr1>();
    registers.add<Rcc::Ccipr>();
    registers.add<Pwr::Cr1>(0x200);
    registers.add<Pwr::Sr2>();
    registers.add<Pwr::Cr5>(0x100);
    registers.add<Flash::Acr>();
    registers.onRead<Rcc::Cr>([this](std::uint32_t word) {
      word = follow(word, Rcc::Cr::hseOn, Rcc::Cr::hseReady, crystalStarts);
      return follow(word, Rcc::Cr::pllOn, Rcc::Cr::pllReady, pllLocks);
    });
    registers.onRead<Rcc::Cfgr>([this](std::uint32_t word) {
      const std::uint32_t wanted = Rcc::Cfgr::systemClock.in(word);
      return switches
                 ? (word & ~Rcc::Cfgr::systemClockStatus.mask) | Rcc::Cfgr::systemClockStatus(wanted).value
                 : word;
    });
  }

  template <typename On, typename Ready>
  static std::uint32_t follow(std::uint32_t word, On on, Ready ready, bool works) {
    return (word & ~Ready::mask) | ready(works && on.in(word) != 0).value;
  }

  std::optional<ClockSource> start() { return ClockTree(doubles::FakeBus(registers)).start(); }

  /// What PLLCFGR makes of the input, by the formula of RM0440 section 7.4.4. [Hz]
  std::uint64_t pllOutput_hz(std::uint64_t input_hz) {
    using P = Rcc::PllCfgr;
    return input_hz * registers.field(P::multiply) / (registers.field(P::divideIn) + 1) /
           (2 * (registers.field(P::divideOut) + 1));
  }
};

TEST(ClockTree, RunsAt170MegahertzFromTheCrystal) {
  CHECK_TRUE(start() == ClockSource::kCrystal);
  LONGS_EQUAL(3, registers.field(Rcc::PllCfgr::source));
  LONGS_EQUAL(170'000'000, pllOutput_hz(24'000'000));
  LONGS_EQUAL(3, registers.field(Rcc::Cfgr::systemClock));
  LONGS_EQUAL(0, registers.field(Rcc::Cfgr::ahbPrescaler));
}

TEST(ClockTree, FallsBackWhenTheCrystalDoesNotStart) {
  crystalStarts = false;
  CHECK_TRUE(start() == ClockSource::kInternal);
  LONGS_EQUAL(2, registers.field(Rcc::PllCfgr::source));
  LONGS_EQUAL(170'000'000, pllOutput_hz(16'000'000));
  LONGS_EQUAL(0, registers.field(Rcc::Cr::hseOn));
}

TEST(ClockTree, WaitsLongEnoughForACrystal) {
  crystalStarts = false;
  start();
  CHECK_TRUE(registers.accesses > 5 * 16'000 / 6);  // 5 ms of 16 MHz, 6 cycles a poll
}

TEST(ClockTree, GivesUpWhenThePllDoesNotLock) {
  pllLocks = false;
  CHECK_FALSE(start().has_value());
  LONGS_EQUAL(Rcc::kHsi, registers.field(Rcc::Cfgr::systemClock));
}

TEST(ClockTree, GivesUpWhenTheSystemClockDoesNotSwitch) {
  switches = false;
  CHECK_FALSE(start().has_value());
}

TEST(ClockTree, GivesUpWhenTheSupplyDoesNotSettle) {
  registers.setField(Pwr::Sr2::voltageChanging, 1);
  CHECK_FALSE(start().has_value());
  LONGS_EQUAL(0, registers.field(Rcc::Cr::hseOn));
}

TEST(ClockTree, GivesUpWhenTheWaitStatesDoNotTake) {
  registers.onWrite<Flash::Acr>([](std::uint32_t before, std::uint32_t) { return before; });
  CHECK_FALSE(start().has_value());
  LONGS_EQUAL(Rcc::kHsi, registers.field(Rcc::Cfgr::systemClock));
}

TEST(ClockTree, GivesUpWhenThePllDoesNotStop) {
  registers.onRead<Rcc::Cr>(
      [](std::uint32_t word) { return word | Rcc::Cr::pllReady.mask | Rcc::Cr::hseReady.mask; });
  CHECK_FALSE(start().has_value());
}

TEST(ClockTree, BoostAndWaitStatesComeBeforeTheSwitch) {
  start();
  const auto halved = registers.firstWrite<Rcc::Cfgr>(0xF0, 0x80);
  const auto boosted = registers.firstWrite<Pwr::Cr5>(0x100, 0);
  const auto slowed = registers.firstWrite<Flash::Acr>(0xF, 4);
  const auto switched = registers.firstWrite<Rcc::Cfgr>(0x3, 3);
  CHECK_TRUE(halved < boosted && boosted < slowed && slowed < switched);
  CHECK_TRUE(switched < registers.writes.size());
  LONGS_EQUAL(0x80, registers.writes[switched].value & 0xF0);  // still at half speed
}

TEST(ClockTree, RunsAtHalfSpeedForAMicrosecond) {
  start();
  std::uint32_t reads = 0;
  bool halved = false;
  registers.onRead<Rcc::Cfgr>([&](std::uint32_t word) {
    halved = Rcc::Cfgr::ahbPrescaler.in(word) == 8;
    if (halved && Rcc::Cfgr::systemClock.in(word) == Rcc::kPll) ++reads;
    return (word & ~0xCU) | (word & 3) << 2;
  });
  start();
  CHECK_TRUE(reads >= 170);
}

TEST(ClockTree, PrefetchesAndCaches) {
  start();
  LONGS_EQUAL(0x700 | 4, registers.word<Flash::Acr>());
}

TEST(ClockTree, CanTakesTheCrystalItself) {
  start();
  LONGS_EQUAL(0, registers.field(Rcc::Ccipr::fdcanClock));
  LONGS_EQUAL(2, registers.field(Rcc::Ccipr::adc12Clock));
}

TEST(ClockTree, WithoutTheCrystalCanTakesTheBusClock) {
  crystalStarts = false;
  start();
  LONGS_EQUAL(2, registers.field(Rcc::Ccipr::fdcanClock));
}
