#include "host/bench/model/model_report.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::bench;

TEST_GROUP(ModelReport) {
  static MeasuredCase timed(const char* task, const char* method, double error, double time_s) {
    return {task, method, "terms", 5, error, nullptr, time_s};
  }
  const std::vector<MeasuredCase> cases{
      timed("table", "slow", 1e-3, 2e-3),    timed("table", "best", 1e-5, 1e-3),
      timed("table", "dear", 1e-9, 5e-3),    timed("field", "it's", 1e-2, 1),
      timed("contact", "spectral", 0, 1e-4), timed("svd", "ours", 1e-12, 4e-3),
      timed("paper", "data", NAN, 0.25)};
};

TEST(ModelReport, TheFrontHasWhatNothingIsBothFasterAndCloserThan) {
  const auto front = paretoOf(cases, "table");
  LONGS_EQUAL(2, front.size());
  STRCMP_EQUAL("best", front[0].method.c_str());
  STRCMP_EQUAL("dear", front[1].method.c_str());
}

TEST(ModelReport, CsvHasARowACaseAndNoErrorWhereThereIsNone) {
  const std::string csv = modelCsv(cases);
  STRCMP_CONTAINS("task,method,knob,value,error,time_s\ntable,\"slow\",terms,5,0.001,0.002\n", csv.c_str());
  STRCMP_CONTAINS("paper,\"data\",terms,5,,0.25\n", csv.c_str());
}

TEST(ModelReport, SavingsAreRatiosOfTimes) {
  const std::vector<Saving> savings{{"columns", timed("s", "few", NAN, 1e-3), timed("s", "all", NAN, 3e-3)}};
  DOUBLES_EQUAL(3, savings[0].ratio(), 1e-12);
  STRCMP_CONTAINS("| columns | 3 ms | 1 ms | 3.0 |", modelMarkdown(cases, savings).c_str());
  STRCMP_CONTAINS("\"columns\",0.001,0.003,3", savingsCsv(savings).c_str());
}

TEST(ModelReport, ThePictureHasADataFileAMethodAndAFront) {
  const plot::Picture picture = paretoPicture(cases);
  LONGS_EQUAL(6 + 4, picture.data.size());
  STRCMP_CONTAINS("title 'it''s'", picture.script.c_str());
}

// Rounding of the sums: some tens of 1e-16 of the peak.
TEST(ModelReport, OursReachesRoundingAndMoreHarmonicsNeverCost) {
  for (const auto& some : {tableCases(), fieldCases()}) {
    const auto best = std::ranges::min_element(some, {}, [](const MeasuredCase& each) {
      return each.method.starts_with("ours") && !std::isnan(each.error) ? each.error : 1.0;
    });
    CHECK_TRUE(best->error < 5e-15);
    for (const MeasuredCase& each : some)
      if (each.knob == "harmonics" && each.value >= 160) CHECK_TRUE(each.error < 1e-6);
  }
}

TEST(ModelReport, ToleranceIsABoundOfTheError) {
  for (const MeasuredCase& each : fieldCases())
    if (each.knob == "tolerance") CHECK_TRUE(each.error < std::max(each.value, 5e-15));
}
