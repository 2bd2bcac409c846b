#include "host/bench/make_bundle.hpp"

#include <cstring>

#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/base/read_file.hpp"
#include "host/bench/make_knowledge.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::bench {

std::vector<Reading> readingsOf(const BenchFinger& finger, const LevelSettings& level, int count) {
  std::vector<Reading> readings;
  for (int i = 0; i < count; ++i)
    readings.push_back(
        readingOf(finger, level.seed, static_cast<std::uint64_t>(i), level.relativeNoise, level.width_m));
  return readings;
}

NoiseTables tablesFor(const BenchFinger& finger, const LevelSettings& level) {
  config::FingerConfig anyWidth = finger.config();
  if (level.relativeNoise > 0)
    anyWidth.gauges.noise_strain = level.relativeNoise * finger.peakPerLoad() * kBenchLoad_n_per_m;
  config::FingerConfig line = anyWidth;
  line.contact.width_m = 0;
  return {tables::buildTableImage(line), tables::buildTableImage(anyWidth)};
}

std::unique_ptr<Bundle> makeBundle(const BenchFinger& finger) {
  auto bundle = std::make_unique<Bundle>();
  bundle->bytes = sizeof(Bundle);
  bundle->reserved = 0;
  bundle->knowledge = makeKnowledge(finger);
  for (std::size_t i = 0; i < kLevels; ++i) {
    bundle->levels[i].tables = tablesFor(finger, kLevelSettings[i]);
    const auto readings = readingsOf(finger, kLevelSettings[i], kCountedSamples);
    for (std::size_t k = 0; k < readings.size(); ++k) bundle->levels[i].samples[k] = readings[k].sample;
  }
  return bundle;
}

std::unique_ptr<Bundle> readBundle(const std::string& path) {
  const std::string content = readFile(path, ExitCode::kFailure);
  auto bundle = std::make_unique<Bundle>();
  if (content.size() == sizeof(Bundle)) std::memcpy(bundle.get(), content.data(), sizeof(Bundle));
  if (content.size() != sizeof(Bundle) || bundle->bytes != sizeof(Bundle))
    throw Failure(ExitCode::kFailure, path + ": not a bundle of this build; make it with bench_bundle");
  return bundle;
}

void writeBundle(const Bundle& bundle, const std::string& path) {
  std::string content(sizeof(Bundle), '\0');
  std::memcpy(content.data(), &bundle, sizeof(Bundle));
  writeFileAtomically(path, content);
}

}  // namespace strainfinger::bench
