// What the finger can do: sweeps as CSV, pictures and a page.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/bench/csv_file.hpp"
#include "host/bench/error_pages.hpp"

using namespace strainfinger;

namespace {

struct Options {
  std::string folder;
  bench::SweepSettings settings;
};

void run(const Options& options) {
  const auto cells = bench::errorSweeps(options.settings);
  const std::string page = errorPage(cells, options.settings);
  bench::writeCsvFile(options.folder + "/errors.csv",
                      [&](std::FILE* file) { bench::writeErrorCsv(file, cells); });
  for (const char* ending : {".svg", ".png"}) {
    draw(bench::errorMapPicture(cells), options.folder + "/error_map" + ending);
    draw(bench::errorCurvesPicture(cells), options.folder + "/error_curves" + ending);
  }
  writeFileAtomically(options.folder + "/what_the_finger_can_do.md", page);
  writeFileAtomically(options.folder + "/errors.md", errorTables(cells, options.settings));
  std::fputs(page.c_str(), stdout);
}

}  // namespace

int main(int count, char** arguments) {
  CLI::App app{"Error of the finger over all that a user may meet", "error_report"};
  Options options;
  app.add_option("-o", options.folder, "where pages, pictures and CSV go")
      ->required()
      ->check(CLI::ExistingDirectory);
  app.add_option("--contacts", options.settings.contacts, "contacts of each cell")
      ->check(CLI::Range(10, 1'000'000));
  app.add_option("--repeats", options.settings.repeats, "contacts of each cell of the map")
      ->check(CLI::Range(1, 100'000));
  app.add_option("--seed", options.settings.seed, "of places, directions and noise");
  CLI11_PARSE(app, count, arguments);
  try {
    run(options);
    return 0;
  } catch (const Failure& failure) {
    std::fprintf(stderr, "error_report: %s\n", failure.what());
    return static_cast<int>(failure.code());
  }
}
