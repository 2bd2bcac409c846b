#include <cstdio>
#include <cstring>
#include <fstream>
#include <memory>
#include <string>

#include "host/base/failure.hpp"
#include "host/bench/make_bundle.hpp"
#include "tests/host/plot/TemporaryFolder.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::bench;

TEST_GROUP(Bundle) {
  const plot::TemporaryFolder folder;
  const std::string path = folder.file("bundle.bin");
  const BenchFinger finger;
};

TEST(Bundle, ReadsBackByteForByte) {
  auto bundle = std::make_unique<Bundle>();
  std::memset(static_cast<void*>(bundle.get()), 0x5A, sizeof(Bundle));
  bundle->bytes = sizeof(Bundle);
  writeBundle(*bundle, path);
  CHECK(std::memcmp(bundle.get(), readBundle(path).get(), sizeof(Bundle)) == 0);
}

TEST(Bundle, AnotherFileIsRefused) {
  std::ofstream(path) << "no bundle";
  CHECK_THROWS(Failure, readBundle(path));
  std::ofstream(path) << std::string(sizeof(Bundle), 'x');
  CHECK_THROWS(Failure, readBundle(path));
  CHECK_THROWS(Failure, readBundle(folder.file("absent")));
}

TEST(Bundle, TheTablesKnowTheNoise) {
  const double peak = finger.peakPerLoad() * kBenchLoad_n_per_m;
  DOUBLES_EQUAL(1e-3 * peak, tablesFor(finger, kLevelSettings[1]).line.parameters.noise_strain, 1e-12);
  DOUBLES_EQUAL(1e-2 * peak, tablesFor(finger, kLevelSettings[2]).line.parameters.noise_strain, 1e-12);
  DOUBLES_EQUAL(6e-6, tablesFor(finger, kLevelSettings[0]).line.parameters.noise_strain, 1e-12);
}

TEST(Bundle, OneTableIsForLinesTheOtherForAnyWidth) {
  const NoiseTables tables = tablesFor(finger, kLevelSettings[1]);
  DOUBLES_EQUAL(0, tables.line.parameters.contact_width_m, 0);
  LONGS_EQUAL(1, tables.line.constants.width_is_known);
  LONGS_EQUAL(0, tables.anyWidth.constants.width_is_known);
}
