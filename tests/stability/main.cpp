// stability_report FOLDER: the whole survey. Tables (harmonics.csv, fields.csv, stability.md) and heat maps
// (stability.svg, .png) go to FOLDER, the summary to stdout. Exit status 1 when an error is above the bar.
// SAMPLES a region and MOST harmonics may follow, for a shorter or a longer one.

#include <fmt/format.h>

#include <cstdio>
#include <cstdlib>
#include <exception>
#include <filesystem>
#include <random>
#include <string>

#include "host/base/atomic_file.hpp"
#include "tests/stability/report.hpp"

using namespace strainfinger;
using namespace strainfinger::stability;

namespace {

int survey(const std::string& folder, int samplesPerRegion, int mostHarmonics) {
  std::filesystem::create_directories(folder);
  const unsigned seed = std::random_device{}();
  fmt::print(stderr, "seed {}; harmonics ...\n", seed);
  const auto harmonics = surveyHarmonics(samplesPerRegion, seed);
  fmt::print(stderr, "fields ...\n");
  const auto fields = surveyFields(mostHarmonics);
  writeFileAtomically(folder + "/harmonics.csv", harmonicTable(harmonics));
  writeFileAtomically(folder + "/fields.csv", fieldTable(fields));
  const std::string text = summary(harmonics, fields);
  writeFileAtomically(folder + "/stability.md", text);
  for (const char* ending : {".svg", ".png"})
    draw(heatMaps(harmonics, fields), folder + "/stability" + ending);
  const bool good = holds(harmonics) && holds(fields);
  fmt::print("{}\n{} {:g}; all of it in {}\n", text, good ? "All within" : "NOT within", kBar, folder);
  return good ? EXIT_SUCCESS : EXIT_FAILURE;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc < 2 || argc > 4) {
    fmt::print(stderr, "usage: stability_report FOLDER [SAMPLES [MOST]]\n");
    return 2;
  }
  try {
    return survey(argv[1], argc > 2 ? std::atoi(argv[2]) : 100, argc > 3 ? std::atoi(argv[3]) : 20'000);
  } catch (const std::exception& error) {
    fmt::print(stderr, "stability_report: {}\n", error.what());
    return EXIT_FAILURE;
  }
}
