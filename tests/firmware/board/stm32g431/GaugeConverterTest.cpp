#include "firmware/board/stm32g431/gauge_converter.hpp"

#include "tests/firmware/board/stm32g431/fake_converters.hpp"
#include "tests/hal/gauge_adc_contract.hpp"

using namespace strainfinger;
using namespace strainfinger::stm32g431;

namespace {

using Converter = GaugeConverter<doubles::FakeBus>;
static_assert(hal::GaugeAdc<Converter>);

class ConverterBench {
 public:
  static constexpr int kGauges = stm32g431::kGauges;
  static constexpr int kCapacity = 1;

  /// The first set is never handed out.
  ConverterBench() {
    CHECK_TRUE(adc_.start(kDefaultSampling));
    converters_.trigger();
    converters_.finishSet();
    hal::SampleSet unused;
    CHECK_FALSE(adc_.read(unused));
  }
  Converter& adc() { return adc_; }
  hal::SampleSet convert() {
    ++set_;
    hal::SampleSet codes{};
    for (std::size_t gauge = 0; gauge < stm32g431::kGauges; ++gauge) {
      const Input& input = (gauge % 2 == 0 ? kEvenGauges : kOddGauges)[gauge / 2];
      const auto code = static_cast<std::uint16_t>((100 * set_ + gauge) & 0xFFF);
      converters_.voltages[gauge % 2].at(input.channel) = code;
      codes[gauge] = static_cast<std::uint16_t>(code << 4);
    }
    converters_.finishSet();
    return codes;
  }

 private:
  doubles::FakeConverters converters_;
  Converter adc_{doubles::FakeBus(converters_.registers)};
  std::uint32_t set_ = 0;
};

}  // namespace

GAUGE_ADC_CONTRACT(Stm32g431, ConverterBench)

TEST_GROUP(GaugeConverter) {
  doubles::FakeConverters converters;
  Converter adc{doubles::FakeBus(converters.registers)};
  hal::SampleSet set{};

  /// The first set is in work; it is never handed out.
  void start(const SamplingPlan& plan = kDefaultSampling) {
    CHECK_TRUE(adc.start(plan));
    converters.trigger();
  }
  void startSettled() {
    start();
    takeFirst();
  }
  void takeFirst() {
    converters.finishSet();
    CHECK_FALSE(adc.read(set));
  }

  /// Every gauge sees another voltage; a set of them has to come out in order.
  void setVoltages(std::uint16_t first) {
    for (std::size_t gauge = 0; gauge < kGauges; ++gauge)
      converters.voltages[gauge % 2].at((gauge % 2 == 0 ? kEvenGauges : kOddGauges)[gauge / 2].channel) =
          static_cast<std::uint16_t>(first + gauge);
  }
  /// A word of one converter gets lost in the middle of a set.
  void isInOrderAfterLosingOf(std::size_t converter) {
    startSettled();
    converters.convert(3);
    converters.loseNextOf(converter);
    finishSets(1);
    CHECK_FALSE(adc.read(set));
    LONGS_EQUAL(2, adc.overruns());  // the set that lost a word, and the one in work
    LONGS_EQUAL(1, adc.resynchronisations());
    CHECK_TRUE(converters.isRunning());
    converters.trigger();
    takeFirst();
    LONGS_EQUAL(3, adc.overruns());  // and the first, which is thrown away
    setVoltages(200);
    for (int sets = 0; sets < 3; ++sets) {
      finishSets(1);
      readsInOrder(200);
    }
    LONGS_EQUAL(3, adc.overruns());
  }
  void readsInOrder(std::uint16_t first) {
    CHECK_TRUE(adc.read(set));
    for (std::size_t gauge = 0; gauge < kGauges; ++gauge) LONGS_EQUAL((first + gauge) << 4, set[gauge]);
  }
  template <typename FieldType>
  void is(std::uint32_t expected, FieldType field) {
    LONGS_EQUAL(expected, converters.registers.field(field));
  }
  void finishSets(int count) {
    for (; count > 0; --count) converters.finishSet();
  }
};

TEST(GaugeConverter, KeepsTheDelaysAndOrdersOfTheManual) {
  start();  // the fake fails the test otherwise
  CHECK_TRUE(converters.isRunning());
}

TEST(GaugeConverter, BothConvertersOverwriteSoThatAnOverrunLeavesTheirPairsTogether) {
  start();
  is(1, Adc1::Cfgr::overwrite);
  is(1, Adc2::Cfgr::overwrite);
}

TEST(GaugeConverter, TheFirstSetAfterTheStartIsNotHandedOut) {
  start();
  finishSets(1);
  CHECK_FALSE(adc.read(set));
  finishSets(1);
  CHECK_TRUE(adc.read(set));
  LONGS_EQUAL(0, adc.overruns());
}

TEST(GaugeConverter, AfterAnOverrunOfTheFirstConverterTheGaugesAreInOrderAgain) { isInOrderAfterLosingOf(0); }

TEST(GaugeConverter, AfterAnOverrunOfTheSecondConverterTheGaugesAreInOrderAgain) {
  isInOrderAfterLosingOf(1);
}

TEST(GaugeConverter, ASetThatLostAWordJustNowIsNotHandedOut) {
  startSettled();
  finishSets(1);
  converters.loseNextOf(1);
  converters.convert(1);
  CHECK_FALSE(adc.read(set));
  LONGS_EQUAL(1, adc.resynchronisations());
}

TEST(GaugeConverter, AfterABusErrorOfDmaItGoesOn) {
  startSettled();
  converters.failTransfer();
  CHECK_FALSE(adc.read(set));
  LONGS_EQUAL(1, adc.resynchronisations());
  LONGS_EQUAL(1, adc.overruns());  // the set in work
  converters.trigger();
  takeFirst();
  setVoltages(300);
  finishSets(1);
  readsInOrder(300);
}

TEST(GaugeConverter, EverySetIsHandedOutOrCountedHoweverOftenItBeginsAnew) {
  startSettled();
  std::uint32_t begun = 1;  // and in work
  std::uint32_t handedOut = 0;
  for (int turn = 0; turn < 200; ++turn) {
    if (turn % 7 < 2) converters.loseNextOf(turn % 2 == 0 ? 0 : 1);
    converters.convert(kPairs);
    if (turn % 5 != 0) handedOut += adc.read(set);
    converters.trigger();
    ++begun;
  }
  converters.convert(kPairs);
  handedOut += adc.read(set);
  CHECK_TRUE(adc.resynchronisations() > 20);
  LONGS_EQUAL(begun, handedOut + adc.overruns());
}

TEST(GaugeConverter, AnOldResultDoesNotTakeTheFirstGaugesPlace) {
  startSettled();
  converters.loseNextOf(0);
  converters.convert(1);
  CHECK_FALSE(adc.read(set));
  is(2 * kPairs, Dma1::Cndtr1::left);
  is(0, Adc1::Isr::overrun);
  is(0, Adc2::Isr::overrun);
  is(0, Dma1::Isr::halves1);
}

TEST(GaugeConverter, AConverterThatDoesNotStopGivesNothingMore) {
  startSettled();
  converters.stops = false;
  converters.loseNextOf(0);
  finishSets(3);
  for (int turn = 0; turn < 3; ++turn) CHECK_FALSE(adc.read(set));
  LONGS_EQUAL(0, adc.resynchronisations());
}

TEST(GaugeConverter, ATriggerThatTheConvertersMissedDoesNotMakeThousandsOfOverruns) {
  startSettled();
  finishSets(1);
  CHECK_TRUE(adc.read(set));
  converters.convert(kPairs);
  converters.missTrigger();
  for (int sets = 0; sets < 20; ++sets) {
    converters.trigger();
    adc.read(set);
    converters.convert(4);
    adc.read(set);
    converters.convert(4);
    adc.read(set);
  }
  CHECK_TRUE(adc.overruns() < 10);
}

TEST(GaugeConverter, CalibratesBothConvertersBeforeTheyAreEnabled) {
  start();
  const auto& registers = converters.registers;
  const auto calibrated1 = registers.firstWrite<Adc1::Cr>(Adc1::Cr::calibrate.mask, Adc1::Cr::calibrate.mask);
  const auto calibrated2 = registers.firstWrite<Adc2::Cr>(Adc2::Cr::calibrate.mask, Adc2::Cr::calibrate.mask);
  const auto enabled1 = registers.firstWrite<Adc1::Cr>(Adc1::Cr::enable.mask, Adc1::Cr::enable.mask);
  const auto enabled2 = registers.firstWrite<Adc2::Cr>(Adc2::Cr::enable.mask, Adc2::Cr::enable.mask);
  CHECK_TRUE(calibrated1 < enabled1 && calibrated2 < enabled2 && enabled2 < registers.writes.size());
}

TEST(GaugeConverter, GivesUpWhenAConverterDoesNotCalibrate) {
  converters.calibrates = false;
  CHECK_FALSE(adc.start(kDefaultSampling));
  CHECK_FALSE(converters.isRunning());
}

TEST(GaugeConverter, GivesUpWhenAConverterDoesNotGetReady) {
  converters.getsReady = false;
  CHECK_FALSE(adc.start(kDefaultSampling));
  CHECK_FALSE(converters.isRunning());
  CHECK_FALSE(adc.read(set));
}

TEST(GaugeConverter, BothConvertersShareTriggerAndSettings) {
  start();
  is(6, Adc12::Ccr::dual);
  is(9, Adc1::Cfgr::trigger);
  is(1, Adc1::Cfgr::triggerEdge);
  is(0, Adc2::Cfgr::triggerEdge);  // the slave follows
  LONGS_EQUAL(converters.registers.word<Adc1::Cfgr2>(), converters.registers.word<Adc2::Cfgr2>());
  LONGS_EQUAL(converters.registers.word<Adc1::Smpr1>(), converters.registers.word<Adc2::Smpr1>());
}

TEST(GaugeConverter, SamplesEveryChannelEquallyLong) {
  start();
  LONGS_EQUAL(0x1B6D'B6DB, converters.registers.word<Adc1::Smpr1>());  // 3 in each of ten fields
  LONGS_EQUAL(0x036D'B6DB, converters.registers.word<Adc1::Smpr2>());  // and nine
}

TEST(GaugeConverter, RunsTheConvertersAtAnEighthOfTheClock) {
  start();
  is(0, Adc12::Ccr::clockMode);
  is(4, Adc12::Ccr::prescaler);
}

TEST(GaugeConverter, TheTimerGivesTheRate) {
  CHECK_TRUE(adc.start(kDefaultSampling));
  LONGS_EQUAL(170'000, converters.period_cycles());  // from the first period on
  for (int triggers = 0; triggers < 6; ++triggers) converters.trigger();
  LONGS_EQUAL(6, converters.registers.word<Tim3::Cnt>());
}

TEST(GaugeConverter, TheFastPlanSamplesTenTimesAsOften) {
  start(kFastSampling);
  LONGS_EQUAL(17'000, converters.period_cycles());
  is(3, Adc1::Cfgr2::ratio);  // 16 conversions
  is(0, Adc1::Cfgr2::shift);
}

TEST(GaugeConverter, DmaFillsTwoSetsInTurn) {
  start();
  LONGS_EQUAL(0x5000'030C, converters.registers.word<Dma1::Cpar1>());
  LONGS_EQUAL(doubles::FakeRegisters::kMemoryAddress, converters.registers.word<Dma1::Cmar1>());
  LONGS_EQUAL(0x3AA1, converters.registers.word<Dma1::Ccr1>());
  is(16, Dma1::Cndtr1::left);
  is(5, Dmamux::C0cr::request);
}

TEST(GaugeConverter, PinsAreAnalogAndUnpulled) {
  start();
  LONGS_EQUAL(0x5555'F75F, converters.registers.at(0x4800'0000));  // PA0, 1, 4, 6, 7
  LONGS_EQUAL(0xF755'557F, converters.registers.at(0x4800'0400));  // PB0, 1, 2, 12, 14, 15
  LONGS_EQUAL(0x5555'57FF, converters.registers.at(0x4800'0800));  // PC0 .. 4
  LONGS_EQUAL(0x5555'5400, converters.registers.at(0x4800'080C));
}

TEST(GaugeConverter, RailsAreTheEndsOfTheCode) {
  for (const SamplingPlan& plan :
       {kDefaultSampling, kFastSampling, SamplingPlan{1000, 7, SampleTime::k2_5}}) {
    doubles::FakeConverters fresh;
    Converter converter{doubles::FakeBus(fresh.registers)};
    CHECK_TRUE(converter.start(plan));
    fresh.voltages[0].fill(0xFFF);
    fresh.trigger();
    fresh.finishSet();
    CHECK_FALSE(converter.read(set));
    fresh.finishSet();
    CHECK_TRUE(converter.read(set));
    LONGS_EQUAL(0xFFF0, set[0]);
    LONGS_EQUAL(0, set[1]);
  }
}

TEST(GaugeConverter, TheConversionsTakeAsLongAsThePlanSays) {
  for (const SamplingPlan& plan : {kDefaultSampling, kFastSampling}) {
    doubles::FakeConverters fresh;
    Converter converter{doubles::FakeBus(fresh.registers)};
    CHECK_TRUE(converter.start(plan));
    DOUBLES_EQUAL((fresh.busy_halfCycles() + 6) / 2.0 / 21.25e6, plan.busy_ns() / 1e9, 2e-9);
  }
}

TEST(GaugeConverter, ASetInWorkIsNotHandedOut) {
  startSettled();
  converters.convert(7);
  CHECK_FALSE(adc.read(set));
  converters.convert(1);
  CHECK_TRUE(adc.read(set));
}

TEST(GaugeConverter, CountsExactlyWhatALongStandstillLost) {
  startSettled();
  finishSets(1);
  CHECK_TRUE(adc.read(set));
  finishSets(25);  // as while a flash page is erased
  CHECK_TRUE(adc.read(set));
  LONGS_EQUAL(24, adc.overruns());
  CHECK_FALSE(adc.read(set));
}

TEST(GaugeConverter, CountsOnWhenTheCountersWrap) {
  startSettled();
  for (int i = 0; i < 70'000; ++i) {
    converters.finishSet();
    CHECK_TRUE(adc.read(set));
  }
  LONGS_EQUAL(0, adc.overruns());
}

TEST(GaugeConverter, AStuckConverterGivesNothingThoughTheTimerRuns) {
  start();
  finishSets(3);
  adc.read(set);
  for (int i = 0; i < 10; ++i) {
    converters.trigger();
    CHECK_FALSE(adc.read(set));
  }
}

TEST(GaugeConverter, ASetThatIsCompletedWhileReadingIsTakenInstead) {
  startSettled();
  finishSets(1);
  int reads = 0;
  converters.registers.onRead<Tim3::Cnt>([&](std::uint32_t count) {
    if (++reads == 2) converters.voltages[0].fill(0x123), converters.convert(8);
    return count;
  });
  CHECK_TRUE(adc.read(set));
  LONGS_EQUAL(0x1230, set[0]);
  LONGS_EQUAL(1, adc.overruns());
  CHECK_FALSE(adc.read(set));
}

TEST(GaugeConverter, SamplingPlansThatDoNotFitAreNotPossible) {
  CHECK_FALSE((SamplingPlan{10'000, 5, SampleTime::k2_5}.isPossible()));  // 181 us of 100
  CHECK_FALSE((SamplingPlan{10'000, 4, SampleTime::k6_5}.isPossible()));  // 115 us
  CHECK_FALSE((SamplingPlan{500, 4, SampleTime::k2_5}.isPossible()));     // idle for 1.9 ms
  CHECK_FALSE((SamplingPlan{3'000, 4, SampleTime::k2_5}.isPossible()));   // 333.3 us
  CHECK_FALSE((SamplingPlan{1'000, 3, SampleTime::k24_5}.isPossible()));  // 15 bits
  CHECK_FALSE((SamplingPlan{1'000, 8, SampleTime::k2_5}.isPossible()));   // 1446 us of 1000
  CHECK_TRUE((SamplingPlan{1'000, 7, SampleTime::k2_5}.isPossible()));    // 723 us
}

TEST(GaugeConverter, EveryRateThatDividesAMillionFrom250To10000HasAPlan) {
  for (std::uint32_t rate_hz = 1; rate_hz <= 11'000; ++rate_hz) {
    const auto plan = samplingAt(rate_hz);
    CHECK_EQUAL(1'000'000 % rate_hz == 0 && rate_hz >= 250 && rate_hz <= 10'000, plan.has_value());
    CHECK_TRUE(!plan || (plan->isPossible() && plan->rate_hz == rate_hz));
  }
}

// By hand: 8 * 16 * (24.5 + 12.5) cycles are 223 us of 500, with 32 conversions 446 us.
TEST(GaugeConverter, SetsAreYoungWhereThereIsTimeForIt) {
  CHECK_TRUE(samplingAt(2'000)->sampleTime == SampleTime::k24_5);
  LONGS_EQUAL(4, samplingAt(2'000)->oversamplingLog2);
  LONGS_EQUAL(5, samplingAt(1'000)->oversamplingLog2);
}

// By hand: 8 conversions of 16 * (2.5 + 12.5) cycles and 3 of latency are 1923 cycles of 21.25 MHz.
TEST(GaugeConverter, TenKilohertzTakeNinetyMicroseconds) {
  DOUBLES_EQUAL(1923 / 21.25, kFastSampling.busy_ns() / 1000.0, 0.001);
}
