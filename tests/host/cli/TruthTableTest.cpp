#include "host/cli/truth_table.hpp"

#include <algorithm>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <string>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::cli;

TEST_GROUP(TruthTable) {
  const config::Finger finger{.outer_radius_m = 0.01, .length_m = 0.02};
  char* text = nullptr;
  std::size_t size = 0;
  std::FILE* stream = nullptr;
  std::optional<TruthTable> table;
  const std::vector<simulation::Touch> touch{{(360 + 40) * std::numbers::pi / 180, 20, -5}};

  void setup() override {
    stream = open_memstream(&text, &size);
    table.emplace(stream, finger);
  }
  void teardown() override {
    std::fclose(stream);
    std::free(text);
  }

  void silent(double time_s, const std::vector<simulation::Touch>& truth = {}) {
    table->add({time_s, truth, std::nullopt});
  }
  void reported(double time_s, FingerFlags flags, const std::vector<simulation::Touch>& truth) {
    simulation::Moment moment{time_s, truth, std::nullopt};
    moment.compared = {time_s, truth, {{40.1, 0.02, 0.41, 0.001, -0.1, 0.002, 100}}};
    moment.compared->report.flags = flags;
    table->add(moment);
  }
  /// Below the heading.
  std::string lines() {
    std::fflush(stream);
    std::string all(text, size);
    for (int heading = 0; heading < 3; ++heading) all.erase(0, all.find('\n') + 1);
    return all;
  }
};

TEST(TruthTable, ShowsTruthEstimateAndDifference) {
  reported(0.25, {FingerFlag::kContact}, touch);
  STRCMP_EQUAL(
      "  0.250 |  40.00    20.00    -5.00 |   40.10 ±  0.02    20.50 ±  0.05     -5.00 ±  0.10 | "
      "+0.017   +0.50   +0.00\n",
      lines().c_str());
}

TEST(TruthTable, TheLargestSigmaThatAFingerCanSayIsThatOrMore) {
  simulation::Moment moment{0.25, touch, std::nullopt};
  moment.compared = {0.25, touch, {{40.1, 655.34, 0.41, 0.127, -0.1, 0.127, 100}}};
  moment.compared->report.flags = {FingerFlag::kContact};
  table->add(moment);
  STRCMP_CONTAINS("40.10 ±>=655.34    20.50 ±>=6.35     -5.00 ±>=6.35 |", lines().c_str());
}

TEST(TruthTable, HasALineAQuarterOfASecond) {
  for (int sample = 1; sample <= 1000; ++sample) silent(sample * 1e-3);
  const std::string all = lines();
  LONGS_EQUAL(4, std::count(all.begin(), all.end(), '\n'));
}

TEST(TruthTable, WaitsForTheNextReportInContact) {
  reported(0.2, {FingerFlag::kContact}, touch);
  silent(0.25, touch);
  STRCMP_EQUAL("", lines().c_str());
  reported(0.26, {FingerFlag::kContact}, touch);
  STRCMP_CONTAINS("  0.260 |  40.00", lines().c_str());
}

TEST(TruthTable, SaysNothingWhereTheFingerDoes) {
  silent(0.25);
  STRCMP_EQUAL("  0.250 |      -        -        - | nothing\n", lines().c_str());
}

TEST(TruthTable, ShowsATouchThatIsNotReported) {
  silent(0.25, touch);
  silent(0.32, touch);
  STRCMP_EQUAL("  0.320 |  40.00    20.00    -5.00 | nothing\n", lines().c_str());
}

TEST(TruthTable, MarksUncertainAnswers) {
  reported(0.25, {FingerFlag::kContact, FingerFlag::kUncertain}, touch);
  STRCMP_CONTAINS("  uncertain\n", lines().c_str());
}

TEST(TruthTable, EachTouchHasALine) {
  const simulation::Touch other{200 * std::numbers::pi / 180, 10, 1};
  reported(0.25, {FingerFlag::kContact}, {other, touch[0]});
  STRCMP_EQUAL(
      "  0.250 | 200.00    10.00    +1.00 | nothing\n"
      "        |  40.00    20.00    -5.00 |   40.10 ±  0.02    20.50 ±  0.05     -5.00 ±  0.10 | "
      "+0.017   +0.50   +0.00\n",
      lines().c_str());
}

TEST(TruthTable, AContactWithoutATouchHasALineToo) {
  reported(0.25, {FingerFlag::kContact}, {});
  STRCMP_EQUAL("  0.250 |      -        -        - |   40.10 ±  0.02    20.50 ±  0.05     -5.00 ±  0.10 |\n",
               lines().c_str());
}
