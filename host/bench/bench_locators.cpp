// Run time against error of the locators: table on stdout, CSV and pictures in a folder.
#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <string>

#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/bench/csv_file.hpp"
#include "host/bench/locator_report.hpp"

using namespace strainfinger;

namespace {

struct Options {
  std::string bundle, counts, folder;
  int contacts = 20'000;
};

std::string textOf(const std::vector<bench::MethodResult>& results, const bench::Counts& counts,
                   int contacts) {
  std::string text = locatorMarkdown(results, counts);
  text += fmt::format("\n{} contacts of {} N/m a level of noise; seeds", contacts, bench::kBenchLoad_n_per_m);
  for (const auto& level : bench::kLevelSettings) text += fmt::format(" {} ({})", level.seed, level.name);
  text += counts.empty() ? ". No instructions counted: qemu-system-arm or arm-none-eabi-g++ is missing.\n"
                         : ". Instructions of a fit: median (95 % are below) at 0.1 %.\n";
  return text + locatorVerdict(results, counts);
}

void run(const Options& options) {
  const bench::BenchFinger finger;
  const auto bundle = bench::readBundle(options.bundle);
  const auto counts = options.counts.empty() ? bench::Counts() : bench::Counts(options.counts);
  const auto results = bench::locatorResults(finger, *bundle, options.contacts);
  const std::string text = textOf(results, counts, options.contacts);
  std::fputs(text.c_str(), stdout);
  writeFileAtomically(options.folder + "/locators.md", text);
  bench::writeCsvFile(options.folder + "/locators.csv",
                      [&](std::FILE* file) { bench::writeLocatorCsv(file, results, counts); });
  for (const char* ending : {".svg", ".png"})
    draw(locatorPicture(results, counts), options.folder + "/locators" + ending);
}

}  // namespace

int main(int count, char** arguments) {
  CLI::App app{"Run time against error of the locators", "bench_locators"};
  Options options;
  app.add_option("--bundle", options.bundle, "what bench_bundle made")->required();
  app.add_option("--counts", options.counts, "what count_instructions.py counted");
  app.add_option("--contacts", options.contacts, "readings of each level of noise")
      ->check(CLI::Range(bench::kCountedSamples, 10'000'000));
  app.add_option("-o", options.folder, "where CSV and pictures go")
      ->required()
      ->check(CLI::ExistingDirectory);
  CLI11_PARSE(app, count, arguments);
  try {
    run(options);
    return 0;
  } catch (const Failure& failure) {
    std::fprintf(stderr, "bench_locators: %s\n", failure.what());
    return static_cast<int>(failure.code());
  }
}
