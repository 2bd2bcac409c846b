#include "firmware/board/stm32g431/clock_tree.hpp"

#include "tests/firmware/board/stm32g431/fake_clocks.hpp"

using namespace strainfinger;
using namespace strainfinger::stm32g431;

TEST_GROUP(ClockTree) {
  doubles::FakeClocks clocks;
  doubles::FakeRegisters& registers = clocks.registers;

  std::optional<ClockSource> start() { return ClockTree(doubles::FakeBus(registers)).start(); }
};

TEST(ClockTree, RunsAt170MegahertzFromTheCrystal) {
  CHECK_TRUE(start() == ClockSource::kCrystal);
  DOUBLES_EQUAL(170e6, clocks.core_hz(), 0);
  LONGS_EQUAL(st::RCC_PLLCFGR_PLLSRC_HSE, registers.word<Rcc::PllCfgr>() & st::RCC_PLLCFGR_PLLSRC);
}

TEST(ClockTree, FallsBackWhenTheCrystalDoesNotStart) {
  clocks.crystalStarts = false;
  CHECK_TRUE(start() == ClockSource::kInternal);
  DOUBLES_EQUAL(170e6, clocks.core_hz(), 0);
  LONGS_EQUAL(0, registers.field(Rcc::Cr::hseOn));
}

TEST(ClockTree, IsToldWhenTheCrystalStops) {
  start();
  CHECK_TRUE(clocks.crystalStops());
}

TEST(ClockTree, NothingWatchesACrystalThatDidNotStart) {
  clocks.crystalStarts = false;
  start();
  CHECK_FALSE(clocks.crystalStops());
  DOUBLES_EQUAL(170e6, clocks.core_hz(), 0);
}

TEST(ClockTree, StartsAgainWhenTheBootloaderHasLeftThePllRunning) {
  clocks.bootloaderHasRun();
  CHECK_TRUE(start() == ClockSource::kCrystal);
  DOUBLES_EQUAL(170e6, clocks.core_hz(), 0);
}

TEST(ClockTree, WaitsLongEnoughForACrystal) {
  clocks.crystalStarts = false;
  start();
  CHECK_TRUE(registers.accesses > 5 * 16'000 / 6);  // 5 ms of 16 MHz, 6 cycles a poll
}

TEST(ClockTree, GivesUpWhenTheInternalOscillatorDoesNotStart) {
  clocks.bootloaderHasRun();
  clocks.internalStarts = false;
  CHECK_FALSE(start().has_value());
  LONGS_EQUAL(Rcc::kPll, registers.field(Rcc::Cfgr::systemClock));
}

TEST(ClockTree, GivesUpWhenThePllDoesNotLock) {
  clocks.pllLocks = false;
  CHECK_FALSE(start().has_value());
  LONGS_EQUAL(Rcc::kHsi, registers.field(Rcc::Cfgr::systemClock));
}

TEST(ClockTree, GivesUpWhenTheSystemClockDoesNotSwitch) {
  clocks.switches = false;
  CHECK_FALSE(start().has_value());
}

TEST(ClockTree, GivesUpWhenTheSystemClockDoesNotSwitchBack) {
  clocks.bootloaderHasRun();
  clocks.switches = false;
  CHECK_FALSE(start().has_value());
  LONGS_EQUAL(0, registers.field(Rcc::Cr::hseOn));
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
  clocks.pllStops = false;
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
}

TEST(ClockTree, BusesRunAsFastAsTheProcessor) {
  registers.word<Rcc::Cfgr>() |= st::RCC_CFGR_PPRE1 | st::RCC_CFGR_PPRE2;
  start();
  LONGS_EQUAL(0, registers.word<Rcc::Cfgr>() & (st::RCC_CFGR_HPRE | st::RCC_CFGR_PPRE1 | st::RCC_CFGR_PPRE2));
}

TEST(ClockTree, PrefetchesAndCaches) {
  start();
  LONGS_EQUAL(0x700 | 4, registers.word<Flash::Acr>());
}

TEST(ClockTree, CanTakesTheCrystalItself) {
  start();
  LONGS_EQUAL(st::RCC_FDCANCLKSOURCE_HSE | st::RCC_ADC12CLKSOURCE_SYSCLK, registers.word<Rcc::Ccipr>());
}

TEST(ClockTree, WithoutTheCrystalCanTakesTheBusClock) {
  clocks.crystalStarts = false;
  start();
  LONGS_EQUAL(st::RCC_FDCANCLKSOURCE_PCLK1 | st::RCC_ADC12CLKSOURCE_SYSCLK, registers.word<Rcc::Ccipr>());
}
