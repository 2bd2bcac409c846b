// Run time against error of the model's tables, fields, contacts and singular values: bench_model -o FOLDER.
// Google Benchmark's own options (--benchmark_...) come along.

#include <benchmark/benchmark.h>
#include <fmt/format.h>

#include <cstdlib>
#include <exception>
#include <map>
#include <string>

#include "host/base/atomic_file.hpp"
#include "host/bench/model/model_report.hpp"

using namespace strainfinger;
using namespace strainfinger::bench;

namespace {

constexpr double kTimeEach_s = 0.1;

/// Shows what it always shows, and keeps the times: of the processor, which others on the machine hardly
/// change.
class Collector : public benchmark::ConsoleReporter {
 public:
  Collector() : ConsoleReporter(OO_Tabular) {}
  void ReportRuns(const std::vector<Run>& runs) override {
    for (const Run& run : runs)
      times_[run.run_name.function_name] = run.cpu_accumulated_time / static_cast<double>(run.iterations);
    ConsoleReporter::ReportRuns(runs);
  }
  void fillIn(MeasuredCase& measured) const {
    if (const auto found = times_.find(measured.name()); found != times_.end())
      measured.time_s = found->second;
  }

 private:
  std::map<std::string, double> times_;
};

/// A case known by its name already is measured once.
void enroll(const MeasuredCase& measured, std::map<std::string, bool>& enrolled) {
  if (!measured.run || !enrolled.insert({measured.name(), true}).second) return;
  const auto loop = [run = measured.run](benchmark::State& state) {
    for ([[maybe_unused]] auto _ : state) benchmark::DoNotOptimize(run());
  };
  benchmark::RegisterBenchmark(measured.name().c_str(), loop)
      ->Unit(benchmark::kMicrosecond)
      ->MinTime(kTimeEach_s);
}

template <typename Item>
void append(std::vector<Item>& all, const std::vector<Item>& more) {
  all.insert(all.end(), more.begin(), more.end());
}

void measure(const std::string& folder) {
  std::vector<MeasuredCase> cases;
  for (const auto& some : {tableCases(), fieldCases(), contactCases(), svdCases(), paperCases()})
    append(cases, some);
  std::vector<Saving> savings = fieldSavings();
  append(savings, svdSavings());
  std::map<std::string, bool> enrolled;
  for (const MeasuredCase& each : cases) enroll(each, enrolled);
  for (const Saving& saving : savings)
    for (const MeasuredCase& each : {saving.needed, saving.all}) enroll(each, enrolled);
  Collector collector;
  benchmark::RunSpecifiedBenchmarks(&collector);
  for (MeasuredCase& each : cases) collector.fillIn(each);
  for (Saving& saving : savings)
    for (MeasuredCase* each : {&saving.needed, &saving.all}) collector.fillIn(*each);
  writeFileAtomically(folder + "/model.csv", modelCsv(cases));
  writeFileAtomically(folder + "/model_savings.csv", savingsCsv(savings));
  writeFileAtomically(folder + "/model.md", modelMarkdown(cases, savings));
  for (const char* ending : {".svg", ".png"}) draw(paretoPicture(cases), folder + "/model" + ending);
}

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  if (argc != 3 || std::string(argv[1]) != "-o") {
    fmt::print(stderr, "usage: bench_model -o FOLDER [--benchmark_...]\n");
    return 2;
  }
  try {
    measure(argv[2]);
  } catch (const std::exception& error) {
    fmt::print(stderr, "bench_model: {}\n", error.what());
    return EXIT_FAILURE;
  }
}
