#include <sstream>
#include <string>
#include <vector>

#include "tests/commands/program.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(LocateCommand){
    static std::vector<std::string> lines(const std::string& text){std::vector<std::string> result;
std::istringstream stream(text);
for (std::string line; std::getline(stream, line);) result.push_back(line);
return result;
}
/// A row of radial strains of the 16 gauges, as `strain` has them.
static std::string touchAt(const std::string& angle_deg) {
  return runShell(
             "\"$STRAINFINGER\" strain --radius-m 9.4e-3 --normal-n-per-m 30 --tangential-n-per-m 10 "
             "--contact-deg " +
             angle_deg + " --points 16 | tail -n +2 | cut -d, -f2 | paste -sd,")
      .out;
}
static std::string nothing() { return "0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n"; }
static void checkComplaint(const char* message, const std::string& input) {
  const Run run = runProgram("locate", input);
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS(message, run.err.c_str());
}
}
;

TEST(LocateCommand, FindsWhatTheModelSays) {
  for (const char* mode : {"", "--mode refined", "--mode three-point"}) {
    const auto out = lines(runProgram(std::string("locate ") + mode, touchAt("100")).out);
    LONGS_EQUAL(2, out.size());
    STRCMP_EQUAL(
        "contact,angle_deg,normal_n_per_m,tangential_n_per_m,sigma_angle_deg,sigma_normal_n_per_m,"
        "sigma_tangential_n_per_m,quality",
        out[0].c_str());
    double contact = 0, angle = 0, normal = 0, tangential = 0;
    LONGS_EQUAL(4, std::sscanf(out[1].c_str(), "%lf,%lf,%lf,%lf", &contact, &angle, &normal, &tangential));
    DOUBLES_EQUAL(1, contact, 0);
    DOUBLES_EQUAL(100, angle, 0.03);  // 6 um of arc
    DOUBLES_EQUAL(30, normal, 0.03);
    DOUBLES_EQUAL(10, tangential, 0.03);
  }
}

TEST(LocateCommand, ASampleWithoutContactHasEmptyColumns) {
  const auto out = lines(runProgram("locate", nothing() + touchAt("10") + nothing()).out);
  LONGS_EQUAL(4, out.size());
  STRCMP_EQUAL("0,,,,,,,", out[1].c_str());
  STRCMP_CONTAINS("1,", out[2].c_str());
  STRCMP_EQUAL("0,,,,,,,", out[3].c_str());
}

TEST(LocateCommand, JsonHasAnObjectALine) {
  const auto out = lines(runProgram("locate --json", nothing()).out);
  LONGS_EQUAL(1, out.size());
  STRCMP_CONTAINS("{\"contact\":0,\"angle_deg\":null,", out[0].c_str());
}

TEST(LocateCommand, BadRowsAreNamedWithTheirPlace) {
  checkComplaint("stdin:2:3: \"x\" is no number", nothing() + "0,x,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n");
  checkComplaint("stdin:1:4: 2 columns where 16 are needed", "0,0\n");
  checkComplaint("nan is no finite number", "nan,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n");
}

TEST(LocateCommand, TablesOfAnotherFingerAreAMismatch) {
  const Run run = runShell(
      "folder=$(mktemp -d) && trap 'rm -rf \"$folder\"' EXIT && cd \"$folder\" && "
      "printf 'schema = 1\\n[gauges]\\ncount = 24\\n' >more.toml && \"$STRAINFINGER\" tables -o "
      "finger.tables && "
      "\"$STRAINFINGER\" locate -c more.toml --tables finger.tables </dev/null");
  LONGS_EQUAL(5, run.status);
  STRCMP_CONTAINS("gauges.count", run.err.c_str());
}

TEST(LocateCommand, AnUnknownModeIsAUsageError) { LONGS_EQUAL(2, runProgram("locate --mode guess").status); }
