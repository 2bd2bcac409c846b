#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/commands/program.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

std::vector<double> numbersOf(const std::string& line) {
  std::istringstream fields(line);
  std::vector<double> numbers;
  for (std::string field; std::getline(fields, field, ',');) numbers.push_back(std::stod(field));
  return numbers;
}

std::vector<std::string> linesOf(const std::string& text) {
  std::istringstream stream(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(stream, line);) lines.push_back(line);
  return lines;
}

void refuses(const std::string& arguments, const char* named) {
  checkRefused("response " + arguments, named);
}

}  // namespace

TEST_GROUP(ResponseCommand) {};

TEST(ResponseCommand, PrintsARowAHarmonic) {
  const Run run = runProgram("response --radius-m 9.4e-3 --harmonics 20");
  LONGS_EQUAL(0, run.status);
  STRCMP_EQUAL("", run.err.c_str());
  const auto lines = linesOf(run.out);
  LONGS_EQUAL(22, lines.size());
  STRCMP_EQUAL("n,err_p,err_q,ett_p,ett_q,trt_p,trt_q,ur_p,ur_q,ut_p,ut_q", lines[0].c_str());
}

// err_p, err_q, trt_p, trt_q at n = 7: computed for this project in 60 digits, printed to 10. Incompressible,
// so ett = -err.
TEST(ResponseCommand, PrintsTheDefaultFinger) {
  const auto row = numbersOf(linesOf(runProgram("response --radius-m 9.4e-3 --harmonics 7").out).at(8));
  LONGS_EQUAL(11, row.size());
  const double known[] = {
      7, 1.72020813e-6, -6.516476037e-7, -1.72020813e-6, 6.516476037e-7, 0.3121293913, -0.09658101564};
  for (std::size_t i = 0; i < 7; ++i) DOUBLES_EQUAL(known[i], row[i], 1e-9 * std::abs(known[i]));
}

// e_tt = (u_r - n u_t) / r is in no column's formula.
TEST(ResponseCommand, DisplacementsBelongToTheStrains) {
  const auto row = numbersOf(linesOf(runProgram("response --radius-m 9.4e-3 --harmonics 3").out).at(4));
  DOUBLES_EQUAL(row[3], (row[7] - 3 * row[9]) / 9.4e-3, 1e-13 * std::abs(row[3]));
  DOUBLES_EQUAL(row[4], (row[8] - 3 * row[10]) / 9.4e-3, 1e-13 * std::abs(row[4]));
}

TEST(ResponseCommand, TakesTheFingerOfTheConfig) {
  const Run run = runShell(
      "f=$(mktemp); printf 'schema = 1\\n[finger]\\nshear_modulus_pa = 166000.0\\n' > $f; "
      "\"$STRAINFINGER\" response -c $f --radius-m 9.4e-3 --harmonics 2; rm $f");
  const auto soft = numbersOf(linesOf(runProgram("response --radius-m 9.4e-3 --harmonics 2").out).at(3));
  DOUBLES_EQUAL(soft[1] / 2, numbersOf(linesOf(run.out).at(3)).at(1), 1e-20);
}

TEST(ResponseCommand, PrintsJson) {
  const Run run = runProgram("response --radius-m 12.7e-3 --harmonics 0 --json");
  STRCMP_CONTAINS("{\"n\":0,\"err_p\":0.0,", run.out.c_str());
  LONGS_EQUAL(1, linesOf(run.out).size());
}

TEST(ResponseCommand, NeverPrintsWhatIsNotANumber) {
  const Run run = runProgram("response --radius-m 9.4e-3 --harmonics 20000 | grep -ci -e nan -e inf -e ',,'");
  STRCMP_EQUAL("0\n", run.out.c_str());
}

TEST(ResponseCommand, TakesBothEndsOfTheRubber) {
  for (const char* radius : {"8.9e-3", "12.7e-3"})
    LONGS_EQUAL(0, runProgram(std::string("response --harmonics 2 --radius-m ").append(radius)).status);
}

TEST(ResponseCommand, RefusesARadiusOutsideTheRubber) {
  for (const char* radius : {"8.8999e-3", "12.7001e-3", "-9e-3", "0", "nan", "inf", "9 mm", "x", "1e999"})
    refuses(std::string("--harmonics 2 --radius-m '").append(radius).append("'"), "--radius-m");
}

TEST(ResponseCommand, RefusesAnAbsurdNumberOfHarmonics) {
  for (const char* harmonics : {"-1", "1000001", "99999999999999999999", "1.5", "nan", "x"})
    refuses(std::string("--radius-m 9e-3 --harmonics ").append(harmonics), "--harmonics");
}

TEST(ResponseCommand, NamesWhatIsMissing) {
  refuses("--harmonics 2", "--radius-m");
  refuses("--radius-m 9e-3", "--harmonics");
}

TEST(ResponseCommand, ABadConfigIsNamed) {
  refuses("--radius-m 9e-3 --harmonics 2 -c /nowhere/finger.toml", "/nowhere/finger.toml");
}
