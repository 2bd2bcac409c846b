// stability_report FOLDER: the whole survey. Tables (harmonics.csv, fields.csv, contacts.csv, stability.md)
// and heat maps (stability.svg, .png) go to FOLDER, the summary to stdout. Exit status 1 when an error is
// above the bar. SAMPLES a region and MOST harmonics may follow, for a shorter or a longer one.

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

/// The page beside the model: copied there from the preset's results.
std::string page(const Surveys& surveys) {
  return fmt::format(
      "# Numerical stability of the model\n\n"
      "Worst errors in double precision, over alpha in 0.01..0.999, nu in 0..1/2 and just below, radii from "
      "core to "
      "surface, harmonics up to 100,000, loads from lines to a quarter turn. Harmonics and fields are "
      "compared with the "
      "same templates in 100 digits. NaNs and infinities in harmonics, fields and contacts: {}. Made by\n\n"
      "    cmake --workflow --preset stability\n"
      "    cp build/stability/stability/stability.{{md,png}} host/model/\n\n"
      "in half an hour of two cores, "
      "which fails if an error is above {:g} (contacts: {:g} without a warning).\n\n"
      "![Heat maps of the worst errors](stability.png)\n\n{}",
      countNotFinite(surveys), kBar, kContactBar, summary(surveys));
}

int survey(const std::string& folder, int samplesPerRegion, int mostHarmonics) {
  std::filesystem::create_directories(folder);
  const unsigned seed = std::random_device{}();
  fmt::print(stderr, "seed {}; harmonics ...\n", seed);
  Surveys surveys;
  surveys.harmonics = surveyHarmonics(samplesPerRegion, seed);
  fmt::print(stderr, "contacts ...\n");
  surveys.contacts = surveyContacts(kContactAlphas, kContactPoissonRatios);
  fmt::print(stderr, "fields ...\n");
  surveys.fields = surveyFields(mostHarmonics);
  writeFileAtomically(folder + "/harmonics.csv", harmonicTable(surveys.harmonics));
  writeFileAtomically(folder + "/fields.csv", fieldTable(surveys.fields));
  writeFileAtomically(folder + "/contacts.csv", contactTable(surveys.contacts));
  const std::string text = page(surveys);
  writeFileAtomically(folder + "/stability.md", text);
  for (const char* ending : {".svg", ".png"}) draw(heatMaps(surveys), folder + "/stability" + ending);
  const bool good = holds(surveys.harmonics) && holds(surveys.fields) && holds(surveys.contacts);
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
    return survey(argv[1], argc > 2 ? std::atoi(argv[2]) : 100, argc > 3 ? std::atoi(argv[3]) : 1'000'000);
  } catch (const std::exception& error) {
    fmt::print(stderr, "stability_report: {}\n", error.what());
    return EXIT_FAILURE;
  }
}
