#include "firmware/core/condition.hpp"

#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include "host/simulation/converter.hpp"
#include "host/tables/table_builder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {
constexpr std::int32_t kMax = std::numeric_limits<std::int32_t>::max();
constexpr int kAllCodes = 1 << 16;
}  // namespace

TEST_GROUP(Condition) {
  const TableImage image = tables::buildTableImage({});
  TableConstants constants = image.constants;
  Calibration calibration = tabledCalibration(image);
  Readings readings;

  /// Conditions every code there is, and calls visit(code, strain [* 2^32]).
  template <typename Visit>
  void forEachCode(Visit visit) {
    std::array<std::uint16_t, kMaxGauges> codes{};
    for (int first = 0; first < kAllCodes; first += kMaxGauges) {
      for (std::size_t i = 0; i < codes.size(); ++i)
        codes[i] = static_cast<std::uint16_t>(first + static_cast<int>(i));
      condition(calibration, codes, readings);
      for (std::size_t i = 0; i < codes.size(); ++i) visit(codes[i], readings.strain_q32[i]);
    }
  }

  void checkAgainstExactProduct(std::int32_t zero, std::int32_t gain) {
    calibration.zero_q15.fill(zero);
    calibration.gain.fill(gain);
    // 31-bit factors: their product is exact in a long double's 64 bits.
    forEachCode([&](std::uint16_t code, std::int32_t strain) {
      const long double exact = (std::ldexp(static_cast<long double>(code), 15) - zero) * gain;
      LONGS_EQUAL(static_cast<long>(std::floor(std::ldexp(exact, -32))), strain);
    });
  }

  std::uint32_t saturatedBy(std::vector<std::uint16_t> codes) { return saturatedGauges(constants, codes); }
};

TEST(Condition, EveryCodeGivesTheExactProductRoundedDown) {
  for (const std::int32_t zero : {0, 1, 0x1234'5678, 0x8000 << 15, 0xFFFF << 15, kMax})
    for (const std::int32_t gain : {0, 1, 12345, constants.reading_gain, kMax})
      checkAgainstExactProduct(zero, gain);
}

TEST(Condition, NominalReadingsAreTheConvertersStrains) {
  // Rounded down by up to 1 LSB; the gain's own rounding (1e-9 of it) moves full scale by 0.13 LSB.
  const simulation::Converter converter{config::Gauges{}};
  forEachCode([&](std::uint16_t code, std::int32_t strain) {
    const double error = strain - std::ldexp(converter.strainOf(code), 32);
    CHECK(error > -1.2 && error < 0.2);
  });
}

TEST(Condition, StrainRisesWithTheCode) {
  std::int32_t last = std::numeric_limits<std::int32_t>::min();
  forEachCode([&](std::uint16_t, std::int32_t strain) {
    CHECK(strain > last);
    last = strain;
  });
}

// A 128th of the range from either end, whatever the converter's step.
TEST(Condition, RailsOfEveryResolutionAreSaturated) {
  for (int bits = 8; bits <= 16; ++bits) {
    config::FingerConfig config;
    config.gauges.adc_bits = bits;
    constants = tables::buildTableImage(config).constants;
    const int last = (1 << bits) - 1;
    for (int code = 0; code <= last; ++code) {
      const int justified = code << (16 - bits);
      const bool isRail = justified < 512 || justified >= 65536 - 512;
      LONGS_EQUAL(isRail ? 1 : 0, saturatedBy({static_cast<std::uint16_t>(justified)}));
    }
  }
}

TEST(Condition, EachGaugeHasItsOwnSaturationBit) {
  for (std::size_t gauge = 0; gauge < kMaxGauges; ++gauge) {
    std::vector<std::uint16_t> codes(kMaxGauges, 0x8000);
    codes[gauge] = gauge % 2 == 0 ? 0 : 0xFFFF;
    UNSIGNED_LONGS_EQUAL(1u << gauge, saturatedBy(codes));
  }
}

TEST(Condition, SaturationIsThatOfTheLastSampleSet) {
  saturatedBy(std::vector<std::uint16_t>(kMaxGauges, 0));
  LONGS_EQUAL(0, saturatedBy(std::vector<std::uint16_t>(kMaxGauges, 0x8000)));
}

TEST(Condition, EachGaugeHasItsOwnZeroAndGain) {
  calibration.zero_q15[1] = 0;
  calibration.gain[2] = 0;
  condition(calibration, std::vector<std::uint16_t>{0x9000, 0x9000, 0x9000}, readings);
  const double fullScale = std::ldexp(config::Gauges{}.full_scale_strain, 32);
  DOUBLES_EQUAL(fullScale / 8, readings.strain_q32[0], 1.2);
  DOUBLES_EQUAL(fullScale * 9 / 8, readings.strain_q32[1], 1.4);
  LONGS_EQUAL(0, readings.strain_q32[2]);
}

TEST_GROUP(ZeroAverage) {
  ZeroAverage average;
  Calibration calibration{};

  void add(std::uint16_t code, int times) {
    const std::array<std::uint16_t, kMaxGauges> codes = [&] {
      std::array<std::uint16_t, kMaxGauges> all{};
      all.fill(code);
      return all;
    }();
    for (int i = 0; i < times; ++i) average.add(codes);
  }
  std::int32_t zero() {
    average.writeTo(calibration);
    return calibration.zero_q15.back();
  }
};

TEST(ZeroAverage, IsCompleteWithThe64thSet) {
  const std::array<std::uint16_t, 1> codes{};
  for (int i = 0; i < 63; ++i) CHECK_FALSE(average.add(codes));
  CHECK_FALSE(average.complete());
  CHECK_TRUE(average.add(codes));
  CHECK_TRUE(average.complete());
}

TEST(ZeroAverage, TakesNoMoreThan64) {
  add(100, 64);
  add(0xFFFF, 10);
  LONGS_EQUAL(100 << 15, zero());
}

TEST(ZeroAverage, HoldsBothEndsOfTheScale) {
  add(0xFFFF, 64);
  LONGS_EQUAL(0xFFFF << 15, zero());
  average = {};
  add(0, 64);
  LONGS_EQUAL(0, zero());
}

TEST(ZeroAverage, IsTheExactMeanOfEachGauge) {
  std::printf("seed 1 ");
  std::mt19937 random(1);
  std::array<double, kMaxGauges> sum{};
  for (int set = 0; set < ZeroAverage::kSamples; ++set) {
    std::array<std::uint16_t, kMaxGauges> codes{};
    for (std::size_t i = 0; i < codes.size(); ++i) {
      codes[i] = static_cast<std::uint16_t>(random());
      sum[i] += codes[i];
    }
    average.add(codes);
  }
  average.writeTo(calibration);
  for (std::size_t i = 0; i < sum.size(); ++i) DOUBLES_EQUAL(sum[i] / 64 * 32768, calibration.zero_q15[i], 0);
}

TEST(ZeroAverage, MakesTheSameCodesNoStrain) {
  for (const int code : {0, 1, 0x8000, 0xFFFE, 0xFFFF}) {
    average = {};
    add(static_cast<std::uint16_t>(code), 64);
    calibration.gain.fill(kMax);
    average.writeTo(calibration);
    Readings readings;
    condition(calibration, std::array{static_cast<std::uint16_t>(code)}, readings);
    LONGS_EQUAL(0, readings.strain_q32[0]);
  }
}
