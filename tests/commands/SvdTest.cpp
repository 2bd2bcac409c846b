#include <cmath>
#include <string>

#include "tests/commands/program.hpp"
#include "tests/commands/tables.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(SvdCommand) {
  static void refuses(const std::string& arguments, const std::string& named) {
    const Run run = runProgram("svd " + arguments);
    LONGS_EQUAL(2, run.status);
    STRCMP_EQUAL("", run.out.c_str());
    STRCMP_CONTAINS(named.c_str(), run.err.c_str());
  }

  static long above(const std::string& arguments, double relative) {
    long count = 0;
    for (const auto& row : tableOf(runProgram("svd " + arguments).out)) count += row[2] > relative;
    return count;
  }
};

TEST(SvdCommand, PrintsValuesInTheColumnsScriptsRelyOn) {
  const Run run = runProgram("svd --width-m 2e-3 --harmonics 300");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("index,singular_value,relative\n1,", run.out.c_str());
  const auto rows = tableOf(run.out);
  DOUBLES_EQUAL(1, rows[0][2], 0);
  DOUBLES_EQUAL(0.944505742, rows[1][2], 1e-9);
  DOUBLES_EQUAL(rows[1][2], rows[1][1] / rows[0][1], 1e-16);
}

TEST(SvdCommand, CountsAsThePaper) {
  for (const char* more : {"", " --window full", " --rows printed"}) {
    const std::string arguments = std::string("--width-m 2e-3 --harmonics 300").append(more);
    LONGS_EQUAL(8, above(arguments, 0.1));
    LONGS_EQUAL(11, above(arguments, 0.01));
  }
  LONGS_EQUAL(7, above("--width-m 2e-3 --harmonics 300 --frictionless", 0.1));
}

TEST(SvdCommand, PrintsShapesAndPressures) {
  const Run run = runProgram("svd --width-m 2e-3 --harmonics 300 --basis 2 --points 5");
  STRCMP_CONTAINS("index,angle_deg,shape_m,slope,pressure_pa,shear_pa\n", run.out.c_str());
  const auto rows = tableOf(run.out);
  LONGS_EQUAL(10, rows.size());
  DOUBLES_EQUAL(0, rows[2][1], 1e-15);
  DOUBLES_EQUAL(rows[0][2], rows[4][2], 1e-12 * std::abs(rows[0][2]));   // an even shape,
  DOUBLES_EQUAL(rows[0][3], -rows[4][3], 1e-12 * std::abs(rows[0][3]));  // its slope,
  DOUBLES_EQUAL(rows[6][4], -rows[8][4], 1e-12 * std::abs(rows[6][4]));  // and the odd pressure of the next
}

TEST(SvdCommand, PrintsJson) {
  STRCMP_CONTAINS("{\"index\":1,\"singular_value\":",
                  runProgram("svd --width-m 2e-3 --harmonics 100 --json").out.c_str());
}

TEST(SvdCommand, RefusesWhatIsNone) {
  refuses("--harmonics 300", "--width-m");
  refuses("--width-m 2e-3", "--harmonics");
  for (const char* width : {"0", "-1", "0.05", "nan"})
    refuses(std::string("--harmonics 300 --width-m ").append(width), "width");
  refuses("--harmonics 300 --width-m 0.05", "half the surface, 0.0398982 m");
  refuses("--width-m 2e-3 --harmonics 20 --basis 25", "there are 24 pairs");
  refuses("--width-m 2e-3 --harmonics 20 --points 5", "--points requires --basis");
  refuses("--width-m 2e-3 --harmonics 1", "1 is not a whole number from 2");
  refuses("--width-m 2e-3 --harmonics 300 --basis 0", "--basis");
  refuses("--width-m 2e-3 --harmonics 300 --rows x", "--rows");
}
