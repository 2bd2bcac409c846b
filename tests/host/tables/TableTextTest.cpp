#include "host/tables/table_text.hpp"

#include <fmt/format.h>

#include <string>

#include "host/base/failure.hpp"
#include "host/config/keys.hpp"
#include "host/tables/table_builder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::tables;

TEST_GROUP(TableText) {
  static constexpr std::size_t kLists = 3;  ///< angles, gains and depths
  const TableImage image_ = buildTableImage({});
};

TEST(TableText, ParametersAreNamedAndWrittenAsInTheConfig) {
  const auto parameters = parametersOf(image_);
  LONGS_EQUAL(23, parameters.size());
  for (const Parameter& parameter : parameters) {
    bool known = false;
    for (const config::Key& key : config::keys()) known = known || key.dotted() == parameter.key;
    CHECK_TEXT(known, parameter.key.c_str());
  }
  CHECK(parameters[5].value == Cell(std::int64_t{16}));
  CHECK(parameters[7].value == Cell(std::string("radial")));
  STRCMP_EQUAL("contact.width_m", parameters[18].key.c_str());
  CHECK_FALSE(parameters[18].value.has_value());  // not known
}

namespace {

/// A change of each key that tables depend on but for lists, and what is said of it.
struct Change {
  void (*apply)(config::FingerConfig&);
  const char* words;
};

const Change kChanges[] = {
    {[](config::FingerConfig& c) { c.finger.core_radius_m = 8.8e-3; },
     "finger.core_radius_m is 0.0089, the config has 0.0088"},
    {[](config::FingerConfig& c) { c.finger.outer_radius_m = 0.013; },
     "finger.outer_radius_m is 0.0127, the config has 0.013"},
    {[](config::FingerConfig& c) { c.finger.length_m = 0.03; },
     "finger.length_m is 0.02, the config has 0.03"},
    {[](config::FingerConfig& c) { c.finger.shear_modulus_pa = 9e4; },
     "finger.shear_modulus_pa is 83000, the config has 90000"},
    {[](config::FingerConfig& c) { c.finger.poisson_ratio = 0.49; },
     "finger.poisson_ratio is 0.5, the config has 0.49"},
    {[](config::FingerConfig& c) { c.gauges.count = 18; }, "gauges.count is 16, the config has 18"},
    {[](config::FingerConfig& c) { c.gauges.radius_m = 9.3e-3; },
     "gauges.radius_m is 0.0094, the config has 0.0093"},
    {[](config::FingerConfig& c) { c.gauges.component = StrainComponent::kShear; },
     "gauges.component is radial, the config has shear"},
    {[](config::FingerConfig& c) { c.gauges.first_angle_deg = 5; },
     "gauges.first_angle_deg is 0, the config has 5"},
    {[](config::FingerConfig& c) { c.gauges.arc_length_m = 1e-3; },
     "gauges.arc_length_m is 0, the config has 0.001"},
    {[](config::FingerConfig& c) { c.gauges.noise_strain = 7e-6; },
     "gauges.noise_strain is 6e-06, the config has 7e-06"},
    {[](config::FingerConfig& c) { c.gauges.full_scale_strain = 0.04; },
     "gauges.full_scale_strain is 0.03, the config has 0.04"},
    {[](config::FingerConfig& c) { c.gauges.adc_bits = 14; }, "gauges.adc_bits is 12, the config has 14"},
    {[](config::FingerConfig& c) { c.contact.friction_coefficient = 0.5; },
     "contact.friction_coefficient is 1, the config has 0.5"},
    {[](config::FingerConfig& c) { c.gauges.model_error = 0.02; },
     "gauges.model_error is 0.05, the config has 0.02"},
    {[](config::FingerConfig& c) { c.calibration.place_error_m = 2.5e-5; },
     "calibration.place_error_m is 0, the config has 2.5e-05"},
    {[](config::FingerConfig& c) { c.calibration.load_error = 0.006; },
     "calibration.load_error is 0, the config has 0.006"},
    {[](config::FingerConfig& c) { c.calibration.moment_error_m2 = 2e-8; },
     "calibration.moment_error_m2 is 0, the config has 2e-08"},
    {[](config::FingerConfig& c) { c.contact.width_m = 1e-3; },
     "contact.width_m is unknown, the config has 0.001"},
    {[](config::FingerConfig& c) { c.contact.largest_width_m = 6e-3; },
     "contact.largest_width_m is 0.008, the config has 0.006"},
};

std::string mismatch(const TableImage& image, const config::FingerConfig& config) {
  try {
    requireTablesOf(image, config, "f.bin");
    return "belongs";
  } catch (const Failure& failure) {
    return fmt::format("{}: {}", static_cast<int>(failure.code()), failure.what());
  }
}

}  // namespace

TEST(TableText, EveryParameterThatDiffersIsNamed) {
  LONGS_EQUAL(parametersOf(image_).size() - kLists, std::size(kChanges));
  for (const Change& change : kChanges) {
    config::FingerConfig other;
    change.apply(other);
    STRCMP_EQUAL(fmt::format("5: f.bin: made for another finger than the config's:\n  {}\nmake it anew with: "
                             "strainfinger tables -c CONFIG -o f.bin",
                             change.words)
                     .c_str(),
                 mismatch(image_, other).c_str());
  }
}

TEST(TableText, TablesWithOtherBytesDoNotBelong) {
  int changed = 0;
  for (const config::Key& key : config::keys()) {
    config::FingerConfig other;
    std::visit(
        [&](auto slot) {
          if constexpr (std::is_same_v<std::decay_t<decltype(slot(other))>, double>)
            slot(other) += slot(other) * 0.9 + 1e-3 * (slot(other) == 0);
        },
        key.slot);
    try {
      const bool isOther = buildTableImage(other).crc32 != image_.crc32;
      CHECK_EQUAL_TEXT(isOther, mismatch(image_, other) != "belongs", key.dotted().c_str());
      changed += isOther;
    } catch (const Failure&) {  // a relation between keys doesn't hold
    }
  }
  CHECK_TRUE(changed >= 10);
}

TEST(TableText, TolerancesThatTheStandardErrorsDependOnAreNamed) {
  config::FingerConfig other;
  other.tolerance.core_radius_m = 3e-4;
  STRCMP_CONTAINS("those of another [tolerance] (depth_m, core_radius_m, poisson_ratio)",
                  mismatch(image_, other).c_str());
}

TEST(TableText, AllDifferencesAreNamedAtOnce) {
  config::FingerConfig other;
  for (const Change& change : kChanges) change.apply(other);
  for (const Change& change : kChanges) STRCMP_CONTAINS(change.words, mismatch(image_, other).c_str());
}

TEST(TableText, GaugesThatWereFoundElsewhereAreNamed) {
  config::FingerConfig other;
  other.calibration.angle_offset_deg.assign(16, 0);
  STRCMP_EQUAL("belongs", mismatch(image_, other).c_str());
  other.calibration.angle_offset_deg[1] = 0.25;
  STRCMP_CONTAINS("gauges.angle_deg is [0, 22.5, 45, ", mismatch(image_, other).c_str());
  STRCMP_CONTAINS("the config has [0, 22.75, 45, ", mismatch(image_, other).c_str());
}

TEST(TableText, KeysThatTablesDontDependOnMayDiffer) {
  config::FingerConfig other;
  other.can = {5, 500000, 100};
  STRCMP_EQUAL("belongs", mismatch(image_, other).c_str());
}
