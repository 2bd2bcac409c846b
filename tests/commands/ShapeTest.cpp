#include <cmath>
#include <string>
#include <vector>

#include "tests/commands/program.hpp"
#include "tests/commands/tables.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

/// A row of radial strains of the default finger's 16 gauges, as `strain` has them.
std::string readings(const std::string& load) {
  return runShell("\"$STRAINFINGER\" strain --radius-m 9.4e-3 --points 16 " + load +
                  " | tail -n +2 | cut -d, -f2 | paste -sd,")
      .out;
}

std::string touch() {
  return readings("--normal-n-per-m 20 --tangential-n-per-m 5 --contact-deg 100 --width-m 3e-3");
}

/// `shape` of a finger that is exactly as drawn.
Run runPerfect(const std::string& arguments, const std::string& input) {
  return runShell(
      "\"$STRAINFINGER\" shape -c <(printf 'schema = 1\n[gauges]\nmodel_error = 0\n') " + arguments, input);
}

/// The first row of the output, and its fields.
std::string rowOf(const std::string& arguments, const std::string& input) {
  const Run run = runPerfect(arguments, input);
  LONGS_EQUAL(0, run.status);
  const auto begin = run.out.find('\n') + 1;
  return run.out.substr(begin, run.out.find('\n', begin) - begin);
}

std::vector<std::string> cellsOf(const std::string& row) {
  std::vector<std::string> fields(1);
  for (const char c : row) {
    if (c == ',')
      fields.emplace_back();
    else
      fields.back().push_back(c);
  }
  return fields;
}

std::vector<std::string> shapeOf(const std::string& arguments, const std::string& input) {
  return cellsOf(rowOf(arguments, input));
}

void refuses(int status, const std::string& arguments, const std::string& input, const char* named) {
  const Run run = runProgram("shape " + arguments, input);
  LONGS_EQUAL(status, run.status);
  STRCMP_CONTAINS(named, run.err.c_str());
}

}  // namespace

TEST_GROUP(ShapeCommand) {};

// A uniform load 3 mm wide has the second moment of a semi-ellipse 3.464 mm wide.
TEST(ShapeCommand, TellsWhatPressed) {
  const auto shape = shapeOf("", touch());
  LONGS_EQUAL(20, shape.size());
  STRCMP_EQUAL("1", shape[0].c_str());
  DOUBLES_EQUAL(100, std::stod(shape[1]), 0.02);
  DOUBLES_EQUAL(20, std::stod(shape[2]), 0.02);
  DOUBLES_EQUAL(5, std::stod(shape[3]), 0.02);
  DOUBLES_EQUAL(3.464e-3, std::stod(shape[4]), 0.05e-3);  // its fourth moment is another
  CHECK_TRUE(std::stod(shape[9]) > 1e-6 && std::stod(shape[9]) < 0.1e-3);
}

// Gauges off the drawing by a degree, 0.06 mm and 10 % in turn, so that as drawn nothing fits.
TEST(ShapeCommand, TellsWhatPressedOnACalibratedFinger) {
  const Run run = runShell(R"sh(folder=$(mktemp -d) && trap 'rm -rf "$folder"' EXIT && cd "$folder"
inTurn() { echo "[$1, $2, $1, $2, $1, $2, $1, $2, $1, $2, $1, $2, $1, $2, $1, $2]"; }
echo "schema = 1
[gauges]
model_error = 0
[calibration]
gain = $(inTurn 0.9 1.1)
angle_offset_deg = $(inTurn 1 -1)
depth_offset_m = $(inTurn 6e-5 -6e-5)" >calibrated.toml
echo "schema = 1
[[touch]]
start_s = 0.2
end_s = 0.5
angle_deg = 101
normal_n_per_m = 20
tangential_n_per_m = 5" >touch.toml
"$STRAINFINGER" run -c calibrated.toml --scenario touch.toml --duration 0.45 --strains strains.csv >/dev/null 2>&1
(head -1 strains.csv; tail -1 strains.csv) | "$STRAINFINGER" shape -c calibrated.toml)sh");
  LONGS_EQUAL(0, run.status);
  const auto shape = cellsOf(run.out.substr(run.out.find('\n') + 1));
  DOUBLES_EQUAL(101, std::stod(shape[1]), 0.1);
  DOUBLES_EQUAL(20, std::stod(shape[2]), 0.2);
  DOUBLES_EQUAL(5, std::stod(shape[3]), 0.2);
  STRCMP_EQUAL("", shape[17].c_str());
}

TEST(ShapeCommand, HasItsColumns) {
  STRCMP_CONTAINS(
      "contact,angle_deg,normal_n_per_m,tangential_n_per_m,width_m,curvature_per_m,sigma_angle_deg,"
      "sigma_normal_n_per_m,sigma_tangential_n_per_m,sigma_width_m,sigma_curvature_per_m,width_limit_m,"
      "directions,class,unresolved,fit_probability,rival_angle_deg,warnings,"
      "curvature_low_per_m,curvature_high_per_m\n",
      runProgram("shape", "").out.c_str());
}

TEST(ShapeCommand, ALineHasALimitOfItsWidthOnly) {
  const auto shape = shapeOf("", readings("--normal-n-per-m 1 --tangential-n-per-m 0 --contact-deg 350"));
  DOUBLES_EQUAL(350, std::stod(shape[1]), 0.1);
  for (const std::size_t unknown : {4U, 5U, 9U, 10U, 13U}) STRCMP_EQUAL("", shape[unknown].c_str());
  CHECK_TRUE(std::stod(shape[11]) > 0.1e-3 && std::stod(shape[11]) < 5e-3);
  STRCMP_EQUAL("width class odd-part", shape[14].c_str());
}

// The gauge next to the touch stops at the end of its range.
TEST(ShapeCommand, ReadingsAtTheEndOfTheRangeAreLeftOut) {
  std::string row = readings("--normal-n-per-m 60 --tangential-n-per-m 5 --contact-deg 91");
  auto cells = cellsOf(row);
  CHECK_TRUE(std::stod(cells[4]) < -0.027);
  cells[4] = "-0.0297";
  row.clear();
  for (const std::string& cell : cells) row += (row.empty() ? "" : ",") + cell;
  const auto shape = shapeOf("", row);
  STRCMP_EQUAL("saturated", shape[17].c_str());
  DOUBLES_EQUAL(91, std::stod(shape[1]), 3 * std::stod(shape[6]));
  DOUBLES_EQUAL(60, std::stod(shape[2]), 3 * std::stod(shape[7]));
}

// Of a finger that may be 5 % off, less readings tell less.
TEST(ShapeCommand, WithoutItsLargestReadingATouchIsNoSurer) {
  const std::string row = readings("--normal-n-per-m 64 --tangential-n-per-m 5 --contact-deg 90");
  const auto sigmaOf = [&](const char* fullScale) {
    const Run run = runShell(std::string("\"$STRAINFINGER\" shape -c <(printf 'schema = 1\n[gauges]\n"
                                         "adc_bits = 14\nfull_scale_strain = ") +
                                 fullScale + "\n')",
                             row);
    return std::stod(cellsOf(run.out.substr(run.out.find('\n') + 1))[7]);
  };
  CHECK_COMPARE(sigmaOf("0.03"), >, 0.7 * sigmaOf("0.06"));
}

TEST(ShapeCommand, ATouchThatOnlyLeftOutGaugesFeelIsOne) {
  STRCMP_EQUAL("1,,,,,,,,,,,,,,,,,saturated,,", rowOf("", ".03,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n").c_str());
}

TEST(ShapeCommand, OfMoreThanHalfTheGaugesAtTheEndOfTheirRangeNothingIsTold) {
  STRCMP_EQUAL("1,,,,,,,,,,,,,,,,,saturated,,",
               rowOf("", ".03,.03,.03,.03,.03,.03,.03,.03,.03,0,0,0,0,0,0,0\n").c_str());
}

TEST(ShapeCommand, AnUntouchedFingerHasNoShape) {
  const std::string none = "0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n";
  STRCMP_EQUAL("0,,,,,,,,,,,,,,,,,,,", rowOf("", none).c_str());
  const Run pressure = runProgram("shape --pressure", none);
  STRCMP_EQUAL("sample,angle_deg,pressure_pa,low_pa,high_pa,ellipse_pa\n", pressure.out.c_str());
}

TEST(ShapeCommand, ABandHoldsTheCurvature) {
  const auto shape = shapeOf("", touch());
  const double low = std::stod(shape[18]), curvature = std::stod(shape[5]), high = std::stod(shape[19]);
  DOUBLES_EQUAL(2 * 1.96 * std::stod(shape[10]), high - low, 0.2 * (high - low));
  CHECK_TRUE(low < curvature && curvature - low < high - curvature);
}

// 16 gauges 1.4 mm deep: a pitch of 3.6 depths.
TEST(ShapeCommand, ASparseRingTellsNoWidth) {
  const Run run = runShell(
      "config=$(mktemp) && trap 'rm $config' EXIT && "
      "printf 'schema = 1\\n[finger]\\ncore_radius_m = 0.0108\\n[gauges]\\nradius_m = 0.0113\\n' >$config && "
      "echo 0,1e-3,5e-3,1e-3,0,0,0,0,0,0,0,0,0,0,0,0 | \"$STRAINFINGER\" shape -c $config");
  STRCMP_CONTAINS("width class odd-part", run.out.c_str());
  STRCMP_CONTAINS("sparse", run.out.c_str());
}

TEST(ShapeCommand, MoreNoiseTellsLess) {
  const double sigma = std::stod(shapeOf("", touch())[6]);
  DOUBLES_EQUAL(3 * sigma, std::stod(shapeOf("--noise-strain 1.8e-5", touch())[6]), 0.02 * sigma);
}

TEST(ShapeCommand, AWidthThatHangsOnThePressuresProfileIsWarnedOf) {
  const auto strains =
      readings("--normal-n-per-m 20 --tangential-n-per-m 0 --contact-deg 100 --width-m 4e-3");
  STRCMP_EQUAL("profile", shapeOf("--noise-strain 6e-6", strains)[17].c_str());
  STRCMP_EQUAL("", shapeOf("--noise-strain 6e-4", strains)[17].c_str());
}

TEST(ShapeCommand, WhatIsNoTouchOfThisFingerIsWarnedOf) {
  const auto shape =
      shapeOf("--noise-strain 1e-6",
              readings("--normal-n-per-m 20 --tangential-n-per-m 0 --contact-deg 100 --width-m 20e-3"));
  STRCMP_CONTAINS("misfit", shape[17].c_str());
}

// `strain` spreads its load evenly.
TEST(ShapeCommand, NamesAClassThatFitsAlone) {
  const auto shape = shapeOf("--noise-strain 1e-9", touch());
  STRCMP_EQUAL("uniform", shape[13].c_str());
  CHECK_TRUE(std::stod(shape[15]) > 0.1);
  STRCMP_EQUAL("", shape[17].c_str());
}

TEST(ShapeCommand, PrintsTheResolvedPressureWithItsBand) {
  const Run run = runPerfect("--pressure --points 5", touch() + touch());
  const auto rows = tableOf(run.out);
  LONGS_EQUAL(10, rows.size());
  DOUBLES_EQUAL(2, rows[5][0], 0);
  DOUBLES_EQUAL(100, rows[2][1], 0.02);
  CHECK_TRUE(rows[2][3] < rows[2][2] && rows[2][2] < rows[2][4]);
  DOUBLES_EQUAL(rows[2][2] - rows[2][3], rows[2][4] - rows[2][2], 1e-9);
  DOUBLES_EQUAL(4 * 20 / (3.14159265 * 3.464e-3), rows[2][5], 0.02 * rows[2][5]);  // 2 P / (pi a)
  DOUBLES_EQUAL(0, rows[0][5], 1);
}

TEST(ShapeCommand, PrintsJson) {
  STRCMP_CONTAINS("{\"contact\":1,\"angle_deg\":", runProgram("shape --json", touch()).out.c_str());
}

TEST(ShapeCommand, WhatCannotBeReadIsNoInputWithoutRows) {
  const Run run = runShell("\"$STRAINFINGER\" shape </");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("stdin: cannot read: Is a directory", run.err.c_str());
}

// Incompressible rubber has no radial strain where it is bonded.
TEST(ShapeCommand, GaugesThatReadNothingAreRefused) {
  const Run run =
      runShell("\"$STRAINFINGER\" shape -c <(printf 'schema = 1\n[gauges]\nradius_m = 0.0089\n')", touch());
  LONGS_EQUAL(2, run.status);
  STRCMP_EQUAL("", run.out.c_str());
  STRCMP_CONTAINS("gauges.radius_m = 0.0089 is on the core, where the rubber has no radial strain",
                  run.err.c_str());
}

TEST(ShapeCommand, SaysWhatIsWrongAndWhere) {
  refuses(1, "", "1,2,3\n", "stdin:1:");
  refuses(2, "--noise-strain 0", "", "--noise-strain");
  refuses(2, "--noise-strain nan", "", "--noise-strain");
  refuses(2, "--points 5", "", "--points requires --pressure");
  refuses(1, "", "0,1e300,0\n", "stdin:1:3: 1e300 is beyond +-1");
  refuses(2, "--points 1 --pressure", "", "--points");
  refuses(2, "-c no/such.toml", "", "no/such.toml");
}
