#include "host/simulation/gauge_fault.hpp"

#include <cmath>

#include "host/base/failure.hpp"
#include "host/simulation/simulated_gauges.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::simulation;

TEST_GROUP(GaugeFault) {
  using Kind = simulation::GaugeFault::Kind;
  config::FingerConfig config;
  SimulatedClock clock;

  static void checkRefused(const char* text) {
    try {
      static_cast<void>(readGaugeFault(text));
    } catch (const Failure& failure) {
      CHECK(failure.code() == ExitCode::kUsage);
      STRCMP_CONTAINS(text, failure.what());
      return;
    }
    FAIL(text);
  }

  /// A load that grows, from 0.1 s on.
  SimulatedGauges ring(std::vector<simulation::GaugeFault> faults) {
    const Course load({{0, 0}, {1, 30}});
    return SimulatedGauges(config, Scenario({{0.1, 10, Course({{0, 112.5}}), load, Course({{0, 0}})}}), clock,
                           {.faults = std::move(faults)});
  }
  hal::SampleSet next(SimulatedGauges & gauges, int sets = 1) {
    hal::SampleSet set{};
    for (int i = 0; i < sets; ++i) {
      clock.advance_us(SimulatedGauges::kSamplePeriod_us);
      CHECK_TRUE(gauges.read(set));
    }
    return set;
  }
  double strainOf(std::uint16_t code) { return Converter(config.gauges).strainOf(code); }
};

TEST(GaugeFault, IsReadFromAWord) {
  CHECK((readGaugeFault("dead:5") == simulation::GaugeFault{Kind::kDead, 5, 0}));
  CHECK((readGaugeFault("stuck:11@2.5") == simulation::GaugeFault{Kind::kStuck, 11, 2.5}));
  CHECK(readGaugeFault("open:0").kind == Kind::kOpen && readGaugeFault("short:0").kind == Kind::kShort);
  CHECK(readGaugeFault("noisy:0").kind == Kind::kNoisy);
}

TEST(GaugeFault, RefusesWhatIsNone) {
  for (const char* text : {"", "dead", "dead:", "dead:x", "dead:-1", "dead:5@", "dead:5@-1", "dead:5@nan",
                           "dead:5@2e9", "dead:5 ", "broken:5", ":5", "dead:5@1@2", "dead@1:5"})
    checkRefused(text);
}

TEST(GaugeFault, RefusesAGaugeThatTheRingHasNot) {
  CHECK_THROWS(Failure, ring({{Kind::kDead, 16, 0}}));
  static_cast<void>(ring({{Kind::kDead, 15, 0}}));
}

TEST(GaugeFault, OpenAndShortAreTheRails) {
  SimulatedGauges gauges = ring({{Kind::kOpen, 4, 0}, {Kind::kShort, 6, 0}});
  const hal::SampleSet set = next(gauges);
  LONGS_EQUAL(0xFFF0, set[4]);
  LONGS_EQUAL(0, set[6]);
}

TEST(GaugeFault, BeginsWhenItSays) {
  SimulatedGauges gauges = ring({{Kind::kOpen, 4, 0.005}});
  CHECK(next(gauges, 4)[4] != 0xFFF0);
  LONGS_EQUAL(0xFFF0, next(gauges)[4]);
}

TEST(GaugeFault, ADeadGaugeFeelsNothing) {
  SimulatedGauges gauges = ring({{Kind::kDead, 5, 0}});
  const hal::SampleSet set = next(gauges, 1100);
  DOUBLES_EQUAL(0, strainOf(set[5]), 5 * config.gauges.noise_strain);
  CHECK(std::fabs(strainOf(set[6])) > 1e-4);
}

TEST(GaugeFault, AStuckGaugeStaysWhereItWas) {
  SimulatedGauges healthy = ring({}), gauges = ring({{Kind::kStuck, 5, 0.6}});
  const std::uint16_t before = next(healthy, 600)[5];
  hal::SampleSet set{};
  for (int i = 0; i < 400; ++i) {
    clock.advance_us(SimulatedGauges::kSamplePeriod_us);
    CHECK_TRUE(gauges.read(set));
    LONGS_EQUAL(before, set[5]);
  }
}

TEST(GaugeFault, ANoisyGaugesNoiseIsTenTimesTheOthers) {
  SimulatedGauges gauges = ring({{Kind::kNoisy, 5, 0}});
  double sum = 0;
  for (int i = 0; i < 99; ++i) sum += std::pow(strainOf(next(gauges)[5]), 2) / 99;
  DOUBLES_EQUAL(10, std::sqrt(sum) / config.gauges.noise_strain, 3);  // 14 % of 10, twice
}
