#include "host/simulation/simulated_gauges.hpp"

#include <cmath>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::simulation;

TEST_GROUP(SimulatedGauges) {
  config::FingerConfig config;
  SimulatedClock clock;
  hal::SampleSet set{};

  SimulatedGauges gauges(const Scenario& scenario = Scenario({}), const RingOptions& options = {}) {
    return SimulatedGauges(config, scenario, clock, options);
  }
  /// A touch that sweeps every gauge through many steps of the converter.
  Scenario sweep() {
    return Scenario({{0, 100, Course({{0, 0}, {100, 720}}), Course({{0, 0}, {100, 40}}), Course({{0, 0}})}});
  }

  void next(SimulatedGauges & ring) {
    clock.advance_us(SimulatedGauges::kSamplePeriod_us);
    CHECK_TRUE(ring.read(set));
  }
  double reading(std::size_t gauge) { return Converter(config.gauges).strainOf(set[gauge]); }

  /// Deviation of 20,000 readings from the true strain, 1,250 sets and more, in which the contact moves 9
  /// degrees and a strain runs through many steps: near a constant strain the noise of a coarse converter
  /// depends on where in its step the strain is.
  double residual(SimulatedGauges & ring) {
    double sum = 0, count = 0;
    for (int sample = 0; sample < 10'000 && count < 20'000; ++sample) {
      next(ring);
      const Strains strains = ring.strains().under(ring.truth());
      for (std::size_t gauge = 0; gauge < 16; ++gauge) {
        if (std::fabs(strains[gauge]) < 3 * config.gauges.step_strain()) continue;
        sum += std::pow(reading(gauge) - strains[gauge], 2);
        ++count;
      }
    }
    CHECK_TRUE(count >= 20'000);
    return std::sqrt(sum / count);
  }
};

TEST(SimulatedGauges, ASetIsThereEachPeriodAndHandedOutOnce) {
  SimulatedGauges ring = gauges();
  CHECK_FALSE(ring.read(set));
  clock.advance_us(999);
  CHECK_FALSE(ring.read(set));
  clock.advance_us(1);
  CHECK_TRUE(ring.read(set));
  CHECK_FALSE(ring.read(set));
  DOUBLES_EQUAL(0.001, ring.sampleTime_s(), 0);
}

// A load of 30 N/m reads 13.8 millistrain below itself; noise is 6 microstrain.
TEST(SimulatedGauges, AGaugeReadsWithTheGainThatItWasBuiltWith) {
  const Scenario press({{0, 1, Course({{0, 0}}), Course({{0, 30}}), Course({{0, 0}})}});
  config.as_built.gain = 0.1;
  SimulatedGauges ring = gauges(press);
  next(ring);
  const double gain = ring.strains().gain(0);
  CHECK_TRUE(std::abs(gain - 1) > 0.01);
  DOUBLES_EQUAL(gain, reading(0) / ring.strains().under(ring.truth())[0], 0.004);
}

TEST(SimulatedGauges, WithoutANewSetTheCallersIsLeftAlone) {
  SimulatedGauges ring = gauges();
  set.fill(7);
  CHECK_FALSE(ring.read(set));
  for (const std::uint16_t code : set) LONGS_EQUAL(7, code);
}

TEST(SimulatedGauges, TheOldestSetsAreDroppedAndCountedOnce) {
  SimulatedGauges ring = gauges();
  clock.advance_us(5000);
  LONGS_EQUAL(3, ring.overruns());
  CHECK_TRUE(ring.read(set));
  DOUBLES_EQUAL(0.004, ring.sampleTime_s(), 0);
  CHECK_TRUE(ring.read(set));
  CHECK_FALSE(ring.read(set));
  LONGS_EQUAL(3, ring.overruns());
}

TEST(SimulatedGauges, DroppedSetsDoNotChangeTheRest) {
  SimulatedGauges patient = gauges(sweep()), late = gauges(sweep());
  hal::SampleSet lateSet{};
  for (int sample = 0; sample < 9; ++sample) next(patient);
  LONGS_EQUAL(7, late.overruns());
  CHECK_TRUE(late.read(lateSet) && late.read(lateSet));
  CHECK_TRUE(set == lateSet);
}

TEST(SimulatedGauges, TheSeedDecidesTheNoise) {
  SimulatedGauges one = gauges(sweep()), same = gauges(sweep()), other = gauges(sweep(), {.seed = 2});
  hal::SampleSet sameSet{}, otherSet{};
  next(one);
  CHECK_TRUE(same.read(sameSet) && other.read(otherSet));
  CHECK_TRUE(set == sameSet);
  CHECK_FALSE(set == otherSet);
}

// Oracle: SplitMix64 and Box & Muller written once more, in Python.
TEST(SimulatedGauges, TheCodesOfASeedNeverChange) {
  config.gauges.adc_bits = 16;
  SimulatedGauges ring = gauges();
  next(ring);
  LONGS_EQUAL(0x8003, set[0]);
  LONGS_EQUAL(0x800E, set[1]);
  LONGS_EQUAL(0x7FFB, set[2]);
  LONGS_EQUAL(0x8002, set[3]);
}

// 20,000 readings: the standard error of their standard deviation is 0.5 %, the limit four of them.
TEST(SimulatedGauges, NoiseStrainIsTheDeviationOfAReadingQuantisationIncluded) {
  for (const auto& [bits, noise] : {std::pair{12, 6e-6}, {12, 4.3e-6}, {12, 5e-5}, {16, 6e-6}, {8, 7e-5}}) {
    config.gauges.adc_bits = bits;
    config.gauges.noise_strain = noise;
    SimulatedGauges ring = gauges(sweep());
    clock = SimulatedClock();
    clock.advance_us(80'000'000);
    CHECK_TRUE(ring.read(set) && ring.read(set));
    DOUBLES_EQUAL(noise, residual(ring), 0.02 * noise);
  }
}

TEST(SimulatedGauges, ZerosSpreadAsAsked) {
  config.gauges.count = 32;
  config.gauges.noise_strain = 4.3e-6;
  SimulatedGauges ring = gauges(Scenario({}), {.seed = 5, .zeroSpread_strain = 1e-3});
  next(ring);
  double square = 0;
  for (std::size_t gauge = 0; gauge < 32; ++gauge) square += std::pow(reading(gauge), 2) / 32;
  DOUBLES_EQUAL(1e-3, std::sqrt(square), 3.5e-4);  // strain; standard error of 32 values 12 %, times three
}

TEST(SimulatedGauges, AGainScalesTheStrainOfItsGauge) {
  const Scenario press({{0, 1, Course({{0, 0}}), Course({{0, 40}}), Course({{0, 0}})}});
  double square = 0;
  config.as_built.gain = 0.05;
  for (int seed = 0; seed < 100; ++seed) {
    config.as_built.seed = seed;
    SimulatedGauges ring = gauges(press);
    next(ring);
    while (ring.read(set)) {}
    square += std::pow(reading(0) / (40 * -460.6030e-6) - 1, 2) / 100;
  }
  DOUBLES_EQUAL(0.05, std::sqrt(square), 0.011);  // relative; standard error of 100 values 7 %, times three
}

TEST(SimulatedGauges, ARingPressedTooHardStaysAtTheRail) {
  SimulatedGauges ring = gauges(Scenario({{0, 1, Course({{0, 0}}), Course({{0, 100}}), Course({{0, 0}})}}));
  next(ring);
  LONGS_EQUAL(0, set[0]);
}
