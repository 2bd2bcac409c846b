#include "host/bench/locator_report.hpp"

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <string>

#include "host/base/failure.hpp"
#include "host/base/read_file.hpp"
#include "host/bench/methods/catalogue.hpp"
#include "tests/host/plot/TemporaryFolder.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::bench;

TEST_GROUP(LocatorReport) {
  const plot::TemporaryFolder folder;

  static MethodResult result(const char* name, bool usesFloat, int gross, double arc_um) {
    Score score;
    score.readings = 1000;
    score.gross = gross;
    score.overBound = {1.01, 1.02, 1.03};
    score.arc_um = score.arcOfAll_um = arc_um;
    score.arcBound_um = 10;
    return {name, usesFloat, {score, score, score, score}, 12'345};
  }
  const std::vector<MethodResult> results{result("ours: refined", false, 0, 12),
                                          result("rough", true, 90, 900), result("fine", true, 0, 12.1),
                                          result("finer", true, 0, 11)};

  Counts counts(const std::string& text) const {
    std::ofstream(folder.file("counts.json")) << text;
    return Counts(folder.file("counts.json"));
  }
  Counts someCounts() const {
    return counts(R"({"Cortex-M4": {"ours: refined": {"1": [700, 900, 1500], "2": [800, 901, 1501],
                        "3": [950, 960, 970]}},
      "Cortex-M4 with FPU": {"rough": {"1": [100, 100, 100]}, "fine": {"1": [2100, 2200, 2300]},
                             "finer": {"1": [7000, 8000, 9000]}}})");
  }
  std::string csv(const Counts& counted) const {
    std::FILE* file = std::fopen(folder.file("out.csv").c_str(), "w");
    writeLocatorCsv(file, results, counted);
    std::fclose(file);
    return readFile(folder.file("out.csv"), ExitCode::kFailure);
  }
  static void checkHas(const std::string& text, const char* part) { STRCMP_CONTAINS(part, text.c_str()); }
};

TEST(LocatorReport, ARowOfTheTableHasErrorsTimeAndInstructions) {
  checkHas(locatorMarkdown(results, someCounts()),
           "| ours: refined | 1.01 / 1.02 / 1.03 | 0 | 12.00 (0) | 1.01 / 1.02 / 1.03 | 0 | 1.01 / 1.02 / "
           "1.03 | 0 | 12,345 | 700 (900) | - | - | 800 (901) | - | 950 (960) |");
  checkHas(locatorMarkdown(results, someCounts()), "| rough | 1.01 / 1.02 / 1.03 | 9 % |");
}

TEST(LocatorReport, WhatWasNotCountedIsADash) {
  checkHas(locatorMarkdown(results, Counts()), "| 12,345 | - | - | - | - | - | - |");
  CHECK(Counts().empty());
  STRCMP_EQUAL("", locatorVerdict(results, Counts()).c_str());
}

TEST(LocatorReport, TheVerdictIsAboutTheCheapestThatIsAsGood) {
  checkHas(locatorVerdict(results, someCounts()),
           ", fine, takes 3.0 times the instructions of ours: refined");
}

TEST(LocatorReport, TheCsvHasTheseColumnsAndARowForEachLevel) {
  const std::string text = csv(someCounts());
  STRCMP_EQUAL(
      "method,noise,least_width_mm,most_width_mm,seed,contacts,gross,angle_over_bound,normal_over_bound,"
      "tangential_over_bound,arc_rms_um,"
      "arc_worst_um,arc_rms_of_all_um,normal_rms_n_per_m,tangential_rms_n_per_m,time_ns,m4_median_counted,"
      "m4_95_counted,m4_most_counted,m4_fpu_median_counted,m4_fpu_95_counted,m4_fpu_most_counted,"
      "m0plus_median_counted,m0plus_95_counted,m0plus_most_counted",
      text.substr(0, text.find('\n')).c_str());
  LONGS_EQUAL(1 + 4 * kLevels, std::count(text.begin(), text.end(), '\n'));
  checkHas(text, ",12345,800,901,1501,,,,,,\n");
  checkHas(text, "ours: refined,0.001,0.5,4,1004,");
}

TEST(LocatorReport, CountsThatAreNoneAreRefused) {
  CHECK_THROWS(Failure, counts("{"));
  CHECK_THROWS(Failure, counts(R"({"Cortex-M4": {"a": {"1 %": [1]}}})"));
  CHECK_THROWS(Failure, Counts(folder.file("absent.json")));
}

TEST(LocatorReport, ThePictureHasAPointForEachMethodWithACost) {
  LONGS_EQUAL(4, locatorPicture(results, Counts()).data[0].rows.size());
  LONGS_EQUAL(4, locatorPicture(results, someCounts()).data[0].rows.size());
  LONGS_EQUAL(1, locatorPicture(results, someCounts()).data[1].rows.size());
  LONGS_EQUAL(0,
              locatorPicture(results, counts(R"({"Cortex-M0+": {"fine": {"1": [1, 2, 3]}}})")).data.size());
  draw(locatorPicture(results, someCounts()), folder.file("pareto.svg"));
  checkHas(readFile(folder.file("pareto.svg"), ExitCode::kFailure), "3 fine");
}

TEST(LocatorReport, NoMethodHasTheNameOfAnother) {
  std::vector<std::string> names;
  const auto collect = [&](const Method& method, auto&&) { names.emplace_back(method.name); };
  const auto tables = std::make_unique<NoiseTables>();
  const auto known = std::make_unique<Knowledge>();
  visitOurs(*tables, collect);
  visitOthers(*known, collect);
  CHECK(names.size() > 10);
  std::sort(names.begin(), names.end());
  CHECK(std::adjacent_find(names.begin(), names.end()) == names.end());
  for (const std::string& name : names) CHECK(name.find_first_of(";,|") == std::string::npos);
}
