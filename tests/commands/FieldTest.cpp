#include <cmath>
#include <string>

#include "tests/commands/program.hpp"
#include "tests/commands/tables.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(FieldCommand) {};

TEST(FieldCommand, PrintsAPolarGrid) {
  const Run run =
      runProgram("field --indenter flat --width-m 2e-3 --radii 3 --angles 5 --from-deg -4 --to-deg 4");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("radius_m,angle_deg,err,ett,ert,ur_m,ut_m,trr_pa,trt_pa,ttt_pa\n", run.out.c_str());
  const auto rows = tableOf(run.out);
  LONGS_EQUAL(15, rows.size());
  DOUBLES_EQUAL(8.9e-3, rows[0][0], 0);
  DOUBLES_EQUAL(0, rows[0][5], 0);  // nothing moves at the core
  DOUBLES_EQUAL(-2, rows[6][1], 1e-14);
  DOUBLES_EQUAL(12.7e-3, rows[12][0], 0);
  DOUBLES_EQUAL(-13686.2526384, rows[12][7], 1e-7);  // below the middle of the contact
  DOUBLES_EQUAL(-72.0332531e-6, rows[12][5], 1e-13);
}

TEST(FieldCommand, TellsResidualAndWarnings) {
  const Run run =
      runProgram("field --indenter flat --width-m 2e-3 --friction 1 --centre-deg 0 --radii 2 --angles 2");
  STRCMP_CONTAINS("field: residual ", run.err.c_str());
  STRCMP_CONTAINS("field: warning: ", run.err.c_str());
}

TEST(FieldCommand, RefusesGridsThatAreNone) {
  for (const char* grid : {"--radii 1", "--angles 1", "--from-deg 181", "--to-deg nan"}) {
    const Run run = runProgram(std::string("field --indenter flat --width-m 2e-3 ").append(grid));
    LONGS_EQUAL(2, run.status);
  }
}

TEST(FieldCommand, LooksAtOneRadius) {
  const std::string field = "field --indenter flat --width-m 2e-3 --angles 3 ";
  const auto grid = tableOf(runProgram(field + "--radii 3").out),
             one = tableOf(runProgram(field + "--radius-m 10.8e-3").out);
  LONGS_EQUAL(3, one.size());
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < one[row].size(); ++column)
      DOUBLES_EQUAL(grid[3 + row][column], one[row][column], 1e-9 * std::abs(grid[3 + row][column]));
  LONGS_EQUAL(0, runProgram(field + "--radius-m 12.7e-3").status);
}

TEST(FieldCommand, RefusesARadiusThatCannotBe) {
  const auto refuses = [](const std::string& radius, const char* named) {
    const Run run = runProgram("field --indenter flat --width-m 2e-3 --radius-m " + radius);
    LONGS_EQUAL(2, run.status);
    STRCMP_CONTAINS(named, run.err.c_str());
  };
  refuses("8e-3", "--radius-m");
  refuses("12.699e-3", "--radius-m 0.012699: closer to the surface than 2.2e-05 m");
  refuses("9.4e-3 --radii 3", "excludes");
}

TEST(FieldCommand, RefusesRadiiTooCloseToTheSurfaceBeforeTheFirstRow) {
  const std::string field = "field --indenter flat --width-m 2e-3 --angles 2 --radii ";
  const Run tooMany = runProgram(field + "175");
  LONGS_EQUAL(2, tooMany.status);
  STRCMP_EQUAL("", tooMany.out.c_str());
  STRCMP_CONTAINS("--radii 175: the last radius below the surface would be closer to it than 2.2e-05 m",
                  tooMany.err.c_str());
  STRCMP_CONTAINS("; at most 174 in this finger", tooMany.err.c_str());
  const Run most = runProgram(field + "174");
  LONGS_EQUAL(0, most.status);
  LONGS_EQUAL(2 * 174, tableOf(most.out).size());
}
