#include "firmware/core/detect.hpp"

#include <cmath>
#include <limits>
#include <random>

#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(Detect) {
  TableConstants constants{};
  ContactGate gate;

  void setup() override {
    constants.gate_on = 1000;
    constants.gate_off = 500;
  }
  std::uint32_t energyOf(const std::vector<std::int32_t>& strains, int shift) {
    constants.gate_shift = static_cast<std::uint8_t>(shift);
    return gateEnergy(constants, strains);
  }
};

TEST(Detect, EnergyIsTheSumOfTheSquaresDividedAndRoundedDown) {
  std::printf("seed 2 ");
  std::mt19937 random(2);
  for (int shift = 0; shift <= kMostGateShift; ++shift)
    for (const std::size_t gauges : {12u, 14u, 16u, 18u, 32u}) {
      std::uniform_int_distribution<std::int32_t> strain(-(1 << (shift + 13)), 1 << (shift + 13));
      std::vector<std::int32_t> strains(gauges);
      std::uint64_t sum = 0;
      for (std::int32_t& value : strains) {
        value = strain(random);
        sum += static_cast<std::uint64_t>(std::int64_t{value} * value);
      }
      UNSIGNED_LONGS_EQUAL(sum >> (2 * shift), energyOf(strains, shift));
    }
}

TEST(Detect, FullScaleOfAllGaugesSaturatesTheEnergy) {
  for (const std::int32_t end : {1 - (1 << 29), (1 << 29) - 1})
    UNSIGNED_LONGS_EQUAL(std::numeric_limits<std::uint32_t>::max(),
                         energyOf(std::vector<std::int32_t>(32, end), kMostGateShift));
}

TEST(Detect, TheLargestEnergyBelowSaturationIsExact) {
  // 4 * 32767^2 + 511^2 + 31^2 + 7^2 + 2^2 is 2^32 - 5.
  const std::vector<std::int32_t> strains{32767, -32767, 32767, 32767, 511, 31, 7, 2};
  UNSIGNED_LONGS_EQUAL(4294967291u, energyOf(strains, 0));
}

TEST(Detect, TheNoiseOfAReadingIsRightForEveryExponent) {
  // 24 bits of the variance give 12 or 13 of its root; smaller than 1 it is rounded down.
  for (int exponent = kLeastNoiseExponent; exponent <= kMostNoiseExponent; ++exponent)
    for (const std::uint32_t variance : {std::uint32_t{0}, std::uint32_t{1} << 23, kMostNoiseVariance}) {
      constants.noise_variance = variance;
      constants.noise_variance_exponent = static_cast<std::int8_t>(exponent);
      const double noise = std::sqrt(std::ldexp(variance, exponent));
      DOUBLES_EQUAL(noise, readingNoise_q32(constants), 1 + noise * 1e-3);
    }
}

TEST(Detect, AContactBeginsAtTheUpperThreshold) {
  CHECK_FALSE(gate.update(constants, 999));
  CHECK_FALSE(gate.touched());
  CHECK_TRUE(gate.update(constants, 1000));
  CHECK_TRUE(gate.touched());
}

TEST(Detect, AContactEndsBelowTheLowerThreshold) {
  gate.update(constants, 1001);
  CHECK_TRUE(gate.update(constants, 999));
  CHECK_TRUE(gate.update(constants, 500));
  CHECK_FALSE(gate.update(constants, 499));
  CHECK_FALSE(gate.update(constants, 999));
}

TEST(Detect, NoiseAloneTouchesInNoneOf100000SampleSets) {
  const ModelRing ring;
  Presses random(16, 0, 3);
  int held = 0;
  for (int sample = 0; sample < 100'000; ++sample) {
    std::vector<double> strains(16);
    for (double& strain : strains) strain = random.noise(ring.noise_strain());
    const std::uint32_t energy = gateEnergy(ring.constants(), ring.raw(strains));
    CHECK_FALSE(gate.update(ring.constants(), energy));
    if (energy >= ring.constants().gate_off) ++held;
  }
  // One in a thousand by design; the gate's rounding down adds to it, never more than the same again.
  CHECK(held > 20 && held < 250);
}

TEST(Detect, OneNewtonPerMetreIsFeltAnywhere) {
  const ModelRing ring;
  for (double position = 0; position < 2; position += 1.0 / 64)
    for (const double tangential : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
      ContactGate fresh;
      const auto strains = ring.raw(Press{position, 1, tangential});
      CHECK_TRUE(fresh.update(ring.constants(), gateEnergy(ring.constants(), strains)));
    }
}
