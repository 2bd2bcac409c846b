#include "host/config/write_config.hpp"

#include <fstream>
#include <iterator>
#include <random>
#include <string>
#include <variant>

#include "host/config/keys.hpp"
#include "tests/host/config/ConfigTest.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::config;

TEST_GROUP(WriteConfig) {
  std::mt19937_64 random{20240611};
  double uniform(double low, double high) {
    return low + (high - low) * static_cast<double>(random()) * 0x1p-64;
  }

  FingerConfig anyConfig() {
    FingerConfig any;
    any.finger = {uniform(0.001, 0.009), uniform(0.0126, 1), uniform(1e-3, 1), uniform(1, 1e12),
                  uniform(0, 0.5)};
    any.gauges = {12 + 2 * static_cast<int>(random() % 11),
                  uniform(0.009, 0.0125),
                  StrainComponent::kShear,
                  0,
                  uniform(0, 1e-3),
                  uniform(1e-3, 0.1),
                  uniform(1e-9, 0.06),
                  9};
    any.contact = {uniform(0, 10), {}, uniform(0.01, 0.0126)};
    if (random() % 2 == 0) any.contact.width_m = uniform(0, 0.01);
    any.can = {1 + static_cast<int>(random() % 63), 1000000, uniform(20, 1000)};
    any.gauges.model_error = uniform(0, 1);
    any.as_built = {7, uniform(0, 2), uniform(0, 1e-3), uniform(0, 0.2), 0, 0, uniform(0, 1e3)};
    any.tolerance = {uniform(0.1, 2),     uniform(1e-6, 1e-3), uniform(0.01, 0.2), uniform(1e-6, 1e-3),
                     uniform(1e-6, 1e-3), uniform(0.01, 0.1),  uniform(0.1, 0.3)};
    if (random() % 2 == 0)
      any.gauges.first_angle_deg = uniform(0, 359);
    else
      any.gauges.angles_deg = listOf(any.gauges, 0);
    if (random() % 2 == 0) {
      any.calibration.gain = listOf(any.gauges, 1);
      any.calibration.angle_offset_deg = listOf(any.gauges, 2);
      any.calibration.depth_offset_m = listOf(any.gauges, 3);
      any.calibration.place_error_m = uniform(0, 1e-3);
      any.calibration.load_error = uniform(0, 0.1);
      any.calibration.moment_error_m2 = uniform(0, 1e-6);
    }
    return any;
  }

  /// Angles all round, gains, angle offsets, depth offsets; random all.
  std::vector<double> listOf(const Gauges& gauges, int which) {
    std::vector<double> list;
    for (int i = 0; i < gauges.count; ++i) {
      const double pitch = 360.0 / gauges.count;
      const double values[] = {(i + uniform(0, 0.4)) * pitch, uniform(0.5, 2), uniform(-1, 1),
                               uniform(-1e-6, 1e-6)};
      list.push_back(values[which]);
    }
    return list;
  }

  void checkSame(FingerConfig a, FingerConfig b) {
    for (const Key& key : keys())
      std::visit([&](auto slot) { CHECK_TEXT(slot(a) == slot(b), key.dotted().c_str()); }, key.slot);
  }
};

TEST(WriteConfig, RandomConfigsReadBackExactly) {
  UT_PRINT("seed 20240611");
  for (int i = 0; i < 1000; ++i) {
    const FingerConfig any = anyConfig();
    checkSame(any, readConfig(writeConfig(any), "f.toml"));
  }
}

TEST(WriteConfig, EveryKeyIsDocumentedWithItsDomain) {
  const std::string text = writeConfig({});
  for (const Key& key : keys()) STRCMP_CONTAINS(std::string(key.doc).c_str(), text.c_str());
  STRCMP_CONTAINS("# gauges in the ring [even, 12 to 32]\ncount = 16\n", text.c_str());
  STRCMP_CONTAINS("not calibrated [each 0.5 to 2]\ngain = []\n", text.c_str());
  STRCMP_CONTAINS("left out: unknown, fitted with each touch [0 to 1]\n# width_m is left out\n",
                  text.c_str());
  STRCMP_CONTAINS("# the strain the gauges read [one of radial, hoop, shear]\ncomponent = \"radial\"\n",
                  text.c_str());
}

// What people read to learn the keys, and begin their own finger's file with.
TEST(WriteConfig, TheFileInTheTreeIsTheDefaultFinger) {
  std::ifstream file(STRAINFINGER_DOCUMENTED_CONFIG);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  STRCMP_EQUAL(writeConfig({}).c_str(), text.c_str());
}
