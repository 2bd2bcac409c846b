#include "host/bench/error_sweeps.hpp"

#include <algorithm>
#include <cstdio>
#include <string>

#include "host/base/failure.hpp"
#include "host/base/read_file.hpp"
#include "host/bench/error_pages.hpp"
#include "tests/host/plot/TemporaryFolder.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::bench;

TEST_GROUP(ErrorSweeps) {
  const plot::TemporaryFolder folder;
  const SweepSettings brief{.contacts = 20, .repeats = 1, .seed = 5};
  const std::vector<ErrorCell> cells = errorSweeps(brief);

  std::string csv() const {
    std::FILE* file = std::fopen(folder.file("errors.csv").c_str(), "w");
    writeErrorCsv(file, cells);
    std::fclose(file);
    return readFile(folder.file("errors.csv"), ExitCode::kFailure);
  }
};

TEST(ErrorSweeps, TheCsvHasTheseColumnsAndARowForEachCell) {
  const std::string text = csv();
  STRCMP_EQUAL(
      "sweep,setting,unit,direction_deg,load_n_per_m,told,contacts,unnoticed,uncertain,wrong,arc_rms_mm,arc_"
      "95_mm,"
      "arc_worst_mm,normal_rms_n_per_m,normal_95_n_per_m,normal_worst_n_per_m,tangential_rms_n_per_m,"
      "tangential_95_n_per_m,tangential_worst_n_per_m",
      text.substr(0, text.find('\n')).c_str());
  LONGS_EQUAL(1 + cells.size(), std::count(text.begin(), text.end(), '\n'));
}

TEST(ErrorSweeps, EverySweepIsThere) {
  LONGS_EQUAL(41 * 31, cellsOf(cells, kMapSweep).size());
  for (const char* sweep : {kLoadSweep, kNoiseSweep, kWidthSweep, kLengthSweep, kBitsSweep})
    CHECK_TRUE_TEXT(cellsOf(cells, sweep).size() >= 7, sweep);
  LONGS_EQUAL(4, cellsOf(cells, kBuiltSweep).size());
}

TEST(ErrorSweeps, ASecondRunIsTheSame) {
  const auto again = errorSweeps(brief);
  for (std::size_t i = 0; i < cells.size(); ++i)
    CHECK(cells[i].statistics.arc_mm.rms() == again[i].statistics.arc_mm.rms() ||
          cells[i].statistics.contacts == 0 ||
          cells[i].statistics.unnoticed + cells[i].statistics.uncertain == cells[i].statistics.contacts);
}

TEST(ErrorSweeps, ThePageTellsTheWorstAndHasThePictures) {
  const std::string page = errorPage(cells, brief);
  const auto at = [&](const char* text) { return page.find(text); };
  CHECK(at("## In short") < at("## The worst settings"));
  CHECK(at("## The worst settings") < at("(error_map.png)"));
  CHECK(at("(error_curves.png)") != std::string::npos);
  CHECK(at("seed 5") != std::string::npos);
}

TEST(ErrorSweeps, TheTablesHaveARowForEachSetting) {
  const std::string tables = errorTables(cells, brief);
  std::size_t settings = 0;
  for (const char* sweep : {kLoadSweep, kNoiseSweep, kBitsSweep, kWidthSweep, kBuiltSweep, kLengthSweep})
    settings += cellsOf(cells, sweep).size();
  constexpr std::size_t kHeadings = 6;
  std::size_t rows = 0;
  for (std::size_t at = 0; (at = tables.find("\n| ", at)) != std::string::npos; ++at) ++rows;
  LONGS_EQUAL(settings + kHeadings, rows);
}

TEST(ErrorSweeps, ThePicturesAreDrawn) {
  draw(errorMapPicture(cells), folder.file("map.svg"));
  draw(errorCurvesPicture(cells), folder.file("curves.png"));
  CHECK(readFile(folder.file("map.svg"), ExitCode::kFailure).size() > 10'000);
  CHECK(readFile(folder.file("curves.png"), ExitCode::kFailure).size() > 10'000);
}
