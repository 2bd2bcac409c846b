#include "host/config/read_config.hpp"

#include <unistd.h>

#include <cstdio>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "host/config/keys.hpp"
#include "host/config/write_config.hpp"
#include "tests/host/config/ConfigTest.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::config;

namespace {

/// The domain of each key as the interface document states it, independent of the table of keys: values that
/// must be accepted (both ends among them, where
/// other keys' defaults let them be reached), and values that must not.
struct DomainCase {
  std::string key;
  std::vector<std::string> inside;
  std::vector<std::string> outside;
};

/// A list for the default ring: fifteen times `others`, then `last`.
std::string fifteenAnd(const std::string& others, const std::string& last) {
  std::string list = "[";
  for (int i = 1; i < 16; ++i) list += others + ", ";
  return list + last + "]";
}

std::string gains(const std::string& last) { return fifteenAnd("1.0", last); }

/// The default ring, its last gauge elsewhere.
std::string angles(const std::string& last) {
  std::string list = "[";
  for (int i = 0; i < 15; ++i) list += fmt::format("{}, ", 22.5 * i);
  return list + last + "]";
}

const std::vector<DomainCase>& domainCases() {
  static const std::vector<DomainCase> cases = {
      {"finger.core_radius_m", {"1e-300", "0.0094"}, {"0", "-1e-3", "1.1", "8.9"}},
      {"finger.outer_radius_m", {"0.0095", "1"}, {"0", "-1", "1.1", "12.7"}},
      {"finger.length_m", {"1e-9", "1"}, {"0", "-0.02", "20"}},
      {"finger.shear_modulus_pa", {"1e-9", "1e12"}, {"0", "-1", "1.1e12"}},
      {"finger.poisson_ratio", {"0", "0.0", "0.5"}, {"-1e-9", "0.5000001", "1"}},
      {"gauges.count",
       {"12", "14", "32"},
       {"0", "-16", "10", "11", "13", "31", "33", "34", "9223372036854775807"}},
      {"gauges.radius_m", {"8.9e-3", "0.0126"}, {"0", "-1", "1.1"}},
      {"gauges.component", {"\"radial\"", "\"hoop\"", "\"shear\""}, {"\"\"", "\"Radial\"", "\"err\""}},
      {"gauges.first_angle_deg", {"0", "359.999"}, {"-0.001", "360", "1e9"}},
      {"gauges.arc_length_m", {"0", "3.69e-3"}, {"-1e-9", "1.1"}},
      {"gauges.noise_strain", {"4.3e-6", "0.1"}, {"0", "-6e-6", "0.11"}},
      {"gauges.full_scale_strain", {"1e-12", "0.0425"}, {"0", "-0.03", "0.0601"}},
      {"gauges.adc_bits", {"12", "16"}, {"7", "17", "-12", "4294967304"}},
      {"gauges.model_error", {"0", "1", "0.003"}, {"-0.001", "1.001"}},
      {"gauges.angle_deg", {"[]", angles("337.5"), angles("326.25"), angles("348.75")}, {}},
      {"contact.friction_coefficient", {"0", "10"}, {"-0.001", "10.1"}},
      {"contact.width_m", {"0", "0.008"}, {"-1e-3", "1.1"}},
      {"contact.largest_width_m", {"1e-9", "0.0127"}, {"0", "-1e-3", "1.1"}},
      {"can.node", {"1", "63"}, {"0", "64", "-1", "4294967297"}},
      {"can.bitrate", {"250000", "500000", "1000000"}, {"0", "999999", "125", "-1000000"}},
      {"can.contact_rate_hz", {"20", "1000", "333.3"}, {"19.99", "1001", "0", "-500"}},
      {"calibration.gain", {"[]", gains("0.5"), gains("2"), gains("1")}, {}},
      {"calibration.angle_offset_deg", {"[]", fifteenAnd("0", "-2.5"), fifteenAnd("0", "2.5")}, {}},
      {"calibration.depth_offset_m", {"[]", fifteenAnd("0", "-0.0032"), fifteenAnd("0", "0.0005")}, {}},
      {"calibration.place_error_m", {"0", "2.5e-5", "1"}, {"-1e-6", "1.1"}},
      {"calibration.load_error", {"0", "0.006", "1"}, {"-0.001", "1.1"}},
      {"calibration.moment_error_m2", {"0", "2e-8", "1"}, {"-1e-9", "1.1"}},
      {"tolerance.angle_deg", {"1e-6", "2.5"}, {"0", "2.51"}},
      {"tolerance.depth_m", {"1e-9", "1"}, {"0", "1.1"}},
      {"tolerance.gain", {"1e-6", "0.5"}, {"0", "0.51"}},
      {"tolerance.zero_strain", {"1e-9", "0.1"}, {"0", "0.11"}},
      {"tolerance.core_radius_m", {"1e-9", "1"}, {"0", "1.1"}},
      {"tolerance.poisson_ratio", {"1e-6", "0.5"}, {"0", "0.51"}},
      {"tolerance.shear_modulus", {"1e-6", "1"}, {"0", "1.1"}},
      {"as_built.seed", {"0", "2147483647"}, {"-1", "2147483648"}},
      {"as_built.angle_deg", {"0", "2.5"}, {"-0.1", "2.51"}},
      {"as_built.depth_m", {"0", "1"}, {"-1e-6", "1.1"}},
      {"as_built.gain", {"0", "0.2"}, {"-0.01", "0.21"}},
      {"as_built.core_radius_m", {"-0.0088", "0.0005"}, {"-1.1", "1.1"}},
      {"as_built.poisson_ratio", {"0", "-0.5"}, {"0.51", "-0.51"}},
      {"as_built.shear_modulus_pa", {"-82999", "1e12"}, {"1.1e12", "-1.1e12"}},
  };
  return cases;
}

double numberOf(const std::vector<double>& values) { return values.empty() ? 0 : values.back(); }
double numberOf(const std::optional<double>& value) { return value.value_or(-1); }
template <typename Value>
double numberOf(Value value) {
  return static_cast<double>(value);
}

double number(const FingerConfig& config, const Key& key) {
  FingerConfig copy = config;
  return std::visit([&](auto slot) { return numberOf(slot(copy)); }, key.slot);
}

}  // namespace

TEST_GROUP(ReadConfig) {
  void checkComplaint(const std::string& text, const std::string& expected) {
    STRCMP_EQUAL(expected.c_str(), complaintAbout(text).c_str());
  }
  void checkMention(const std::string& text, const std::string& part) {
    STRCMP_CONTAINS(part.c_str(), complaintAbout(text).c_str());
  }
};

// The parser calls itself for each part of a key, until the stack ends.
TEST(ReadConfig, AKeyOfManyPartsIsRefusedBeforeItIsParsed) {
  std::string parts = "a", quoted = "','";
  for (int i = 0; i < 100'000; ++i) {
    parts += ".a";
    quoted += ".','";
  }
  const std::string why = "more than 64 dots in one key or text; a key has one or none, as in gauges.count";
  checkComplaint("schema = 1\n" + parts + " = 1\n", "f.toml:2:130: " + why);
  checkComplaint("schema = 1\n\n[" + parts + "]", "f.toml:3:131: " + why);
  checkComplaint("[[" + parts + "]]\r\n", "f.toml:1:132: " + why);
  checkComplaint("x = {" + quoted + " = 1}", "f.toml:1:265: " + why);
}

/// As many values in values as the parser takes, each with as long a key as is let through, on lines of their
/// own.
TEST(ReadConfig, LongKeysInOneAnotherAreSurvived) {
  std::string key = "a", text;
  for (int i = 0; i < 64; ++i) key += ".a";
  for (int i = 0; i < 240; ++i) text += key + " = {x = \"\"\"\n\"\"\", ";
  text += "b = 1" + std::string(240, '}');
  checkMention(text, "f.toml:");
}

TEST(ReadConfig, DotsOfNumbersAndCommentsAreMany) {
  std::string list = "[0.5";
  for (int i = 1; i < 200; ++i) list += ", 0.5";
  checkMention("schema = 1  # " + std::string(1000, '.') + "\n[calibration]\ngain = " + list + "]\n",
               "calibration.gain");
}

TEST(ReadConfig, SchemaAloneGivesTheDefaultFinger) {
  const FingerConfig read = readConfig("schema = 1", "f.toml");
  STRCMP_EQUAL(writeConfig(FingerConfig{}).c_str(), writeConfig(read).c_str());
}

TEST(ReadConfig, EveryKeyHasACaseInThisTest) {
  LONGS_EQUAL(keys().size(), domainCases().size());
  for (std::size_t i = 0; i < keys().size(); ++i)
    STRCMP_EQUAL(domainCases()[i].key.c_str(), keys()[i].dotted().c_str());
}

TEST(ReadConfig, ValuesInTheDomainUpToItsEndsAreAccepted) {
  for (const DomainCase& c : domainCases())
    for (const std::string& value : c.inside) checkComplaint(settingOf(c.key, value), "accepted");
}

TEST(ReadConfig, ValuesOutOfTheDomainNameTheKeyItsPlaceAndTheDomain) {
  for (const DomainCase& c : domainCases())
    for (const std::string& value : c.outside) {
      const std::string text = complaintAbout(settingOf(c.key, value));
      const auto column = c.key.size() - c.key.find('.') + 3;
      STRCMP_CONTAINS(fmt::format("f.toml:3:{}: {} = ", column, c.key).c_str(), text.c_str());
      STRCMP_CONTAINS(" is out of its domain; it must be ", text.c_str());
    }
}

TEST(ReadConfig, NotANumberAndTheInfinitiesAreInNoDomain) {
  for (const Key& key : keys()) {
    if (!std::holds_alternative<double& (*)(FingerConfig&)>(key.slot)) continue;
    for (const char* value : {"nan", "inf", "-inf"})
      checkMention(settingOf(key.dotted(), value), key.dotted() + " = " + (value[0] == 'n' ? "nan" : value));
  }
}

TEST(ReadConfig, ValuesOfAnotherTypeNameTheKeyAndBothTypes) {
  for (const Key& key : keys()) {
    checkMention(settingOf(key.dotted(), "true"), key.dotted() + " is a boolean; it must be ");
    if (!std::holds_alternative<std::vector<double>& (*)(FingerConfig&)>(key.slot))
      checkMention(settingOf(key.dotted(), "[1]"), key.dotted() + " is a list; it must be ");
    checkMention(settingOf(key.dotted(), "1979-05-27"), key.dotted() + " is a date or time; it must be ");
    checkMention(settingOf(key.dotted(), "{a = 1}"), key.dotted() + " is a section; it must be ");
    if (key.name != "component") checkMention(settingOf(key.dotted(), "\"1\""), " is a text; it must be ");
  }
}

TEST(ReadConfig, AnIntegerIsTakenForARealNumberNotTheReverse) {
  DOUBLES_EQUAL(45, readConfig(settingOf("gauges.first_angle_deg", "45"), "f").gauges.first_angle_deg, 0);
  checkComplaint(settingOf("gauges.count", "16.0"),
                 "f.toml:3:9: gauges.count is a real number; it must be an integer: even, 12 to 32");
  checkMention(settingOf("gauges.component", "0"),
               "gauges.component is an integer; it must be a text in quotes");
}

TEST(ReadConfig, EachKeySetsItsOwnMemberAndNoOther) {
  for (std::size_t i = 0; i < keys().size(); ++i) {
    const std::string& value = domainCases()[i].inside.back();
    const FingerConfig read = readConfig(settingOf(keys()[i].dotted(), value), "f");
    for (std::size_t j = 0; j < keys().size(); ++j) {
      const double expected = i != j            ? number({}, keys()[j])
                              : value[0] == '"' ? 2
                              : value[0] == '[' ? std::stod(value.substr(value.rfind(' ')))
                                                : std::stod(value);
      DOUBLES_EQUAL(expected, number(read, keys()[j]), 0);
    }
  }
}

TEST(ReadConfig, UnknownKeysAreNamedWithWhatWasProbablyMeant) {
  checkComplaint(settingOf("gauges.counts", "16"),
                 "f.toml:3:1: unknown key gauges.counts; did you mean gauges.count?");
  checkComplaint(settingOf("finger.poison_ratio", "0.5"),
                 "f.toml:3:1: unknown key finger.poison_ratio; did you mean finger.poisson_ratio?");
  checkMention(settingOf("contact.friction_coefficien", "1"), "did you mean contact.friction_coefficient?");
  checkMention(settingOf("contact.friction__coefficient", "1"), "did you mean contact.friction_coefficient?");
  checkMention(settingOf("can.zzz", "1"), "unknown key can.zzz; known here: can.node, can.bitrate, ");
}

TEST(ReadConfig, AKeyInTheWrongSectionIsSentToTheRightOne) {
  checkMention(settingOf("finger.adc_bits", "12"), "did you mean gauges.adc_bits?");
  checkComplaint("schema = 1\nbitrate = 1", "f.toml:2:1: unknown key bitrate; did you mean can.bitrate?");
}

TEST(ReadConfig, UnknownSectionsAreNamedWithWhatWasProbablyMeant) {
  checkMention("schema = 1\n[guages]\ncount = 16", "unknown key guages; did you mean gauges?");
  checkMention("schema = 1\n[zzzzzzzz]",
               "unknown key zzzzzzzz; known here: schema, finger, gauges, contact, can, calibration, "
               "tolerance, as_built, "
               "recording");
}

TEST(ReadConfig, ASectionThatIsAValueIsAnError) {
  checkComplaint("schema = 1\nfinger = 3",
                 "f.toml:2:10: finger is an integer; it must be a section: [finger]");
  checkMention("schema = 1\n[[gauges]]", "gauges is a list; it must be a section: [gauges]");
}

TEST(ReadConfig, SchemaMustBeThereAndRight) {
  checkMention("", "f.toml:1:1: schema is missing; the file must begin with schema = 1");
  checkMention("[finger]\n", "schema is missing");
  checkComplaint("schema = 2", "f.toml:1:10: schema = 2 is out of its domain; it must be one of 1");
  checkMention("schema = \"1\"", "schema is a text; it must be an integer: one of 1");
}

TEST(ReadConfig, SyntaxErrorsPointAtTheirPlace) {
  checkMention("schema = 1\n[finger\n", "f.toml:2:8: ");
  checkMention("schema = 1\ncan.node = 1\ncan.node = 2\n", "f.toml:3:");
  checkMention(std::string("schema = 1\n\0", 12), "f.toml:2:1: ");
  checkMention("schema = 1 # \xff\xfe", "f.toml:1:");
}

TEST(ReadConfig, ConditionsBetweenKeysNameThemAllAndPointIntoTheFile) {
  checkComplaint(
      settingOf("finger.core_radius_m", "0.0127"),
      "f.toml:3:17: finger.core_radius_m = 0.0127 must be less than finger.outer_radius_m = 0.0127");
  checkComplaint(settingOf("gauges.radius_m", "0.0127"),
                 "f.toml:3:12: gauges.radius_m = 0.0127 is outside the rubber: it must be at least "
                 "finger.core_radius_m = 0.0089, less than finger.outer_radius_m = 0.0127");
  checkMention(settingOf("gauges.radius_m", "8.8999e-3"), "is outside the rubber");
  checkMention(settingOf("finger.outer_radius_m", "0.0094"),
               "f.toml:3:18: gauges.radius_m = 0.0094 is outside");
  checkMention(settingOf("gauges.arc_length_m", "3.7e-3"), "gauges.count = 16");
  checkMention(settingOf("contact.width_m", "0.0128"), "must be at most contact.largest_width_m = 0.008");
  checkMention(settingOf("contact.largest_width_m", "0.0128"),
               "must be at most finger.outer_radius_m = 0.0127");
  checkComplaint(settingOf("contact.width_m", "0.0127") + "largest_width_m = 0.0127", "accepted");
  checkMention(settingOf("can.bitrate", "125000"),
               "f.toml:3:11: can.contact_rate_hz = 500 needs up to 202500");
}

// Of 12 bits over +-0.03: 0.06 / 2^12 / sqrt(12) = 4.2286e-6.
TEST(ReadConfig, NoiseIsAtLeastThatOfTheConverter) {
  checkComplaint(
      settingOf("gauges.noise_strain", "4.228e-6"),
      "f.toml:3:16: gauges.noise_strain = 4.228e-06 is less than the quantisation alone, 4.23e-06, "
      "that gauges.adc_bits = 12 over +-gauges.full_scale_strain = 0.03 leaves; use more bits, a "
      "smaller full scale or more noise");
  checkComplaint(settingOf("gauges.noise_strain", "4.229e-6"), "accepted");
  checkMention(settingOf("gauges.adc_bits", "8"), "f.toml:3:12: gauges.noise_strain = 6e-06 is less");
  checkMention(settingOf("gauges.full_scale_strain", "0.06"),
               "f.toml:3:21: gauges.noise_strain = 6e-06 is less");
}

TEST(ReadConfig, CoarseConvertersAndLargeFullScalesGoWithMoreNoise) {
  checkComplaint(settingOf("gauges.adc_bits", "8") + "\nnoise_strain = 7e-5", "accepted");
  checkComplaint(settingOf("gauges.full_scale_strain", "0.06") + "\nnoise_strain = 2e-5", "accepted");
}

TEST(ReadConfig, ADefaultThatARelationBreaksIsSaidToBeOne) {
  checkMention(
      "schema = 1\n[finger]\ncore_radius_m = 1e-3\nouter_radius_m = 3e-3\n[gauges]\nradius_m = 2e-3\n",
      "(contact.largest_width_m is not in the file, this is its default)");
  const std::string both = "schema = 1\n[contact]\nlargest_width_m = 0.1\n";
  checkMention(both, "contact.largest_width_m = 0.1 must be at most");
  try {
    readConfig(both, "f.toml");
  } catch (const Failure& failure) {
    CHECK(std::string_view(failure.what()).find("default") == std::string_view::npos);
  }
}

TEST(ReadConfig, AGainOutOfItsDomainIsNamedWithItsPlace) {
  for (const char* gain : {"0.499", "2.001", "0", "-1", "nan", "inf"})
    checkMention(settingOf("calibration.gain", gains(gain)),
                 std::string("f.toml:3:84: calibration.gain[15] = ") + gain);
  checkMention(settingOf("calibration.gain", gains("0.4")),
               "calibration.gain[15] = 0.4 is out of its domain; it must be 0.5 to 2");
  checkMention(settingOf("calibration.gain", gains("\"1\"")),
               "calibration.gain[15] is a text; it must be a real");
  checkMention(settingOf("calibration.gain", "1.0"),
               "is a real number; it must be a list of real numbers, each 0.5");
}

TEST(ReadConfig, ThereIsAGainForEveryGaugeOrNone) {
  checkComplaint(settingOf("calibration.gain", "[1, 1]"),
                 "f.toml:3:8: calibration.gain has 2 numbers; it must have one a gauge, gauges.count = 16");
  checkMention("schema = 1\ngauges.count = 18\ncalibration.gain = " + gains("1"), "has 16 numbers");
}

TEST(ReadConfig, AWidthThatIsLeftOutIsUnknownNotALine) {
  CHECK_FALSE(readConfig("schema = 1", "f.toml").contact.width_m.has_value());
  DOUBLES_EQUAL(0, *readConfig(settingOf("contact.width_m", "0"), "f.toml").contact.width_m, 0);
}

TEST(ReadConfig, AnglesThatAreListedArePlacesOfTheGauges) {
  const Gauges gauges = readConfig(settingOf("gauges.angle_deg", angles("330")), "f.toml").gauges;
  DOUBLES_EQUAL(22.5, gauges.angle_deg(1), 0);
  DOUBLES_EQUAL(330, gauges.angle_deg(15), 0);
  DOUBLES_EQUAL(330 * std::numbers::pi / 180, gauges.angle_rad(15), 1e-15);
  DOUBLES_EQUAL(15, gauges.gap_deg(14), 1e-12);
  DOUBLES_EQUAL(30, gauges.gap_deg(15), 1e-12);
}

TEST(ReadConfig, AnglesMayBeginAnywhereOnTheRing) {
  std::string list = "[348.75, ";
  for (int i = 0; i < 14; ++i) list += fmt::format("{}, ", 11.25 + 22.5 * i);
  checkComplaint(settingOf("gauges.angle_deg", list + "326.25]"), "accepted");
}

TEST(ReadConfig, AnglesThatAreNoRingAreNamed) {
  checkComplaint(settingOf("gauges.angle_deg", "[0, 90]"),
                 "f.toml:3:13: gauges.angle_deg has 2 numbers; it must have one a gauge, gauges.count = 16");
  for (const char* last : {"300", "315", "326.24", "348.76", "0"})
    checkMention(settingOf("gauges.angle_deg", angles(last)),
                 fmt::format(", 315, {}] is no ring: the angles must ascend, once round, each 11.25 to 45 "
                             "from the one before (gauges.count = 16)",
                             last));
  std::string clockwise = "[0";
  for (int i = 15; i > 0; --i) clockwise += fmt::format(", {}", 22.5 * i);
  checkMention(settingOf("gauges.angle_deg", clockwise + "]"), "; from gauge 0 to gauge 1, from ");
  checkMention(settingOf("gauges.angle_deg", angles("360")),
               "gauges.angle_deg[15] = 360 is out of its domain");
}

TEST(ReadConfig, AnglesThatGoRoundTwiceAreNoRing) {
  std::string twice = "[0";
  for (int i = 1; i < 16; ++i) twice += fmt::format(", {}", i * 45 % 360);
  checkMention(settingOf("gauges.angle_deg", twice + "]"), "; they go round more than once");
}

TEST(ReadConfig, AnglesAreSaidInOneWay) {
  checkMention(
      settingOf("gauges.first_angle_deg", "5") + "angle_deg = " + angles("337.5"),
      "f.toml:3:19: gauges.first_angle_deg = 5: gauges.angle_deg says where each gauge is; leave one");
}

TEST(ReadConfig, LongGaugesKeepApartWhereTheyAreNearest) {
  const std::string near = "angle_deg = " + angles("326.25");
  checkMention(settingOf("gauges.arc_length_m", "1.85e-3") + near, "neighbours overlap");
  checkComplaint(settingOf("gauges.arc_length_m", "1.84e-3") + near, "accepted");
}

TEST(ReadConfig, OffsetsOfCalibrationPlaceTheGauges) {
  const FingerConfig read =
      readConfig("schema = 1\ncalibration.angle_offset_deg = " + fifteenAnd("0", "-1.5") +
                     "\ncalibration.depth_offset_m = " + fifteenAnd("0", "1e-4") +
                     "\ncalibration.gain = " + gains("1.25"),
                 "f.toml");
  const model::PlacedGauge found = read.calibrated(15), other = read.calibrated(0);
  DOUBLES_EQUAL(336 * std::numbers::pi / 180, found.angle_rad, 1e-14);
  DOUBLES_EQUAL(9.3e-3, found.radius_m, 1e-17);
  DOUBLES_EQUAL(1.25, found.gain, 0);
  DOUBLES_EQUAL(read.drawn(0).angle_rad, other.angle_rad, 0);
  DOUBLES_EQUAL(read.drawn(0).radius_m, other.radius_m, 0);
  CHECK_FALSE(read.calibration.isEmpty());
}

TEST(ReadConfig, OffsetsOutOfTheirDomainAreNamedWithTheirPlace) {
  checkMention(settingOf("calibration.angle_offset_deg", fifteenAnd("0", "2.6")),
               "calibration.angle_offset_deg[15] = 2.6 is out of its domain; it must be -2.5 to 2.5");
  checkMention(settingOf("calibration.angle_offset_deg", "[0]"),
               "f.toml:3:20: calibration.angle_offset_deg has 1 numbers; it must have one a gauge");
  checkMention(settingOf("calibration.depth_offset_m", "[0]"),
               "calibration.depth_offset_m has 1 numbers; it must have one a gauge");
  for (const char* depth : {"0.00051", "-0.0033"})
    checkMention(settingOf("calibration.depth_offset_m", fifteenAnd("0", depth)),
                 fmt::format("calibration.depth_offset_m[15] = {} puts the gauge outside the rubber",
                             std::stod(depth)));
}

TEST(ReadConfig, AFingerAsBuiltIsAFingerThatCanBe) {
  for (const char* more_m : {"0.00051", "-0.0089"})
    checkMention(
        settingOf("as_built.core_radius_m", more_m),
        "with finger.core_radius_m = 0.0089 it must be greater than 0, at most gauges.radius_m = 0.0094");
  checkComplaint(
      settingOf("as_built.poisson_ratio", "0.01"),
      "f.toml:3:17: as_built.poisson_ratio = 0.01: with finger.poisson_ratio = 0.5 it must be 0 to "
      "0.5");
  checkMention("schema = 1\nfinger.poisson_ratio = 0.2\nas_built.poisson_ratio = -0.21", "must be 0 to 0.5");
  checkMention(settingOf("as_built.shear_modulus_pa", "-83000"),
               "with finger.shear_modulus_pa = 83000 it must");
}

TEST(ReadConfig, AnUnreadableFileIsNamedWithTheReason) {
  for (const auto& [path, reason] :
       {std::pair{"/nonexistent/f.toml", "No such file"}, {"/", "Is a directory"}}) {
    try {
      readConfigFile(path);
      FAIL("accepted");
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(ExitCode::kUsage), static_cast<int>(failure.code()));
      STRCMP_CONTAINS(path, failure.what());
      STRCMP_CONTAINS(reason, failure.what());
    }
  }
}

TEST(ReadConfig, AFileReadsLikeItsText) {
  const std::string path = fmt::format("{}/read_config_test.{}.toml", P_tmpdir, getpid());
  std::FILE* file = std::fopen(path.c_str(), "w");
  std::fputs(settingOf("can.node", "7").c_str(), file);
  std::fclose(file);
  LONGS_EQUAL(7, readConfigFile(path).can.node);
  std::remove(path.c_str());
}

TEST(ReadConfig, WhatRecordNotesBesideAConfigIsPassedOver) {
  LONGS_EQUAL(9, readConfig("schema = 1\n[can]\nnode = 9\n[recording]\nbus = \"can0\"\n"
                            "[[recording.finger]]\nnode = 5\n",
                            "x.toml")
                     .can.node);
}
