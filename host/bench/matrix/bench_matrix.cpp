// The disturbance matrix: a page and a CSV.
#include <CLI/CLI.hpp>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <string>

#include "host/base/atomic_file.hpp"
#include "host/base/failure.hpp"
#include "host/bench/csv_file.hpp"
#include "host/bench/matrix/matrix_page.hpp"
#include "host/bench/matrix/matrix_rows.hpp"
#include "host/bench/matrix/session.hpp"

using namespace strainfinger;

namespace {

struct Options {
  std::string folder, only;
  int touches = 1500;
  std::uint64_t seed = 3001;
};

void run(const Options& options) {
  std::vector<bench::MatrixRow> rows;
  for (const bench::Disturbance& disturbance : bench::matrixRows())
    if (disturbance.name.find(options.only) != std::string::npos)
      rows.push_back({disturbance.name, tallyOf(disturbance, options.touches, options.seed)});
  const std::string page = matrixPage(rows, options.touches, options.seed);
  bench::writeCsvFile(options.folder + "/disturbances.csv",
                      [&](std::FILE* file) { bench::writeMatrixCsv(file, rows); });
  writeFileAtomically(options.folder + "/disturbances.md", page);
  std::fputs(page.c_str(), stdout);
}

}  // namespace

int main(int count, char** arguments) {
  CLI::App app{"What disturbs the finger, and what it says then", "bench_matrix"};
  Options options;
  app.add_option("-o", options.folder, "where page and CSV go")->required()->check(CLI::ExistingDirectory);
  app.add_option("--touches", options.touches, "touches of each row")->check(CLI::Range(1, 10'000'000));
  app.add_option("--seed", options.seed, "of fingers, touches and noise");
  app.add_option("--only", options.only, "rows whose names have this in them");
  CLI11_PARSE(app, count, arguments);
  try {
    run(options);
    return 0;
  } catch (const Failure& failure) {
    std::fprintf(stderr, "bench_matrix: %s\n", failure.what());
    return static_cast<int>(failure.code());
  }
}
