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
  const BenchFinger finger;
  const double peak = finger.peakPerLoad() * kBenchLoad_n_per_m;
  DOUBLES_EQUAL(1e-3 * peak, tablesFor(finger, kLevelSettings[1]).usual.parameters.noise_strain, 1e-12);
  DOUBLES_EQUAL(1e-2 * peak, tablesFor(finger, kLevelSettings[2]).usual.parameters.noise_strain, 1e-12);
  const auto clean = tablesFor(finger, kLevelSettings[0]);
  DOUBLES_EQUAL(6e-6, clean.usual.parameters.noise_strain, 1e-12);
  CHECK(clean.everyWindow.constants.anchor_rule == AnchorRule::kExhaustive);
}
