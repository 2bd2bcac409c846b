#pragma once
// The readings of the benchmark and the bundle that holds some of them for the emulated processors.

#include <memory>
#include <string>
#include <vector>

#include "host/bench/methods/bundle.hpp"
#include "host/bench/readings.hpp"

namespace strainfinger::bench {

/// What is drawn, and noise of a reading over the peak strain that the load makes as a line. The seeds are
/// the benchmark's: printed with its results.
struct LevelSettings {
  const char* name;
  double relativeNoise;
  std::uint64_t seed;
  evidence::Range width_m = {0, 0};
};
inline constexpr std::array<LevelSettings, kLevels> kLevelSettings{
    {{"clean", 0, 1001},
     {"0.1 %", 1e-3, 1002},
     {"1 %", 1e-2, 1003},
     {"0.1 %, 0.5 to 4 mm wide", 1e-3, 1004, {0.5e-3, 4e-3}}}};

std::vector<Reading> readingsOf(const BenchFinger& finger, const LevelSettings& level, int count);

/// The firmware's tables are told the noise; without noise, the default finger's.
NoiseTables tablesFor(const BenchFinger& finger, const LevelSettings& level);

/// The same bytes on every run of one machine. Cost: the training of the perceptron.
std::unique_ptr<Bundle> makeBundle(const BenchFinger& finger);

/// Throws Failure(kFailure) for a file that cannot be read or isn't a bundle of this build.
std::unique_ptr<Bundle> readBundle(const std::string& path);
void writeBundle(const Bundle& bundle, const std::string& path);

}  // namespace strainfinger::bench
