#include "host/tables/table_builder.hpp"

#include <cmath>
#include <cstring>
#include <string>
#include <utility>
#include <vector>

#include "common/fixed_real.hpp"
#include "firmware/core/response.hpp"
#include "host/base/failure.hpp"
#include "host/config/keys.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::tables;
using config::FingerConfig;

namespace {

long double power2(int exponent) { return std::ldexp(1.0L, exponent); }

/// Chance that the squares of an even number of unit normal variates add up to more than x: the closed form
/// e^(-x/2) sum (x/2)^j / j!, j < count / 2.
long double exceeds(int count, long double x) {
  long double term = std::exp(-x / 2), sum = 0;
  for (int j = 1; j <= count / 2; ++j) {
    sum += term;
    term *= x / 2 / j;
  }
  return sum;
}

long double quantile(int count, long double chance) {
  long double low = 0, high = 1000;
  for (int i = 0; i < 100; ++i) (exceeds(count, (low + high) / 2) > chance ? low : high) = (low + high) / 2;
  return low;
}

}  // namespace

TEST_GROUP(TableBuilder) {
  FingerConfig config_;

  TableConstants constants() { return buildTableImage(config_).constants; }

  /// The message of a refusal; "accepted" if none.
  std::string refusal() {
    try {
      buildTableImage(config_);
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(ExitCode::kUsage), static_cast<int>(failure.code()));
      return failure.what();
    }
    return "accepted";
  }
  void checkRefusal(const char* part) { STRCMP_CONTAINS(part, refusal().c_str()); }
  void checkTaken() {
    LONGS_EQUAL(static_cast<int>(TableFault::kNone),
                static_cast<int>(checkTableImage(buildTableImage(config_))));
  }
  /// To a step of TurnQ32.
  static void checkAngle(double expected_deg, std::uint32_t angle_q32) {
    DOUBLES_EQUAL(0, std::remainder(angle_q32 * (360 / 0x1p32) - expected_deg, 360), 1e-7);
  }
  void checkClose(long double expected, long double actual, double relative) {
    DOUBLES_EQUAL(1, static_cast<double>(actual / expected), relative);
  }
  long double noiseInGate(const TableConstants& c) {
    return static_cast<long double>(config_.gauges.noise_strain) * power2(32 - c.gate_shift);
  }
};

TEST(TableBuilder, SameConfigGivesTheSameBytes) {
  const TableImage first = buildTableImage({}), second = buildTableImage({});
  MEMCMP_EQUAL(&first, &second, sizeof(TableImage));
}

TEST(TableBuilder, ParametersAreTheConfigs) {
  config_.finger = {0.01, 0.02, 0.03, 1e5, 0.4};
  config_.gauges = {20, 0.0125, StrainComponent::kHoop, 70, 1e-4, 5e-6, 0.04, 14, 0.02};
  config_.contact = {0.7, 1e-3, 9e-3};
  const TableParameters p = buildTableImage(config_).parameters;
  const std::vector<std::pair<double, double>> pairs{{0.01, p.core_radius_m},
                                                     {0.02, p.outer_radius_m},
                                                     {0.03, p.length_m},
                                                     {1e5, p.shear_modulus_pa},
                                                     {0.4, p.poisson_ratio},
                                                     {20, p.gauge_count},
                                                     {0.0125, p.gauge_radius_m},
                                                     {70, p.first_angle_deg},
                                                     {1e-4, p.arc_length_m},
                                                     {5e-6, p.noise_strain},
                                                     {0.04, p.full_scale_strain},
                                                     {14, p.adc_bits},
                                                     {0.7, p.friction_coefficient},
                                                     {1e-3, p.contact_width_m},
                                                     {9e-3, p.largest_width_m},
                                                     {0.02, p.model_error},
                                                     {0, p.reserved}};
  for (const auto& [expected, actual] : pairs) DOUBLES_EQUAL(expected, actual, 0);
  CHECK(p.component == StrainComponent::kHoop);
}

TEST(TableBuilder, AnUnknownWidthIsANegativeOne) {
  CHECK(buildTableImage(config_).parameters.contact_width_m < 0);
}

TEST(TableBuilder, TheNoiseVarianceKeepsItsTwentyFourBits) {
  for (const double noise : {2.4e-10, 1e-9, 6e-6, 1e-4, 5e-3}) {
    config_.gauges.noise_strain = noise;
    const TableConstants c = constants();
    const long double sigma = static_cast<long double>(noise) * power2(32);
    checkClose(sigma * sigma, c.noise_variance * power2(c.noise_variance_exponent), 0x1p-24);
    CHECK(c.noise_variance >= 1u << 23 && c.noise_variance <= 1u << 24);
  }
}

// The gate's own rounding counts as half a squared step. Wilson and Hilferty's quantile is within 4 %, worst
// for the smallest ring and the rarer event.
TEST(TableBuilder, TheGateOpensOnceInABillionSamplesOfNoiseAndClosesOnceInAThousand) {
  for (int count = kMinGauges; count <= kMaxGauges; count += 2) {
    config_.gauges.count = count;
    const TableConstants c = constants();
    const long double variance = noiseInGate(c) * noiseInGate(c) + 0.5L;
    checkClose(quantile(count, 1e-9L) * variance, c.gate_on, 0.04);
    checkClose(quantile(count, 1e-3L) * variance, c.gate_off, 0.04);
  }
}

// Readings a step below zero: rounded down they are -1 each for the gate.
TEST(TableBuilder, ARingAtRestIsNoContactHoweverSmallTheNoise) {
  for (int count = kMinGauges; count <= kMaxGauges; count += 2) {
    config_.gauges.count = count;
    config_.gauges.noise_strain = 2.4e-10;
    CHECK(constants().gate_off > static_cast<unsigned>(count) * 49 / 100);
    CHECK(constants().gate_on > static_cast<unsigned>(count));
  }
}

TEST(TableBuilder, TheGateHoldsTwoFullScalesInSixteenBits) {
  for (const double fullScale : {2e-4, 0.001, 0.0312, 0.03125, 0.0313, 0.06}) {
    config_.gauges.full_scale_strain = fullScale;
    config_.gauges.noise_strain = 1e-8;
    config_.finger.shear_modulus_pa = 1e5;
    const TableConstants c = constants();
    CHECK(2 * fullScale * 0x1p32 <= static_cast<double>(power2(15 + c.gate_shift)));
    CHECK(c.gate_shift == 0 || 2 * fullScale * 0x1p32 >= static_cast<double>(power2(14 + c.gate_shift)));
  }
}

// Oracle: the strain under 1 N/m right over a gauge from a 60-digit solution, 460.6030 microstrain. A line's
// largest patch is that at the node of the gauge, and two units of load make the reading of its value / 2^15.
TEST(TableBuilder, TheLoadScaleTurnsFittedLoadsIntoLineLoads) {
  config_.contact.width_m = 0;
  const TableImage image = buildTableImage(config_);
  const firmware::AngleNode node = firmware::angleNode(image.constants, 0);
  const long double response =
      firmware::responseOf(image.patch(node.node, 0).normal, 0, node.t_q15).value_q30 / -power2(30);
  const long double strainPerUnit = power2(-33) * response;
  const long double load = strainPerUnit / 460.6030e-6L * power2(12);
  checkClose(load, image.constants.load_scale * power2(image.constants.load_exponent), 2e-5);
  CHECK(image.constants.load_scale >= 1 << 30);
}

TEST(TableBuilder, GaugesAreWhereTheConfigSays) {
  for (const double degrees : {0.0, 22.5, 90.0, 180.0, 359.0, 359.9999999999}) {
    config_.gauges.first_angle_deg = degrees;
    const GaugeAngles angles_q32 = buildTableImage(config_).gauge_angle_q32;
    for (int i = 0; i < 16; ++i) checkAngle(degrees + 22.5 * i, angles_q32[static_cast<std::size_t>(i)]);
    LONGS_EQUAL(0, angles_q32[16]);
  }
}

TEST(TableBuilder, GaugesOfARingThatIsNotEvenAreWhereTheyWereGluedAndCalibrated) {
  config_.gauges.angles_deg = {1, 22, 46, 68, 90, 112, 134, 158, 180, 202, 224, 248, 270, 292, 314, 338};
  config_.calibration.angle_offset_deg.assign(16, 0.25);
  config_.calibration.angle_offset_deg[0] = -1.5;
  const GaugeAngles angles_q32 = buildTableImage(config_).gauge_angle_q32;
  checkAngle(359.5, angles_q32[0]);
  checkAngle(46.25, angles_q32[2]);
  checkTaken();
}

// 4.5 of 16 pitches; 3.5 of 12, for seven gauges.
TEST(TableBuilder, SevenGaugesOrMoreAreInReachWhereverAContactIs) {
  for (const auto& [count, reach_deg] : {std::pair{12, 105.0}, {14, 101.25}, {16, 101.25}, {32, 101.25}}) {
    config_.gauges.count = count;
    DOUBLES_EQUAL(reach_deg, constants().reach_q32 * (360 / 0x1p32), 1e-6);
  }
  config_.gauges = {};
  config_.gauges.count = 12;
  config_.gauges.angles_deg = {0, 50, 100, 150, 200, 220, 240, 260, 280, 300, 320, 340};
  DOUBLES_EQUAL((4 * 50 + 3 * 20) / 2.0, constants().reach_q32 * (360 / 0x1p32), 1e-6);
}

TEST(TableBuilder, WidthsAreFittedUnlessTheyAreKnown) {
  LONGS_EQUAL(0, constants().width_is_known);
  LONGS_EQUAL(64'000'000 / 12, constants().largest_moment_um2);
  config_.contact.width_m = 3e-3;
  LONGS_EQUAL(1, constants().width_is_known);
  LONGS_EQUAL(9'000'000 / 12, constants().largest_moment_um2);
  LONGS_EQUAL(1 << kMomentBits, constants().known_moment_q20);
  config_.contact.width_m = 0;
  LONGS_EQUAL(1, constants().width_is_known);
  LONGS_EQUAL(0, constants().known_moment_q20);
}

TEST(TableBuilder, ACellsRateIsTwoOverItsWidth) {
  for (const bool known : {false, true}) {
    if (known) config_.contact.width_m = 3e-3;
    const TableConstants c = constants();
    for (std::size_t k = 0; k < c.cell_count; ++k)
      checkClose(2 / ((c.cell_edge_q15[k + 1] - c.cell_edge_q15[k]) * power2(-15)),
                 c.cell_rate_q8[k] * power2(-8), 5e-4);
  }
}

TEST(TableBuilder, TheModelErrorIsAFractionOfTheReading) {
  LONGS_EQUAL(3277, constants().model_error_q16);
  config_.gauges.model_error = 0;
  LONGS_EQUAL(0, constants().model_error_q16);
  config_.gauges.model_error = 1;
  LONGS_EQUAL(65535, constants().model_error_q16);
}

TEST(TableBuilder, ThereIsNoErrorOfCalibrationWhereNoneIsTold) {
  config_.gauges.model_error = 0;
  LONGS_EQUAL(0, constants().place_error_q32);
  LONGS_EQUAL(0, constants().load_error_q16);
  LONGS_EQUAL(0, constants().moment_error_q16);
}

// 25 um of the circumference of 79.8 mm; 0.02 mm^2 of 64 / 12.
TEST(TableBuilder, WhatCalibrationLeavesIsATurnAndFractions) {
  config_.gauges.model_error = 0;
  config_.calibration.place_error_m = 25e-6;
  config_.calibration.load_error = 0.006;
  config_.calibration.moment_error_m2 = 2e-8;
  const TableConstants c = constants();
  checkClose(25e-6 / (2 * 3.141592653589793 * 12.7e-3), c.place_error_q32 * power2(-32), 1e-6);
  LONGS_EQUAL(393, c.load_error_q16);
  LONGS_EQUAL(246, c.moment_error_q16);
  config_.calibration.place_error_m = config_.calibration.load_error = 1;
  config_.calibration.moment_error_m2 = 1;
  LONGS_EQUAL(kMostPlaceError_q32, constants().place_error_q32);
  LONGS_EQUAL(65535, constants().load_error_q16);
  LONGS_EQUAL(65535, constants().moment_error_q16);
}

// 0.3 of 5 % of 3.3 mm; 25 um of a calibration are another, independent error.
TEST(TableBuilder, PlacesAreOffByWhatTheModelErrorMakesOfThem) {
  const double circumference_m = 2 * 3.141592653589793 * 12.7e-3;
  checkClose(49.5e-6 / circumference_m, constants().place_error_q32 * power2(-32), 1e-6);
  config_.calibration.place_error_m = 25e-6;
  checkClose(std::hypot(49.5e-6, 25e-6) / circumference_m, constants().place_error_q32 * power2(-32), 1e-6);
}

// The error that calibrations leave is a quarter of the second moment of 1 mm.
TEST(TableBuilder, AnErrorOfMomentsIsHeldForNarrowContacts) {
  config_.contact.largest_width_m = 1e-3;
  config_.gauges.model_error = 0;
  config_.calibration.moment_error_m2 = 2e-8;
  checkClose(2e-8 * 12 / 1e-6, constants().moment_error_q16 * power2(-16), 1e-3);
}

// Half of 5 % of 3.3 mm squared; 0.2 mm^2 of a calibration are another, independent error.
TEST(TableBuilder, WidthsAreOffByWhatTheModelErrorMakesOfThem) {
  const double largest_m2 = std::pow(config_.contact.largest_width_m, 2) / 12;
  checkClose(2.7225e-7 / largest_m2, constants().moment_error_q16 * power2(-16), 1e-3);
  config_.calibration.moment_error_m2 = 2e-7;
  checkClose(std::hypot(2.7225e-7, 2e-7) / largest_m2, constants().moment_error_q16 * power2(-16), 1e-3);
}

// A Poisson's ratio that nobody measured: a fifth of the load at the default 5 %.
TEST(TableBuilder, TheScaleOfLoadsIsOffByFourTimesTheModelError) {
  LONGS_EQUAL(13107, constants().load_scale_error_q16);
  config_.gauges.model_error = 0;
  LONGS_EQUAL(0, constants().load_scale_error_q16);
  config_.gauges.model_error = 0.5;
  LONGS_EQUAL(65535, constants().load_scale_error_q16);
}

// Whatever the converter's step: 26 mV of 3.3 V.
TEST(TableBuilder, TheRailIsA128thOfTheRangeFromItsEnd) {
  for (const int bits : {8, 12, 16}) {
    config_.gauges.adc_bits = bits;
    LONGS_EQUAL(65536 - 65536 / 128, constants().adc_rail);
  }
}

// A code's whole span, 2^16 steps, is two full scales.
TEST(TableBuilder, TheReadingGainTurnsCodesIntoStrains) {
  for (const double fullScale : {2e-4, 0.03, 0.06}) {
    config_.gauges.full_scale_strain = fullScale;
    config_.gauges.noise_strain = 1e-9;
    const long double perCode = power2(15) * constants().reading_gain * power2(-32);
    checkClose(2 * fullScale * power2(32) / 65536, perCode, 0.5 / (fullScale * 0x1p34));
  }
}

TEST(TableBuilder, TheForceScaleIsTheLengthOfTheContact) {
  for (const double length : {1e-4, 0.02, 1.0}) {
    config_.finger.length_m = length;
    DOUBLES_EQUAL(length * 65536000, constants().force_per_load_q16, 0.5);
  }
}

TEST(TableBuilder, TheConeHasRoomForNoise) {
  const std::vector<std::pair<double, int>> cones{{0, 26}, {0.05, 26}, {0.5, 160}, {1, 320}, {10, 3200}};
  for (const auto& [friction, cone] : cones) {
    config_.contact.friction_coefficient = friction;
    LONGS_EQUAL(cone, constants().cone_q8);
    LONGS_EQUAL(std::lround(friction * 256), constants().friction_q8);
  }
}

TEST(TableBuilder, SignsFollowTheComponent) {
  const std::vector<std::pair<StrainComponent, std::pair<int, int>>> signs{
      {StrainComponent::kRadial, {1, -1}},
      {StrainComponent::kHoop, {1, 1}},
      {StrainComponent::kShear, {-1, 1}}};
  for (const auto& [component, expected] : signs) {
    config_.gauges.component = component;
    LONGS_EQUAL(expected.first, constants().mirror_sign);
    LONGS_EQUAL(expected.second, constants().peak_sign);
  }
}

TEST(TableBuilder, NoiseBelowTheStepOfStrainIsRefused) {
  config_.gauges.noise_strain = 2e-10;
  checkRefusal(
      "gauges.noise_strain = 2e-10 is below the firmware's step of strain; it must be at least 2.33e-10");
}

TEST(TableBuilder, LoadsThatTheFormatCannotHoldAreRefused) {
  config_.finger.shear_modulus_pa = 1e9;
  checkRefusal("gauges.full_scale_strain = 0.03 is a load of 7.66e+05 N/m on this finger");
  config_.finger.shear_modulus_pa = 100;
  checkRefusal(
      "from 0.25 to 5.24e+05 N/m: change it, finger.shear_modulus_pa or "
      "gauges.radius_m");
}

TEST(TableBuilder, LoadsUpToBothEndsOfTheFormatAreTaken) {
  for (const double modulus : {400.0, 6.6e8}) {
    config_.finger.shear_modulus_pa = modulus;
    checkTaken();
  }
}

TEST(TableBuilder, GaugesOnTheCoreThatFeelNothingAreRefused) {
  config_.gauges.radius_m = config_.finger.core_radius_m;
  checkRefusal("gauges.radius_m = 0.0089 is on the core, where the rubber has no radial strain");
  config_.finger.poisson_ratio = 0.4;
  checkTaken();
  config_.gauges.component = StrainComponent::kHoop;
  checkRefusal("gauges.radius_m = 0.0089 is on the core, where the rubber has no hoop strain");
  config_.gauges.component = StrainComponent::kShear;
  checkTaken();
}

TEST(TableBuilder, GaugesTooNearTheSurfaceAreRefused) {
  config_.gauges.radius_m = 0.0127 * (1 - 1e-6);
  checkRefusal("too close to the surface");
}

TEST(TableBuilder, EveryRingComponentAndPlaceGivesAWholeImage) {
  for (const StrainComponent component :
       {StrainComponent::kRadial, StrainComponent::kHoop, StrainComponent::kShear}) {
    for (const int count : {12, 18, 32}) {
      for (const double radius : {9e-3, 10e-3, 11e-3}) {
        config_.gauges.component = component;
        config_.gauges.count = count;
        config_.gauges.radius_m = radius;
        checkTaken();
      }
    }
  }
}

TEST(TableBuilder, TablesTooCoarseForThinRubberAreRefusedWithWhatToChange) {
  config_.gauges.radius_m = 11.5e-3;
  config_.gauges.model_error = 0;
  checkRefusal(
      "gauges.radius_m = 0.0115 is so near the surface at finger.outer_radius_m = 0.0127 that the tables are "
      "off by "
      "0.0064 of a reading, with contact.width_m unknown up to contact.largest_width_m = 0.008; noise and "
      "gauges.model_error = 0 leave ");
  checkRefusal(
      ": move the gauges inwards, cover less width or say what it is, or admit a larger gauges.model_error");
  config_.gauges.model_error = 0.01;
  checkTaken();
  config_.gauges.model_error = 0;
  config_.contact.width_m = 0;
  checkTaken();
}

TEST(TableBuilder, KnownWidthsThatTheTablesAreTooCoarseForAreRefused) {
  config_.gauges.radius_m = 12.3e-3;
  config_.gauges.model_error = 0;
  config_.contact.width_m = 4e-3;
  checkRefusal("0.0038 of a reading, with contact.width_m = 0.004; noise and");
  checkRefusal(": move the gauges inwards, take contacts for narrower ones, or admit");
}

// Noise at half of full scale is 3 % of a reading there.
TEST(TableBuilder, TablesMayBeAsCoarseAsReadingsAreNoisy) {
  config_.gauges.radius_m = 11.5e-3;
  config_.gauges.model_error = 0;
  config_.gauges.noise_strain = 4.5e-4;
  checkTaken();
}

TEST(TableBuilder, WidthsThatTheFirmwareCannotTellAreRefused) {
  config_.contact.largest_width_m = 5e-5;
  checkRefusal(
      "contact.largest_width_m = 5e-05: the firmware fits widths when it is from 0.0001 to 0.065; change it, "
      "or say how wide contacts are in contact.width_m");
  config_.contact.width_m = 1e-5;
  checkTaken();
  config_.finger = {0.06, 0.1, 0.1, 8.3e4, 0.5};
  config_.gauges.radius_m = 0.07;
  config_.contact = {1, {}, 0.07};
  checkRefusal("contact.largest_width_m = 0.07");
  config_.contact.largest_width_m = 0.065;
  checkTaken();
}
