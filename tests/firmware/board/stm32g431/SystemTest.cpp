#include "firmware/board/stm32g431/microsecond_clock.hpp"
#include "firmware/board/stm32g431/pinout.hpp"
#include "firmware/board/stm32g431/registers/gpio.hpp"
#include "firmware/board/stm32g431/unique_id.hpp"
#include "firmware/board/stm32g431/watchdog.hpp"
#include "tests/doubles/fake_clock.hpp"
#include "tests/firmware/board/stm32g431/fake_registers.hpp"
#include "tests/hal/clock_contract.hpp"
#include "tests/hal/watchdog_contract.hpp"

using namespace strainfinger;
using namespace strainfinger::stm32g431;
using hal::ResetCause;

namespace {

using Watchdog = IndependentWatchdog<doubles::FakeBus, doubles::FakeClock>;
static_assert(hal::Watchdog<Watchdog>);
static_assert(hal::Clock<MicrosecondClock<doubles::FakeBus>>);

/// IWDG: settings are taken only between the unlocking key and the next one, and some reads later.
struct FakeWatchdog {
  doubles::FakeRegisters registers;
  bool started = false;
  bool updates = true;
  int updateReads = 100;  ///< of the status, until the settings are taken
  int feeds = 0;

  FakeWatchdog() {
    registers.add<Dbgmcu::Apb1Fzr1>();
    registers.add<Iwdg::Kr>();
    registers.add<Iwdg::Pr>();
    registers.add<Iwdg::Rlr>(0xFFF);
    registers.add<Iwdg::Sr>();
    registers.onWrite<Iwdg::Kr>([this](std::uint32_t, std::uint32_t key) {
      started |= key == st::IWDG_KEY_ENABLE;
      feeds += key == st::IWDG_KEY_RELOAD;
      return key;
    });
    registers.onWrite<Iwdg::Pr>(
        [this](std::uint32_t before, std::uint32_t value) { return set(before, value); });
    registers.onWrite<Iwdg::Rlr>(
        [this](std::uint32_t before, std::uint32_t value) { return set(before, value); });
    registers.onRead<Iwdg::Sr>(
        [this](std::uint32_t status) { return updates && readsLeft-- < 0 ? 0U : status; });
  }

  std::uint32_t set(std::uint32_t before, std::uint32_t value) {
    if (registers.word<Iwdg::Kr>() != st::IWDG_KEY_WRITE_ACCESS_ENABLE) return before;
    registers.word<Iwdg::Sr>() = 3;
    readsLeft = updateReads;
    return value;
  }

  int readsLeft = 0;
};

struct WatchdogBench {
  FakeWatchdog fake;
  doubles::FakeClock clock{0xFFFF'FFFF};
  Watchdog dog{doubles::FakeBus(fake.registers), clock, ResetCause::kPin};
  Watchdog& watchdog() { return dog; }
};

class ClockBench {
 public:
  ClockBench() {
    registers_.add<Tim2::Psc>();
    registers_.add<Tim2::Arr>(0xFFFF'FFFF);
    registers_.add<Tim2::Egr>();
    registers_.add<Tim2::Cr1>();
    registers_.add<Tim2::Cnt>(0xFFFF'FF00);
    registers_.onWrite<Tim2::Egr>([this](std::uint32_t, std::uint32_t written) {
      if (written & st::TIM_EGR_UG) prescaler_ = registers_.word<Tim2::Psc>();
      return 0;
    });
    clock_.start();
  }
  MicrosecondClock<doubles::FakeBus>& clock() { return clock_; }
  /// TIM2 counts what its prescaler, as the last update loaded it, lets through of 170 MHz.
  void pass(std::uint32_t time_us) {
    const bool enabled = (registers_.word<Tim2::Cr1>() & st::TIM_CR1_CEN) != 0;
    if (enabled) registers_.word<Tim2::Cnt>() += 170 * time_us / (prescaler_ + 1);
  }

 private:
  doubles::FakeRegisters registers_;
  std::uint32_t prescaler_ = 0;
  MicrosecondClock<doubles::FakeBus> clock_{doubles::FakeBus(registers_)};
};

}  // namespace

WATCHDOG_CONTRACT(Independent, WatchdogBench)
CLOCK_CONTRACT(Microsecond, ClockBench)

TEST_GROUP(MicrosecondClock) {
  ClockBench bench;
};

TEST(MicrosecondClock, CountsMicrosecondsFromTheFirstOn) {
  const std::uint32_t before_us = bench.clock().now_us();
  bench.pass(1000);
  LONGS_EQUAL(1000, bench.clock().now_us() - before_us);
}

TEST_GROUP(IndependentWatchdog) {
  WatchdogBench bench;
  doubles::FakeRegisters csr;

  ResetCause causeOf(std::uint32_t flags, bool ramSurvived = false) {
    csr.add<Rcc::Csr>(flags);
    return takeResetCause(doubles::FakeBus(csr), ramSurvived);
  }
};

TEST(IndependentWatchdog, StartsWithHalfASecond) {
  CHECK_TRUE(bench.dog.start());
  CHECK_TRUE(bench.fake.started);
  const double tick_ms = (4 << bench.fake.registers.word<Iwdg::Pr>()) / 32.0;
  DOUBLES_EQUAL(500, (bench.fake.registers.word<Iwdg::Rlr>() + 1) * tick_ms, 1e-9);
  CHECK_TRUE(bench.fake.feeds > 0);
}

TEST(IndependentWatchdog, RunsOnlyWhenStarted) {
  bench.dog.feed();
  CHECK_FALSE(bench.fake.started);
}

TEST(IndependentWatchdog, SaysWhenItsSettingsDidNotTake) {
  bench.fake.updates = false;
  CHECK_FALSE(bench.dog.start());
  CHECK_TRUE(bench.fake.started);
}

// Six cycles of the slow clock after its largest prescaler, where it is slowest: 6 * 256 / 29.5 kHz. 170 MHz
// make at most a poll in 6 cycles.
TEST(IndependentWatchdog, WaitsAsLongAsItsSlowClockMayTake) {
  bench.fake.updateReads = static_cast<int>(6 * 256 / 29.5e3 * 170e6 / 6);
  CHECK_TRUE(bench.dog.start());
}

TEST(IndependentWatchdog, FeedsWithTheKey) {
  bench.dog.feed();
  CHECK_TRUE((bench.fake.registers.writes.back() == doubles::FakeRegisters::Access{0x4000'3000, 0xAAAA}));
}

TEST(IndependentWatchdog, SaysThatItStarvesBeforeItResets) {
  bench.clock.advance(399'999);
  CHECK_FALSE(bench.dog.isStarved());
  bench.clock.advance(1);
  CHECK_TRUE(bench.dog.isStarved());
  bench.dog.feed();
  CHECK_FALSE(bench.dog.isStarved());
}

// And TIM2, the clock by which it starves: bit 0.
TEST(IndependentWatchdog, StandsStillWhileADebuggerHoldsTheProcessor) {
  CHECK_TRUE(bench.dog.start());
  LONGS_EQUAL(1U << 12 | 1, bench.fake.registers.at(0xE004'2008));
}

// Every reset sets the pin's flag (bit 26) too.
TEST(IndependentWatchdog, TellsTheResetsApart) {
  CHECK_TRUE(causeOf(0x2400'0000) == ResetCause::kWatchdog);
  CHECK_TRUE(causeOf(0x4400'0000) == ResetCause::kWatchdog);
  CHECK_TRUE(causeOf(0x1400'0000) == ResetCause::kSoftware);
  CHECK_TRUE(causeOf(0x0600'0000) == ResetCause::kSoftware);
  CHECK_TRUE(causeOf(0x0C00'0000) == ResetCause::kPowerOn);
  CHECK_TRUE(causeOf(0x0C00'0000, true) == ResetCause::kBrownOut);
  CHECK_TRUE(causeOf(0x0400'0000) == ResetCause::kPin);
  CHECK_TRUE(causeOf(0x8400'0000) == ResetCause::kUnknown);
  CHECK_TRUE(causeOf(0) == ResetCause::kUnknown);
}

TEST(IndependentWatchdog, TheFlagsAreCleared) {
  causeOf(0x2400'0000);
  LONGS_EQUAL(1, csr.writes.front().value >> 23 & 1);
  LONGS_EQUAL(0, csr.writes.back().value >> 23 & 1);
}

TEST_GROUP(UniqueId) {};

TEST(UniqueId, IsThreeWords) {
  doubles::FakeRegisters registers;
  registers.addRange(0x1FFF'7590, 12);
  registers.at(0x1FFF'7590) = 1;
  registers.at(0x1FFF'7594) = 2;
  registers.at(0x1FFF'7598) = 3;
  CHECK_TRUE((uniqueId(doubles::FakeBus(registers)) == UniqueId{1, 2, 3}));
}

TEST(UniqueId, ItsShortNumberIsNeverThatOfNoNumber) {
  for (std::uint32_t last = 0; last < 5000; ++last) CHECK_TRUE(shortNumber({last, 0, 0xFFFF'FFFF}) != 0);
  CHECK_TRUE(shortNumber({1, 2, 3}) != shortNumber({1, 2, 4}));
}

TEST_GROUP(Pins) {
  doubles::FakeRegisters registers;
  void setup() override {
    registers.addRange(0x4800'0000, 0x28);
    registers.giveClock(Rcc::Ahb2Enr::gpioA(1));
  }
};

TEST(Pins, CanHasItsClockItsFunctionAndAPullUpAtTheReceiver) {
  doubles::FakeRegisters fresh;
  fresh.addRange(st::GPIOA_BASE, 0x28, 0xFFFF'FFFF);
  connectCan(doubles::FakeBus(fresh));  // PA11 and PA12
  LONGS_EQUAL(0xFEBF'FFFF, fresh.at(st::GPIOA_MODER));
  LONGS_EQUAL(0xFC7F'FFFF, fresh.at(st::GPIOA_PUPDR));
  LONGS_EQUAL(0xFFF9'9FFF, fresh.at(st::GPIOA_AFR + 4));
}

TEST(Pins, AnAlternateFunctionIsSetBeforeTheMode) {
  makeAlternate(doubles::FakeBus(registers), {Port::kA, 11}, 9, Gpio::kUp);
  LONGS_EQUAL(0x0080'0000, registers.at(0x4800'0000));
  LONGS_EQUAL(0x0080'0000, registers.at(0x4800'0008));
  LONGS_EQUAL(0x0040'0000, registers.at(0x4800'000C));
  LONGS_EQUAL(0x0000'9000, registers.at(0x4800'0024));
  LONGS_EQUAL(0x4800'0024, registers.writes.front().address);
  LONGS_EQUAL(0x4800'0000, registers.writes.back().address);
}

TEST(Pins, OtherPinsAreLeftAlone) {
  registers.at(0x4800'0000) = 0xABFF'FFFF;
  makeAnalog(doubles::FakeBus(registers), {Port::kA, 0});
  LONGS_EQUAL(0xABFF'FFFF, registers.at(0x4800'0000));
}
