#include "host/simulation/converter.hpp"

#include <cmath>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::simulation;

TEST_GROUP(Converter) {
  config::Gauges gaugesOf(int bits) {
    config::Gauges gauges;
    gauges.adc_bits = bits;
    return gauges;
  }
};

TEST(Converter, CodesAreLeftJustifiedWithZeroStrainInTheMiddle) {
  const Converter converter(gaugesOf(12));
  const double step_strain = 2 * 0.03 / 4096;
  LONGS_EQUAL(0x8000, converter.codeOf(0));
  LONGS_EQUAL(0x8010, converter.codeOf(step_strain));
  LONGS_EQUAL(0x7FF0, converter.codeOf(-step_strain));
  LONGS_EQUAL(0xC000, converter.codeOf(0.015));
}

TEST(Converter, TheNearestCodeIsTaken) {
  const Converter converter(gaugesOf(8));
  const double step_strain = 2 * 0.03 / 256;
  LONGS_EQUAL(0x8000, converter.codeOf(0.499 * step_strain));
  LONGS_EQUAL(0x8100, converter.codeOf(0.501 * step_strain));
  LONGS_EQUAL(0x8000, converter.codeOf(-0.499 * step_strain));
  LONGS_EQUAL(0x7F00, converter.codeOf(-0.501 * step_strain));
}

TEST(Converter, BeyondTheEndsItStaysAtItsRails) {
  for (const double strain : {-0.03, -0.031, -1e300, -HUGE_VAL, std::nan("")})
    LONGS_EQUAL(0, Converter(gaugesOf(12)).codeOf(strain));
  for (const double strain : {0.03, 0.031, 1e300, HUGE_VAL}) {
    LONGS_EQUAL(0xFFF0, Converter(gaugesOf(12)).codeOf(strain));
    LONGS_EQUAL(0xFFFF, Converter(gaugesOf(16)).codeOf(strain));
  }
}

TEST(Converter, EveryCodeIsTheCodeOfItsStrain) {
  for (int bits = 8; bits <= 16; ++bits) {
    const Converter converter(gaugesOf(bits));
    for (int code = 0; code < 0x10000; code += 1 << (16 - bits))
      LONGS_EQUAL(code, converter.codeOf(converter.strainOf(static_cast<std::uint16_t>(code))));
  }
}

TEST(Converter, AnalogNoiseIsWhatQuantisationLeaves) {
  // Default: step 0.06/4096, so sqrt(6e-6^2 - (0.06/4096)^2 / 12) = 4.25660e-6.
  DOUBLES_EQUAL(4.25660e-6, analogNoise_strain(config::Gauges{}), 1e-11);
}

TEST(Converter, NoAnalogNoiseIsLeftWhereQuantisationIsAllOfIt) {
  config::Gauges gauges;
  gauges.noise_strain = gauges.quantisation_strain();
  DOUBLES_EQUAL(0, analogNoise_strain(gauges), 0);
}
