#include <algorithm>
#include <cstdio>
#include <string>

#include "tests/commands/program.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(DesignCommand) {
  static Run design(const std::string& options) { return runShell("\"$STRAINFINGER\" design " + options); }
  /// In a folder of its own, after `before` and with `then` to follow.
  static Run inFolder(const std::string& before, const std::string& options, const std::string& then = "") {
    return runShell("folder=$(mktemp -d) && trap 'rm -rf \"$folder\"' EXIT && cd \"$folder\" && " + before +
                    "\"$STRAINFINGER\" design " + options + then);
  }
  static void checkRefused(const char* message, const std::string& options) {
    const Run run = design(options);
    LONGS_EQUAL_TEXT(2, run.status, options.c_str());
    STRCMP_CONTAINS(message, run.err.c_str());
    STRCMP_EQUAL("", run.out.c_str());
  }
};

TEST(DesignCommand, ARowForEachFingerAndTheBestInWords) {
  const Run run = design("--noise-strain 6e-6 --gauges 8:16:4 --radius-m 9.2e-3:9.6e-3:2");
  LONGS_EQUAL_TEXT(0, run.status, run.err.c_str());
  STRCMP_CONTAINS("gauges,radius_m,arc_median_m,arc_worst_m,normal_median_n_per_m,normal_worst_n_per_m,",
                  run.out.c_str());
  LONGS_EQUAL(1 + 6, std::count(run.out.begin(), run.out.end(), '\n'));
  for (const char* row : {"\n8,0.0092,", "\n16,0.0096,", "gauges.count = 8 must be"})
    STRCMP_CONTAINS(row, run.out.c_str());
  STRCMP_CONTAINS("design: of the fingers without a problem with this touch, 16 gauges at", run.err.c_str());
}

TEST(DesignCommand, WhatIsNotKnownIsNullInJson) {
  const Run run = design("--gauges 8 --json");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("\"table_bytes\":null", run.out.c_str());
  STRCMP_CONTAINS("each of these fingers has a problem", run.err.c_str());
}

TEST(DesignCommand, DrawsAPicture) {
  const Run run =
      inFolder("", "--gauges 8:16:4 --radius-m 9e-3:10e-3:2 --picture d.svg >d.csv", " && LC_ALL=C ls");
  LONGS_EQUAL_TEXT(0, run.status, run.err.c_str());
  STRCMP_EQUAL("d-fingers.csv\nd.csv\nd.gp\nd.svg\n", run.out.c_str());
}

// Ticks are at 1, 1.5, 2, 3, 5 and 7: so wide a range has two at least.
TEST(DesignCommand, AnAxisAroundOneValueHasNumbers) {
  const Run run = inFolder("", "--gauges 16 --picture d.svg >d.csv",
                           " && grep -o '[a-z]*Low = [^;]*; [a-z]*High = [^;]*' d.gp");
  LONGS_EQUAL_TEXT(0, run.status, run.err.c_str());
  for (const char* axis : {"arc", "normal"}) {
    double low = 0, high = 0;
    const std::string line = run.out.substr(run.out.find(std::string(axis) + "Low"));
    LONGS_EQUAL(2, std::sscanf(line.c_str(), "%*[a-zL] = %lf; %*[a-zH] = %lf", &low, &high));
    CHECK_TRUE_TEXT(low > 0 && high >= 2.5 * low, run.out.c_str());
  }
}

TEST(DesignCommand, DrawsFingersOfWhichNothingIsDetermined) {
  const Run run = inFolder("", "--gauges 2 --picture d.svg");
  LONGS_EQUAL_TEXT(0, run.status, run.err.c_str());
}

TEST(DesignCommand, AnInterruptedSweepHasWholeRowsAndSaysSo) {
  const Run run = runShell(
      "timeout --preserve-status -s INT 1 \"$STRAINFINGER\" design --gauges 16 --radius-m 9e-3:11e-3:1000");
  LONGS_EQUAL(130, run.status);
  const auto rows = std::count(run.out.begin(), run.out.end(), '\n') - 1;
  BYTES_EQUAL('\n', run.out.back());
  STRCMP_CONTAINS(("design: interrupted after " + std::to_string(rows) + " of 1000 fingers").c_str(),
                  run.err.c_str());
}

TEST(DesignCommand, ATouchNoWiderThanTheTablesIsTheDefault) {
  const Run run = inFolder("printf 'schema = 1\\n[contact]\\nlargest_width_m = 5e-4\\n' >f.toml && ",
                           "-c f.toml --gauges 16");
  LONGS_EQUAL_TEXT(0, run.status, run.err.c_str());
}

TEST(DesignCommand, BadRangesAndTouchesAreNamed) {
  for (const char* gauges : {"", "x", "8:", "32:8", "8:16:0", "8.5", "8:16:2:1", "nan", "0", "1000"})
    checkRefused("--gauges", std::string("--gauges '") + gauges + "'");
  for (const char* radii :
       {"''", "x", "9e-3:10e-3", "9e-3:10e-3:1", "9e-3:10e-3:2.5", "1e-3", "12.69e-3", "12.7e-3", "inf"})
    checkRefused("--radius-m", std::string("--radius-m ") + radii);
  checkRefused("--noise-strain", "--noise-strain nan");
  checkRefused("--noise-strain", "--noise-strain 0");
  checkRefused("--normal-n-per-m", "--normal-n-per-m 0");
  checkRefused("--width-m", "--width-m 0.009");
  checkRefused("--tangential-n-per-m -31: the contact would slip", "--tangential-n-per-m -31");
  checkRefused(".svg", "--picture bounds.jpg");
}
