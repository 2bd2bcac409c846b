#include "host/bench/locator_results.hpp"

#include <algorithm>
#include <limits>

#include <nlohmann/json.hpp>

#include "host/base/failure.hpp"
#include "host/base/read_file.hpp"
#include "host/bench/batches.hpp"
#include "host/bench/make_knowledge.hpp"
#include "host/bench/methods/catalogue.hpp"
#include "host/bench/methods/keep.hpp"

namespace strainfinger::bench {
namespace {

constexpr double kUncounted = std::numeric_limits<double>::quiet_NaN();

struct Level {
  std::vector<Reading> readings;
  const NoiseTables* tables;
};

/// Scores one method after the other. Which method a call is about is its place in the catalogue.
class Contest {
 public:
  Contest(const BenchFinger& finger, std::array<Level, kLevels> levels)
      : finger_(finger), levels_(std::move(levels)) {}

  template <typename Fit>
  void enter(std::size_t level, MethodResult& result, Fit fit) {
    const auto& [readings, tables] = levels_[level];
    std::vector<Place<double>> answers;
    for (const Reading& reading : readings) answers.push_back(placeOf(tables->line, fit(reading.sample)));
    result.score[level] = scoreOf(finger_, readings, answers);
    if (level == kTimedLevel) result.time_ns = timeOf(fit);
  }
  const NoiseTables& tables(std::size_t level) const { return *levels_[level].tables; }

 private:
  template <typename Fit>
  double timeOf(Fit fit) const {
    const auto& readings = levels_[kTimedLevel].readings;
    const std::size_t count = std::min<std::size_t>(readings.size(), kCountedSamples);
    const double batch_ns = medianTime_ns([&] {
      for (std::size_t i = 0; i < count; ++i) keep(fit(readings[i].sample));
    });
    return batch_ns / static_cast<double>(count);
  }

  const BenchFinger& finger_;
  std::array<Level, kLevels> levels_;
};

MethodResult& resultAt(std::vector<MethodResult>& results, std::size_t place, const Method& method) {
  if (place == results.size()) results.push_back({std::string(method.name), method.usesFloat, {}, 0});
  return results[place];
}

/// What a search in double makes of a sample.
template <typename Search>
auto inDouble(Search& search) {
  return [&search](const Sample& sample) {
    Ring<double> strain;
    std::copy(sample.strain.begin(), sample.strain.end(), strain.begin());
    return search(strain);
  };
}

/// Knows that touches are lines.
void enterReference(Contest& contest, std::size_t level, const BenchFinger& finger, MethodResult& result) {
  const auto response = makeResponse<double>(finger);
  const auto bank = makeGlobalBank<double>(finger);
  GlobalSearch<double> search(response, bank);
  contest.enter(level, result, inDouble(search));
}

void enterWideReference(Contest& contest, std::size_t level, const BenchFinger& finger,
                        MethodResult& result) {
  const auto patches = makePatches<double>(finger);
  const auto bank = makeWidthBank(patches);
  GlobalWidthSearch<double> search(patches, bank);
  contest.enter(level, result, inDouble(search));
}

}  // namespace

std::vector<MethodResult> locatorResults(const BenchFinger& finger, const Bundle& bundle, int contacts) {
  std::array<Level, kLevels> levels;
  for (std::size_t i = 0; i < kLevels; ++i)
    levels[i] = {readingsOf(finger, kLevelSettings[i], contacts), &bundle.levels[i].tables};
  Contest contest(finger, std::move(levels));
  std::vector<MethodResult> results;
  MethodResult reference{"global search in double", true, {}, 0};
  MethodResult wideReference{"global search with the width in double", true, {}, 0};
  for (std::size_t level = 0; level < kLevels; ++level) {
    std::size_t place = 0;
    const auto enter = [&](const Method& method, auto fit) {
      contest.enter(level, resultAt(results, place++, method), fit);
    };
    visitOurs(contest.tables(level), enter);
    visitOthers(bundle.knowledge, enter);
    enterReference(contest, level, finger, reference);
    enterWideReference(contest, level, finger, wideReference);
  }
  results.push_back(reference);
  results.push_back(wideReference);
  return results;
}

Counts::Counts(const std::string& path) try {
  const auto content = nlohmann::json::parse(readFile(path, ExitCode::kFailure));
  for (const auto& [core, methods] : content.items())
    for (const auto& [method, levels] : methods.items())
      for (const auto& [level, count] : levels.items())
        counts_[{core, method, level}] = {count.at(0), count.at(1), count.at(2)};
} catch (const nlohmann::json::exception& error) {
  throw Failure(ExitCode::kFailure, path + ": not what count_instructions.py writes: " + error.what());
}

Count Counts::of(std::size_t core, const std::string& method, std::size_t level) const {
  const auto found = counts_.find({kCores[core], method, std::to_string(level)});
  return found == counts_.end() ? Count{kUncounted, kUncounted, kUncounted} : found->second;
}

double countOnM4(const MethodResult& result, const Counts& counts, std::size_t level) {
  return counts.of(result.usesFloat ? kM4WithFpu : kM4, result.name, level).median;
}

}  // namespace strainfinger::bench
