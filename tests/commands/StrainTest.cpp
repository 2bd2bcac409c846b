#include <cmath>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

#include "tests/commands/program.hpp"
#include "tests/commands/tables.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

using Table = std::vector<std::vector<double>>;

std::string press(const std::string& more) {
  return "strain --normal-n-per-m 1 --tangential-n-per-m 0 --contact-deg 45 " + more;
}

}  // namespace

TEST_GROUP(StrainCommand) {};

TEST(StrainCommand, PrintsARowAnAngle) {
  const Run run = runProgram(press("--radius-m 9.4e-3 --at-deg 45,-5,365"));
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("angle_deg,err,ett,ert,ur_m,ut_m,trr_pa,trt_pa,ttt_pa\n", run.out.c_str());
  const Table rows = tableOf(run.out);
  LONGS_EQUAL(3, rows.size());
  LONGS_EQUAL(9, rows[0].size());
  DOUBLES_EQUAL(-5, rows[1][0], 0);
  for (std::size_t i = 1; i < 9; ++i) CHECK_TRUE(rows[1][i] != rows[2][i]);
}

// Computed for this project from the boundary-value problem in 60 digits.
TEST(StrainCommand, PrintsTheDefaultFinger) {
  const Table rows = tableOf(runProgram(press("--radius-m 9.4e-3 --at-deg 45,50,65,225")).out);
  DOUBLES_EQUAL(-460.6030e-6, rows[0][1], 0.00005e-6);
  DOUBLES_EQUAL(-307.47e-6, rows[1][1], 0.005e-6);
  DOUBLES_EQUAL(130.53e-6, rows[2][1], 0.005e-6);
  DOUBLES_EQUAL(0.2733e-6, rows[3][1], 0.00005e-6);
}

// Column by column: Hooke's law for plane strain, nu = 1/2, mu = 8.3e4.
TEST(StrainCommand, StressesBelongToTheStrains) {
  for (const auto& row : tableOf(runProgram(press("--radius-m 9.4e-3 --points 7")).out)) {
    DOUBLES_EQUAL(row[1], (row[6] - row[8]) / 2 / 1.66e5, 1e-17);
    DOUBLES_EQUAL(row[2], -row[1], 0);
    DOUBLES_EQUAL(row[3], row[7] / 1.66e5, 1e-17);
  }
}

TEST(StrainCommand, SpreadsPointsEvenly) {
  const Table rows = tableOf(runProgram(press("--radius-m 9.4e-3 --points 16")).out);
  LONGS_EQUAL(16, rows.size());
  for (std::size_t i = 0; i < rows.size(); ++i) DOUBLES_EQUAL(22.5 * static_cast<double>(i), rows[i][0], 0);
}

// As tests/data/fem.csv, by collocation: spread over +-0.25 deg, printed to 1e-10.
TEST(StrainCommand, TangentialLoadsPointToTheta) {
  const Table rows = tableOf(runProgram("strain --radius-m 9.4e-3 --normal-n-per-m 0 --tangential-n-per-m 1 "
                                        "--contact-deg 0 --at-deg 0,5 --width-m 1.1082840750e-4")
                                 .out);
  DOUBLES_EQUAL(411.3750e-6, rows[0][3], 0.0001e-6);
  DOUBLES_EQUAL(-131.1386e-6, rows[1][1], 0.0001e-6);
  CHECK_TRUE(rows[0][5] > 0);
}

// The midpoint rule over the width, turned into gauge angles.
TEST(StrainCommand, AWidthAveragesLineLoads) {
  constexpr double kWidth_deg = 2e-3 / 12.7e-3 * 180 / std::numbers::pi;
  constexpr int kPoints = 200;
  std::string angles;
  for (int i = 0; i < kPoints; ++i)
    angles.append(i == 0 ? "" : ",").append(std::to_string(50 + ((i + 0.5) / kPoints - 0.5) * kWidth_deg));
  double sum = 0;
  for (const auto& row : tableOf(runProgram(press("--radius-m 9.4e-3 --at-deg " + angles)).out))
    sum += row[1];
  const Table wide = tableOf(runProgram(press("--radius-m 9.4e-3 --at-deg 50 --width-m 2e-3")).out);
  DOUBLES_EQUAL(sum / kPoints, wide[0][1], 1e-9);  // curvature * step^2 / 24, and six digits of angles
}

TEST(StrainCommand, AtTheSurfaceAWideLoadIsItsOwnPressure) {
  const Table rows = tableOf(runProgram(press("--radius-m 12.7e-3 --at-deg 45,48,55 --width-m 2e-3")).out);
  DOUBLES_EQUAL(-500, rows[0][6], 1e-10);
  DOUBLES_EQUAL(-500, rows[1][6], 1e-10);
  DOUBLES_EQUAL(0, rows[2][6], 1e-10);
}

TEST(StrainCommand, AtTheCoreNothingMoves) {
  for (const auto& row : tableOf(runProgram(press("--radius-m 8.9e-3 --points 5")).out)) {
    DOUBLES_EQUAL(0, row[4], 0);
    DOUBLES_EQUAL(0, row[5], 0);
  }
}

TEST(StrainCommand, PrintsJson) {
  STRCMP_CONTAINS("{\"angle_deg\":0.0,\"err\":",
                  runProgram(press("--radius-m 9e-3 --points 1 --json")).out.c_str());
}

TEST(StrainCommand, RefusesALineLoadAtTheSurface) {
  checkRefused(press("--radius-m 12.7e-3 --points 1"), "--width-m");
  checkRefused(press("--radius-m 12.69999e-3 --points 1"), "too close to the surface");
}

TEST(StrainCommand, RefusesARadiusOutsideTheRubber) {
  for (const char* radius : {"8.8999e-3", "12.7001e-3", "nan", "inf", "x"})
    checkRefused(press(std::string("--points 1 --radius-m ").append(radius)), "--radius-m");
}

TEST(StrainCommand, RefusesAWidthThatIsNone) {
  for (const char* width : {"-1e-3", "0.08", "nan", "inf", "x"})
    checkRefused(press(std::string("--radius-m 9e-3 --points 1 --width-m ").append(width)), "--width-m");
}

TEST(StrainCommand, WantsAnglesOneWay) {
  for (const char* angles : {"", "--at-deg 1 --points 1"})
    checkRefused(press(std::string("--radius-m 9e-3 ").append(angles)),
                 "either --at-deg a,b,... or --points N");
}

TEST(StrainCommand, RefusesAnglesThatAreNone) {
  for (const char* angles : {"1,x", "nan", "1,inf", "1e7", "''"})
    checkRefused(press(std::string("--radius-m 9e-3 --at-deg ").append(angles)), "--at-deg");
  for (const char* points : {"0", "-1", "1000001", "1.5", "nan"})
    checkRefused(press(std::string("--radius-m 9e-3 --points ").append(points)), "--points");
}

TEST(StrainCommand, RefusesLoadsThatAreNone) {
  const std::string rest = "--radius-m 9e-3 --points 1 --contact-deg 0 ";
  for (const char* load : {"nan", "inf", "-1e13", "x"}) {
    const std::string value(load);
    checkRefused("strain " + rest + "--tangential-n-per-m 0 --normal-n-per-m " + value, "--normal-n-per-m");
    checkRefused("strain " + rest + "--normal-n-per-m 0 --tangential-n-per-m " + value,
                 "--tangential-n-per-m");
  }
}

TEST(StrainCommand, NoAngleOfAListIsEmpty) {
  for (const std::string list : {"1,,2", "1,", ",1", "''"})
    checkRefused(press("--radius-m 9e-3 --at-deg " + list), "--at-deg: an item of ");
  checkRefused(press("--radius-m 9e-3 --at-deg 1,,2"), "1,,2");
  checkRefused(press("--radius-m 9e-3 --at-deg 1,x"), "x is not a number");
}

TEST(StrainCommand, NamesWhatIsMissing) {
  checkRefused("strain --radius-m 9e-3 --points 1 --contact-deg 0", "--normal-n-per-m");
  checkRefused("strain --radius-m 9e-3 --points 1 --normal-n-per-m 1 --tangential-n-per-m 0",
               "--contact-deg");
}

TEST(StrainCommand, WithoutATangentialLoadThereIsNone) {
  const std::string load = "strain --radius-m 9e-3 --at-deg 0,5 --contact-deg 0 --normal-n-per-m 1";
  STRCMP_EQUAL(runProgram(load + " --tangential-n-per-m 0").out.c_str(), runProgram(load).out.c_str());
}

// Of any component, at any angle.
TEST(StrainCommand, WarnsOfStrainsThatAreNotSmall) {
  const auto told = [](const char* load_n_per_m) {
    return runProgram("strain --radius-m 12e-3 --at-deg 90,0 --contact-deg 0 --normal-n-per-m " +
                      std::string(load_n_per_m))
        .err;
  };
  const double one =
      tableOf(runProgram("strain --radius-m 12e-3 --at-deg 0 --contact-deg 0 --normal-n-per-m 1").out)[0][1];
  STRCMP_EQUAL("", told(std::to_string(0.49 / std::abs(one)).c_str()).c_str());
  STRCMP_CONTAINS("strain: warning: strains of up to 0.51: the model is for small ones",
                  told(std::to_string(0.51 / std::abs(one)).c_str()).c_str());
}
