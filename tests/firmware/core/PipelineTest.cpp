#include "firmware/core/pipeline.hpp"

#include <numbers>

#include "host/simulation/converter.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(Pipeline) {
  const ModelRing ring{ModelRing::asDrawn()};
  const simulation::Converter converter{config::Gauges{}};
  const double noise_strain = simulation::analogNoise_strain(config::Gauges{});
  Pipeline pipeline{ring.tables(), FitMode::kRefined};
  Presses random{16, 20, 801, 0, 3};
  std::vector<std::uint16_t> codes = std::vector<std::uint16_t>(16);

  const Observation& process(const std::vector<double>& strains) {
    const auto noisy = random.noisy(strains, noise_strain);
    for (std::size_t i = 0; i < codes.size(); ++i) codes[i] = converter.codeOf(noisy[i]);
    return pipeline.process(codes);
  }
  const Observation& process(const std::vector<double>& strains, int sets) {
    for (int set = 1; set < sets; ++set) process(strains);
    return process(strains);
  }
  const Observation& release() { return process(std::vector<double>(16, 0.0), 20); }
};

TEST(Pipeline, NothingTouchesAnUntouchedRing) {
  for (int set = 0; set < 10'000; ++set) CHECK_FALSE(process(std::vector<double>(16, 0.0)).touched);
}

TEST(Pipeline, ATouchIsObservedAndItsEndToo) {
  const Press press{5.4, 20, 3, 1};
  CHECK_TRUE(process(ring.strains(press), 30).touched);
  const auto& answer = pipeline.answer();
  DOUBLES_EQUAL(5.4, ring.pressOf(answer.solution.contact[0], answer.shift).position_pitch, 0.02);
  CHECK_FALSE(release().touched);
}

TEST(Pipeline, HumIsNoTouch) {
  for (const double amplitude : {20e-6, 100e-6, 300e-6}) {
    int ghosts = 0;
    for (int set = 0; set < 4000; ++set) {
      const double hum = amplitude * std::sin(2 * std::numbers::pi * set / 20);
      if (process(std::vector<double>(16, hum)).touched) ++ghosts;
    }
    LONGS_EQUAL(0, ghosts);
    CHECK_TRUE(pipeline.observation().noisy);
  }
}

TEST(Pipeline, HealthyGaugesStayInUse) {
  for (int touch = 0; touch < 100; ++touch) {
    process(ring.strains(random.next()), 60);
    UNSIGNED_LONGS_EQUAL(0, release().outOfUse);
  }
}

TEST(Pipeline, TwoContactsTakeNoGaugeOutOfUse) {
  for (int touch = 0; touch < 40; ++touch) {
    const Press one = random.next(), other{one.position_pitch + 1 + touch % 14 * 0.5, 15, 3, 1};
    for (int set = 0; set < 60; ++set) {
      const Press joining{other.position_pitch, 0.25 * set, 0.05 * set, 1};
      process(ring.strains({one, joining}));
    }
    release();
    UNSIGNED_LONGS_EQUAL(0, pipeline.observation().outOfUse);
  }
}

TEST(Pipeline, ASaturatedGaugeIsNotFitted) {
  const Press press{5.4, 25, 3, 1};
  auto strains = ring.strains(press);
  strains[5] = -0.1;
  const Observation& observation = process(strains, 40);
  UNSIGNED_LONGS_EQUAL(1u << 5, observation.saturated);
  CHECK_FALSE(contains(pipeline.answer().solution.hypothesis.gauges, 5));
}
