// What comes before and after a fit, with bounds for numbers: strains of any codes, readings of any strains,
// thresholds, units.
#include <limits>

#include "firmware/core/condition.hpp"
#include "firmware/core/hypothesis.hpp"
#include "firmware/core/judge.cpp"  // NOLINT: its arithmetic is what is proved
#include "firmware/core/units.hpp"
#include "tests/firmware/ranges/any_tables.hpp"
#include "tests/firmware/ranges/ranges_group.hpp"

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP_BASE(ReadingsRanges, RangesGroup) {
  static constexpr GaugeSet kAll = 0xFFFFFFFF;

  static TableConstants noisyConstants(std::uint32_t variance, int exponent) {
    TableConstants constants = tablesOf({})->constants;
    constants.noise_variance = variance;
    constants.noise_variance_exponent = static_cast<std::int8_t>(exponent);
    constants.model_error_q16 = 0xFFFF;
    constants.gauge_count = 3;
    CHECK_TRUE(usableNoise(variance, exponent));
    return constants;
  }
  static void checkScaled(const TableConstants& constants, const Number& strain, int shift) {
    forEachWay([&] {
      std::array<Number, 3> strains;
      strains.fill(strain);
      const ScaledReadings scaled =
          scaledReadings(constants, strains, allGauges(3), std::numeric_limits<std::uint32_t>::max(), shift,
                         signlessBits(strain));
      CHECK_TRUE(scaled.shift >= 0 && scaled.shift <= 18);
      CHECK_TRUE(scaled.variances.largest_q4 <= 0x7FFFFFFF);
      for (const Short& weight_q14 : std::span(scaled.weight_q14).first(3))
        checkWithin(weight_q14, 0, 1 << 14);
    });
  }
  static ScaledReadings anyReadings(std::uint32_t noise_q4 = 0) {
    ScaledReadings any;
    any.value.fill(Short::any());
    any.variances = {0x7FFFFFFF, noise_q4, 0x7FFFFFFF};
    return any;
  }
  static Solution anySolution(int contacts) {
    Solution any{{static_cast<std::uint8_t>(contacts), true, kAll}, {}};
    any.contact.fill({0, within(1 << 20), within(1 << 20), {0, 1 << kMomentBits}});
    any.residualEnergy = {0, kMostLeft};
    return any;
  }
};

TEST(ReadingsRanges, AnyCodesZerosAndGainsOverflowNothing) {
  const Number zero(0, Number::kMost);
  checkWithin(conditioned(Number(0, 0xFFFF), zero, zero), -(std::int64_t{1} << 30), std::int64_t{1} << 30);
  for (int shift = 0; shift <= kMostGateShift; ++shift) {
    const std::int64_t most = (std::int64_t{1} << (16 + shift)) - 2;
    CHECK_TRUE(usableGain(most, shift));
    checkWithin(conditioned(Number(0, 0xFFFF), zero, Number(0, most)), -(1 << (15 + shift)),
                1 << (15 + shift));
  }
  checkNone();
}

TEST(ReadingsRanges, ACodeOfMoreBitsWouldOverflow) {
  conditioned(Number(0, 0x1FFFF), Number(0, Number::kMost), Number(0, Number::kMost));
  checkSome();
}

TEST(ReadingsRanges, AnyStrainsNoiseAndShiftOverflowNothing) {
  for (const int exponent : {kLeastNoiseExponent, -8, 0, 8, kMostNoiseExponent})
    for (const std::uint32_t variance : {0u, 1u, kMostNoiseVariance})
      for (const int shift : {-1, 0, 1, 7, 17})
        checkScaled(noisyConstants(variance, exponent), Number::any(), shift);
  checkNone();
}

TEST(ReadingsRanges, ContactsRescaledByAnyShiftsOverflowNothing) {
  for (int from = 0; from <= 18; ++from)
    for (int to = 0; to <= 18; ++to)
      for (const ContactState& contact : rescaled(anySolution(2).contact, from, to))
        checkWithin(contact.normal, -(1 << 20), 1 << 20);
  checkNone();
}

TEST(ReadingsRanges, ThresholdsOverflowNothing) {
  const TableConstants constants = tablesOf({})->constants;
  for (const int contacts : {1, 2})
    forEachWay([&] {
      const Solution solution = anySolution(contacts);
      isPromising(constants, solution);
      isWithinGate(solution, anyReadings());
      for (const bool was : {false, true}) isWeak(solution, anyReadings(0x7FFFFFFF).variances, was);
      likelihoodEnergy(constants, solution, anyReadings());
    });
  forEachWay([&] { isAccepted(constants, anySolution(1), anyReadings()); });
  for (const std::uint32_t noise_q4 : {0u, 0x7FFFFFFFu}) {
    for (const bool was : {false, true})
      forEachWay([&] { isPlainAsBuilt(constants, anySolution(1), anyReadings(noise_q4), was); });
    for (const int sets : {1, 255})
      forEachWay(
          [&] { checkWithin(ambiguity(anyReadings(noise_q4).variances, sets), 0, std::int64_t{1} << 31); });
  }
  forEachWay([&] { isFirm(constants, anySolution(2), anyReadings()); });
  checkNone();
}

TEST(ReadingsRanges, UnitsOverflowNothing) {
  for (int exponent = -70; exponent <= -3; ++exponent) lineLoad(within(1 << 20), Number::any(), exponent);
  checkWithin(centidegrees(Natural(0, 0xFFFFFFFF)), 0, 36000);
  checkWithin(wholeDegrees(Number::any()), -180, 180);
  for (const int halvings : {0, 1}) force(Wide(0, 0xFFFFFFFF), Number::any(), halvings);
  checkNone();
}

TEST(ReadingsRanges, ALoadShiftedLeftWouldBeFound) {
  lineLoad(within(1 << 20), Number::any(), 1);
  checkSome();
}
