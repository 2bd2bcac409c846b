#include <fmt/format.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

#include "host/config/write_config.hpp"
#include "host/study/calibration_session.hpp"
#include "tests/commands/program.hpp"
#include "tests/commands/tables.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

constexpr int kGauges = 16;
constexpr int kTouches = 70;
constexpr std::uint64_t kSeed = 5;
/// A row of strains that a gauge can't read.
constexpr const char* kOverRange = "-0.5,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n";

std::string textOf(const Eigen::MatrixXd& readings) {
  std::string text;
  for (Eigen::Index row = 0; row < readings.rows(); ++row)
    for (Eigen::Index gauge = 0; gauge < readings.cols(); ++gauge)
      text += fmt::format("{}{}", readings(row, gauge), gauge + 1 < readings.cols() ? ',' : '\n');
  return text;
}

std::string textOf(const std::vector<calibration::KnownTouch>& known) {
  const auto cell = [](const std::optional<double>& value) { return value ? fmt::format("{}", *value) : ""; };
  std::string text = "angle_deg,normal_n_per_m,tangential_n_per_m\n";
  for (const auto& touch : known)
    text += fmt::format("{},{},{}\n", cell(touch.angle_deg), cell(touch.normal_n_per_m),
                        cell(touch.tangential_n_per_m));
  return text;
}

}  // namespace

TEST_GROUP(CalibrateCommand) {
  const config::FingerConfig finger = study::randomFinger(kSeed);
  const study::Session session = study::sessionOf(finger, {.touches = kTouches}, kSeed);
  std::string folder;
  std::string readings = textOf(session.readings);

  void setup() override {
    folder = std::string(P_tmpdir) + "/calibrate_test." + std::to_string(getpid());
    std::filesystem::create_directory(folder);
    write("touches.csv", textOf(session.known));
    write("finger.toml", config::writeConfig(finger));
  }
  void teardown() override { std::filesystem::remove_all(folder); }

  void write(const char* name, const std::string& text) { std::ofstream(path(name)) << text; }
  std::string path(const char* name) { return folder + "/" + name; }
  std::string contentOf(const char* name) {
    std::ifstream file(path(name));
    return {std::istreambuf_iterator<char>(file), {}};
  }
  Run calibrate(const std::string& arguments, const std::string& input) {
    return runProgram("calibrate --touches " + path("touches.csv") + " " + arguments, input);
  }
  void refuses(int status, const std::string& arguments, const std::string& input, const char* named) {
    const Run run = calibrate("-o " + path("out.toml") + " " + arguments, input);
    LONGS_EQUAL(status, run.status);
    STRCMP_CONTAINS(named, run.err.c_str());
    CHECK_FALSE(std::filesystem::exists(path("out.toml")));
  }
};

TEST(CalibrateCommand, PrintsEachGaugeWithItsErrorsAndTellsTheRestInWords) {
  const Run run = calibrate("", readings);
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("gauge,angle_deg,gain,sigma_gain,zero_strain,sigma_zero_strain,angle_offset_deg,",
                  run.out.c_str());
  LONGS_EQUAL(kGauges, tableOf(run.out).size());
  STRCMP_CONTAINS("core radius", run.err.c_str());
  STRCMP_CONTAINS("before, as drawn", run.err.c_str());
  STRCMP_CONTAINS(fmt::format("{} rows: ", kTouches).c_str(), run.err.c_str());
}

TEST(CalibrateCommand, PrintsTheWholeFingerAsOneRow) {
  const Run run = calibrate("--summary --json", readings);
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("{\"core_radius_m\":0.00", run.out.c_str());
  STRCMP_CONTAINS("\"arc_before_m\":0.000", run.out.c_str());
}

TEST(CalibrateCommand, PrintsWhatBecameOfEachRow) {
  const std::string nothing = "0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n";
  write("touches.csv", textOf(session.known) + ",,\n,0,0\n");
  const Run run = calibrate("--rows", readings + kOverRange + nothing);
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS(
      "row,use,angle_deg,normal_n_per_m,tangential_n_per_m,width_m,chi_squared,residual_drawn_strain,"
      "residual_strain\n",
      run.out.c_str());
  STRCMP_CONTAINS(
      fmt::format("\n{},over-range,,,,,,,\n{},untouched,,,,,,", kTouches + 1, kTouches + 2).c_str(),
      run.out.c_str());
  STRCMP_CONTAINS(fmt::format("over range: press less: 1 rows: {}\n", kTouches + 1).c_str(), run.err.c_str());
}

TEST(CalibrateCommand, WritesAConfigThatIsReadBackAndMakesTables) {
  write("strains.csv", readings);
  LONGS_EQUAL(0, calibrate("-c " + path("finger.toml") + " --strains " + path("strains.csv") + " -o " +
                               path("out.toml"),
                           "")
                     .status);
  const std::string text = contentOf("out.toml");
  for (const char* const part :
       {"[calibration]\n", "\ngain = [", "\nangle_offset_deg = [", "\ndepth_offset_m = [",
        "\nplace_error_m = ", "\nload_error = 0.0", "\nmoment_error_m2 = ", "\nmodel_error = 0.0"})
    STRCMP_CONTAINS(part, text.c_str());
  CHECK_TRUE(text.find("\nmodel_error = 0.05\n") == std::string::npos);
  LONGS_EQUAL(0, runProgram("tables -c " + path("out.toml") + " -o " + path("tables.bin")).status);
}

TEST(CalibrateCommand, AConfigOfARingThatMarksTurnIsReadBackAndMakesTables) {
  auto turned = session.known;
  for (auto& touch : turned)
    if (touch.angle_deg) *touch.angle_deg += 3;
  write("touches.csv", textOf(turned));
  const Run run = calibrate("-c " + path("finger.toml") + " -o " + path("out.toml"), readings);
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("The known angles turn the ring by ", run.err.c_str());
  const Run tables = runProgram("tables -c " + path("out.toml") + " -o " + path("tables.bin"));
  STRCMP_EQUAL("", tables.out.c_str());
  LONGS_EQUAL(0, tables.status);
}

TEST(CalibrateCommand, WhatIsWrongWithKnownTouchesIsToldOfTheirFile) {
  auto newtons = session.known;
  for (auto& touch : newtons)
    if (touch.normal_n_per_m) *touch.normal_n_per_m *= finger.finger.length_m;
  write("newtons.csv", textOf(newtons));
  const Run run =
      runProgram("calibrate -c " + path("finger.toml") + " --touches " + path("newtons.csv"), readings);
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS(("the normal_n_per_m of " + path("newtons.csv") + " are ").c_str(), run.err.c_str());
}

TEST(CalibrateCommand, AGaugeTooWeakForAnyConfigIsRefusedAndNothingWritten) {
  auto weak = study::sessionOf(finger, {.touches = 150}, kSeed);
  write("touches.csv", textOf(weak.known));
  config::FingerConfig loose = finger;  // else the rows of such a gauge may be left out
  loose.tolerance.gain = 0.3;
  write("loose.toml", config::writeConfig(loose));
  weak.readings.col(6) *= 0.41;
  refuses(1, "-c " + path("loose.toml"), textOf(weak.readings), "gauge 6 (at 135 deg): gain 0.39");
}

TEST(CalibrateCommand, WritesAPageThatSaysWhatTheTablesSay) {
  write("touches.csv", textOf(session.known) + ",,\n");
  write("strains.csv", readings + kOverRange);
  const std::string strains = "--json --strains " + path("strains.csv");
  const Run gauges = calibrate(strains + " --page " + path("page.html"), "");
  LONGS_EQUAL(0, gauges.status);
  write("gauges.json", gauges.out);
  write("summary.json", calibrate(strains + " --summary", "").out);
  const Run check = runShell(std::string(STRAINFINGER_PAGE_CHECK) + " " + path("page.html") + " " +
                                 path("gauges.json") + " " + path("summary.json"),
                             "");
  STRCMP_EQUAL("", check.err.c_str());
  LONGS_EQUAL(0, check.status);
  const std::string page = contentOf("page.html");
  const std::string source =
      fmt::format("<p id=\"source\">Config: the default finger. Rows: {}. Known touches: {}. Calibrated 20",
                  path("strains.csv"), path("touches.csv"));
  STRCMP_CONTAINS(source.c_str(), page.c_str());
  STRCMP_CONTAINS("<th>left over before, microstrain</th>", page.c_str());
}

TEST(CalibrateCommand, APageThatCannotBeMadeIsToldBeforeAnythingIsFitted) {
  write("strains.csv", readings);
  const Run run = runShell("PATH=/none \"$STRAINFINGER\" calibrate --strains " + path("strains.csv") +
                               " -o " + path("out.toml") + " --page " + path("page.html"),
                           "");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("gnuplot is not installed: apt install gnuplot", run.err.c_str());
  CHECK_FALSE(std::filesystem::exists(path("out.toml")));
  CHECK_FALSE(std::filesystem::exists(path("page.html")));
}

TEST(CalibrateCommand, AFingerThatTheFirmwareCannotWorkWithIsTold) {
  write("narrow.toml", "schema = 1\n[contact]\nlargest_width_m = 5e-5\n");
  const Run run = runShell("cd " + folder +
                           " && \"$STRAINFINGER\" run --strains lines.csv >/dev/null 2>&1\n"
                           "\"$STRAINFINGER\" calibrate -c narrow.toml --strains lines.csv -o out.toml");
  LONGS_EQUAL_TEXT(0, run.status, run.err.c_str());
  STRCMP_CONTAINS("calibrate: warning: the firmware cannot work with this finger: ", run.err.c_str());
  CHECK_TRUE(std::filesystem::exists(path("out.toml")));
}

// A finger of which touches at the edge of the friction cone would be told at another place, without a flag,
// by tables that take the gauges for as exactly known as they are.
TEST(CalibrateCommand, AFingerThatTheFirmwareRefusesGetsAModelErrorWithWhichItWorks) {
  write("small.toml",
        "schema = 1\n[finger]\ncore_radius_m = 6e-3\nouter_radius_m = 9.5e-3\nlength_m = 0.015\n"
        "shear_modulus_pa = 1e5\n[gauges]\nradius_m = 7.2e-3\nnoise_strain = 1e-5\n[as_built]\nseed = 7\n"
        "angle_deg = 0.5\ndepth_m = 5e-5\ngain = 0.03\ncore_radius_m = 1e-4\npoisson_ratio = -0.01\n");
  std::string touches = "schema = 1\n";
  for (int i = 0; i < 150; ++i)
    touches += fmt::format(
        "[[touch]]\nstart_s = {:.1f}\nend_s = {:.2f}\nangle_deg = {:.3f}\nnormal_n_per_m = {}\n"
        "tangential_n_per_m = {}\nwidth_m = {}\nprofile = \"hertz\"\n",
        0.5 + 0.4 * i, 0.85 + 0.4 * i, std::fmod(i * 137.508, 360), 8 + 7 * i % 22, 5 * i % 9 - 4,
        5e-4 * (1 + i % 4));
  write("touches.toml", touches);
  const Run run =
      runShell("cd " + folder +
                   " && \"$STRAINFINGER\" run -c small.toml --scenario touches.toml --strains small.csv "
                   "--rows-hz 5 >/dev/null 2>&1\n"
                   "\"$STRAINFINGER\" calibrate -c small.toml --strains small.csv -o small_out.toml && "
                   "\"$STRAINFINGER\" tables -c small_out.toml -o small.tables",
               "");
  LONGS_EQUAL_TEXT(0, run.status, run.err.c_str());
  STRCMP_CONTAINS("calibrate: warning: gauges.model_error has to be 0.0", run.err.c_str());
  STRCMP_CONTAINS("the firmware refuses this finger: small.toml: contacts cannot be located",
                  run.err.c_str());
}

TEST(CalibrateCommand, AFolderThatIsMissingIsToldBeforeAnythingIsFitted) {
  for (const char* option : {"--page", "--output"}) {
    const Run run = calibrate(fmt::format("{} {}", option, path("none/file")), "nonsense");
    LONGS_EQUAL(1, run.status);
    STRCMP_CONTAINS(fmt::format("{} {}: there is no folder {}; make it, or name another", option,
                                path("none/file"), path("none"))
                        .c_str(),
                    run.err.c_str());
  }
}

TEST(CalibrateCommand, PrintsWhatIsToldTogetherOnly) {
  const Run run = calibrate("--correlations", readings);
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("one,other,correlation\n", run.out.c_str());
}

TEST(CalibrateCommand, NeedsNoTouchThatIsKnown) {
  const Run run = runProgram("calibrate", readings);
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("No load is known", run.err.c_str());
}

TEST(CalibrateCommand, NamesTheColumnsThatItDoesNotUse) {
  std::string withTime = "time_s,temperature_c";
  for (int gauge = 0; gauge < kGauges; ++gauge) withTime += fmt::format(",strain_{}", gauge);
  std::istringstream rows(readings);
  for (std::string row; std::getline(rows, row);) withTime += "\n0,21," + row;
  const Run run = calibrate("", withTime);
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("calibrate: of stdin only the strains are used, not time_s, temperature_c\n",
                  run.err.c_str());
}

TEST(CalibrateCommand, StrainsOfAnotherRingAreRefusedForTheConfig) {
  std::string header = "time_s", row = "0";
  for (int gauge = 0; gauge < 24; ++gauge) {
    header += fmt::format(",strain_{}", gauge);
    row += ",0.001";
  }
  refuses(1, "", header + "\n" + row + "\n",
          "the file has strain_16 .. strain_23, but gauges.count = 16: give this finger's config, -c");
}

// As a session leaves them that was copied from a full disk.
TEST(CalibrateCommand, RowsThatWereCutAreLeftOutWithANotice) {
  const std::string touches = textOf(session.known);
  write("touches.csv", touches.substr(0, touches.rfind('\n', touches.size() - 2) + 1));
  Run run = calibrate("", readings.substr(0, readings.size() - 30));
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS(fmt::format("stdin:{}: the file ends in the middle of this line", kTouches).c_str(),
                  run.err.c_str());
  STRCMP_CONTAINS(fmt::format("{} rows: ", kTouches - 1).c_str(), run.err.c_str());
  write("touches.csv", touches.substr(0, touches.size() - 2));  // a row without its last comma
  run = calibrate("", readings);
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS(fmt::format("touches.csv:{}: the file ends in", kTouches + 1).c_str(), run.err.c_str());
  STRCMP_CONTAINS(fmt::format("{} rows: ", kTouches).c_str(), run.err.c_str());
}

TEST(CalibrateCommand, SaysWhatIsWrongAndWhereAndWritesNothing) {
  refuses(1, "", readings.substr(0, readings.rfind("\n", readings.size() - 2) + 1),
          fmt::format("{} rows of strains and {}", kTouches - 1, kTouches).c_str());
  refuses(1, "", "1,2,3\n", "stdin:1:");
  refuses(1, "--strains no/such.csv", "", "no/such.csv");
  refuses(2, "-c no/such.toml", readings, "no/such.toml");
  refuses(2, "--rows --summary", readings, "--summary");
  refuses(2, "--load-error 2", readings, "--load-error");
  write("touches.csv", "0,0,0\n0,20\n");
  refuses(1, "", readings, "touches.csv:2:");
  write("touches.csv", "angle_deg,normal_n_per_m,tangential_n_per_m\n0,0,0\n\n359.269,0,1.06\n");
  refuses(1, "", readings,
          "touches.csv:4: touch 2 has normal_n_per_m = 0: then tangential_n_per_m must be 0");
  write("touches.csv", ",,\n");
  refuses(1, "", readings.substr(0, readings.find('\n') + 1), "too few: at least 32");
}
