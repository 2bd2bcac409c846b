#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "tests/commands/program.hpp"
#include "tests/commands/tables.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

constexpr int kGauges = 16;
constexpr double kPitch_deg = 360.0 / kGauges;

double gainOf(int gauge) { return 1 + 0.01 * (gauge % 7) - 0.03; }

/// Strains of the default finger's gauges under a touch over the first, as `strain` has them.
std::vector<double> strainsBelow(const std::string& loads) {
  std::vector<double> strains;
  for (const auto& row :
       tableOf(runProgram("strain --radius-m 9.4e-3 --points 16 --contact-deg 0 " + loads).out))
    strains.push_back(row[1]);
  return strains;
}

}  // namespace

TEST_GROUP(CalibrateCommand) {
  std::string folder;
  std::string touches = "angle_deg,normal_n_per_m,tangential_n_per_m\n0,0,0\n";
  std::string readings = "0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n";

  /// A touch over each gauge in turn, read with gains of their own.
  void setup() override {
    folder = std::string(P_tmpdir) + "/calibrate_test." + std::to_string(getpid());
    std::filesystem::create_directory(folder);
    const auto strains = strainsBelow("--normal-n-per-m 20 --tangential-n-per-m 5");
    for (int touched = 0; touched < kGauges; ++touched) {
      touches += std::to_string(kPitch_deg * touched) + ",20,5\n";
      for (int gauge = 0; gauge < kGauges; ++gauge) {
        const double strain = strains[static_cast<std::size_t>((gauge - touched + kGauges) % kGauges)];
        readings += std::to_string(1e6 * gainOf(gauge) * strain) + (gauge + 1 < kGauges ? "e-6," : "e-6\n");
      }
    }
    write("touches.csv", touches);
  }
  void teardown() override { std::filesystem::remove_all(folder); }

  void write(const char* name, const std::string& text) { std::ofstream(path(name)) << text; }
  std::string path(const char* name) { return folder + "/" + name; }
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

TEST(CalibrateCommand, PrintsTheGainOfEachGauge) {
  const Run run = calibrate("", readings);
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("gauge,angle_deg,gain,sigma_gain,zero_strain,sigma_zero_strain,residual_strain\n",
                  run.out.c_str());
  const auto rows = tableOf(run.out);
  LONGS_EQUAL(kGauges, rows.size());
  for (int gauge = 0; gauge < kGauges; ++gauge) {
    const auto& row = rows[static_cast<std::size_t>(gauge)];
    DOUBLES_EQUAL(kPitch_deg * gauge, row[1], 0);
    DOUBLES_EQUAL(gainOf(gauge), row[2], 1e-6);  // the readings have 1e-12 of strain
    DOUBLES_EQUAL(0, row[4], 1e-9);
  }
}

TEST(CalibrateCommand, WritesAConfigThatIsReadBack) {
  write("strains.csv", readings);
  LONGS_EQUAL(0, calibrate("--strains " + path("strains.csv") + " -o " + path("out.toml"), "").status);
  std::ifstream file(path("out.toml"));
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  STRCMP_CONTAINS("[calibration]\n", text.c_str());
  STRCMP_CONTAINS("\ngain = [0.97, 0.98, 0.99, 1, 1.01, ", text.c_str());
  LONGS_EQUAL(0, calibrate("-c " + path("out.toml"), readings).status);
}

TEST(CalibrateCommand, RowsWithoutUntouchedOnesLeaveTheZeroUnknown) {
  write("touches.csv", touches.substr(touches.find("0.000000,20,5")));
  const Run run = calibrate("", readings.substr(readings.find('\n') + 1));
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS(",,,", run.out.c_str());
}

TEST(CalibrateCommand, PrintsJson) {
  STRCMP_CONTAINS("{\"gauge\":0,\"angle_deg\":0.0,\"gain\":0.96999",
                  calibrate("--json", readings).out.c_str());
}

TEST(CalibrateCommand, SaysWhatIsWrongAndWhereAndWritesNothing) {
  refuses(1, "", readings.substr(0, readings.rfind("\n", readings.size() - 2) + 1),
          "16 rows of strains and 17");
  refuses(1, "", "1,2,3\n", "stdin:1:");
  refuses(1, "--strains no/such.csv", "", "no/such.csv");
  refuses(2, "-c no/such.toml", readings, "no/such.toml");
  write("touches.csv", "0,0,0\n0,20\n");
  refuses(1, "", readings, "touches.csv:2:");
  LONGS_EQUAL(2, runProgram("calibrate", readings).status);
}

TEST(CalibrateCommand, NamesTheGaugesThatTheTouchesDontTell) {
  write("touches.csv", "0,20,5\n");
  const auto second = readings.find('\n') + 1;
  refuses(1, "", readings.substr(second, readings.find('\n', second) + 1 - second),
          "don't tell the gain to 1 % of gauge ");
}
