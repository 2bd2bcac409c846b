#include <algorithm>
#include <cmath>
#include <sstream>
#include <string>
#include <vector>

#include "tests/commands/program.hpp"
#include "tests/commands/tables.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(LocateCommand) {
  static std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> result;
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
  struct Range {
    double least = -1, most = 1;
  };
  struct Firm {
    double times = 0;  ///< the loads of touchAt()
    std::string row;
  };
  /// A touch so much harder that its largest reading is `peak`, clipped to a range.
  static Firm firmTouch(const std::vector<double>& strains, double peak, Range range) {
    double largest = 0;
    for (const double strain : strains) largest = std::max(largest, std::abs(strain));
    const double times = peak / largest;
    std::ostringstream row;
    row.precision(17);
    for (const double strain : strains)
      row << (row.tellp() > 0 ? "," : "") << std::clamp(times * strain, range.least, range.most);
    return {times, row.str() + "\n"};
  }
  static const std::vector<std::string>& angles_deg() {
    static const std::vector<std::string> angles{"0", "5", "11.25", "47", "100", "181.3", "200.7", "351"};
    return angles;
  }
  /// The strains of touchAt() at all these angles.
  static const std::vector<std::vector<double>>& touchesAround() {
    static const std::vector<std::vector<double>> touches = [] {
      std::string rows = "header\n";
      for (const std::string& angle_deg : angles_deg()) rows += touchAt(angle_deg);
      return tableOf(rows);
    }();
    return touches;
  }
  static std::vector<Firm> firmTouches(double peak, Range range) {
    std::vector<Firm> touches;
    for (const auto& strains : touchesAround()) touches.push_back(firmTouch(strains, peak, range));
    return touches;
  }
  static std::string located(const std::vector<Firm>& touches, const std::string& mode) {
    std::string input;
    for (const Firm& touch : touches) input += touch.row;
    return runProgram("locate --mode " + mode, input).out;
  }
  /// The columns that are numbers: all up to the quality.
  static std::string numbers(const std::string& out) {
    std::string cut;
    for (const std::string& line : lines(out)) {
      std::size_t end = 0;
      for (int column = 0; column < 8 && end != std::string::npos; ++column)
        end = line.find(',', end == 0 ? 0 : end + 1);
      cut += line.substr(0, end) + "\n";
    }
    return cut;
  }
  /// Every touch is found within 3 of its sigma, or is uncertain; the number of those that are not.
  static std::size_t checkFirmTouches(double peak, Range range, const char* mode) {
    const std::vector<Firm> touches = firmTouches(peak, range);
    const auto rows = tableOf(numbers(located(touches, mode)));
    LONGS_EQUAL(touches.size(), rows.size());
    std::size_t certain = 0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const auto& row = rows[i];
      LONGS_EQUAL(8, row.size());
      if (row[7] <= 20) continue;
      ++certain;
      constexpr double kOfTheTables_deg = 0.01, kOfTheTables = 0.001;  // 2 um of arc
      DOUBLES_EQUAL(0, std::remainder(row[1] - std::stod(angles_deg()[i]), 360),
                    3 * row[4] + kOfTheTables_deg);
      DOUBLES_EQUAL(30 * touches[i].times, row[2], 3 * row[5] + kOfTheTables * row[2]);
      DOUBLES_EQUAL(10 * touches[i].times, row[3], 3 * row[6] + kOfTheTables * row[2]);
    }
    return certain;
  }
  static std::string nothing() { return "0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0\n"; }
  static void checkComplaint(const char* message, const std::string& input) {
    const Run run = runProgram("locate", input);
    LONGS_EQUAL(1, run.status);
    STRCMP_CONTAINS(message, run.err.c_str());
  }
};

TEST(LocateCommand, FindsWhatTheModelSays) {
  for (const char* mode : {"", "--mode refined", "--mode three-point"}) {
    const auto out = lines(runProgram(std::string("locate ") + mode, touchAt("100")).out);
    LONGS_EQUAL(2, out.size());
    STRCMP_EQUAL(
        "contact,angle_deg,normal_n_per_m,tangential_n_per_m,sigma_angle_deg,sigma_normal_n_per_m,"
        "sigma_tangential_n_per_m,quality,width_m,sigma_width_m,flags,angle2_deg,normal2_n_per_m,"
        "tangential2_n_per_m",
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
  STRCMP_EQUAL("0,,,,,,,,,,,,,", out[1].c_str());
  STRCMP_CONTAINS("1,", out[2].c_str());
  STRCMP_EQUAL("0,,,,,,,,,,,,,", out[3].c_str());
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

TEST(LocateCommand, ClippedReadingsAreLeftOut) {
  for (const char* mode : {"refined", "three-point"}) {
    CHECK_COMPARE(checkFirmTouches(1.1 * 0.03, {-0.03, 0.03}, mode), >=, 6);
    CHECK_COMPARE(checkFirmTouches(1.1 * 0.03, {-0.03, 0.03 - 2 * 0.03 / 4096}, mode), >=, 6);  // its codes
  }
}

TEST(LocateCommand, ReadingsBeyondFullScaleAreLeftOutAsClippedOnesAre) {
  for (const double peak : {1.1 * 0.03, 0.07, 0.08, 0.22}) {
    checkFirmTouches(peak, {}, "refined");
    STRCMP_EQUAL(located(firmTouches(peak, {-0.03, 0.03}), "refined").c_str(),
                 located(firmTouches(peak, {}), "refined").c_str());
  }
}

// Strains are less the finger's zero, so a gauge may stop before full scale.
TEST(LocateCommand, ReadingsThatTheZeroMovedOffTheEndOfTheRangeAreLeftOut) {
  CHECK_COMPARE(checkFirmTouches(1.1 * 0.03, {-0.0297, 0.0297}, "refined"), >=, 6);
}

TEST(LocateCommand, ATouchWithNoReadingLeftIsStillATouch) {
  std::string clipped;
  for (int gauge = 0; gauge < 16; ++gauge) clipped += gauge % 3 == 0 ? "0.03," : "-0.5,";
  clipped.back() = '\n';
  const auto out = lines(runProgram("locate", clipped).out);
  LONGS_EQUAL(2, out.size());
  STRCMP_EQUAL("1,,,,,,,,,,,,,", out[1].c_str());
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

TEST(LocateCommand, WhatCannotBeReadIsNoInputWithoutRows) {
  const Run run = runShell("\"$STRAINFINGER\" locate </");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("stdin: cannot read: Is a directory", run.err.c_str());
}

TEST(LocateCommand, AnUnknownModeIsToldOfTheKnownOnes) {
  for (const std::string mode : {"guess", "0", "Refined"})
    checkRefused("locate --mode " + mode,
                 ("--mode: " + mode + " is not one of refined, three-point\n").c_str());
  STRCMP_CONTAINS("--mode MODE ", runProgram("locate --help").out.c_str());
}

TEST(LocateCommand, OtherColumnsArePassedThroughAndTheGaugesFoundByName) {
  std::string header = "time_s,note", row = "0.10,left";
  for (int gauge = 15; gauge >= 0; --gauge) {
    header += ",strain_" + std::to_string(gauge);
    row += ",0";
  }
  const Run run = runProgram("locate", header + "\n" + row + "\n");
  STRCMP_CONTAINS("time_s,note,contact,angle_deg", run.out.c_str());
  STRCMP_CONTAINS("\n0.10,left,0,,", run.out.c_str());
  const Run json = runProgram("locate --json", header + "\n" + row + "\n");
  STRCMP_CONTAINS("{\"time_s\":0.1,\"note\":\"left\",\"contact\":0", json.out.c_str());
}

TEST(LocateCommand, ColumnsNamedAsItsOwnArePassedThroughUnderAnotherName) {
  std::string header = "angle_deg,flags", row = "12.5,mine";
  for (int gauge = 0; gauge < 16; ++gauge) {
    header += ",strain_" + std::to_string(gauge);
    row += ",0";
  }
  const Run json = runProgram("locate --json", header + "\n" + row + "\n");
  STRCMP_CONTAINS("{\"input_angle_deg\":12.5,\"input_flags\":\"mine\",\"contact\":0,\"angle_deg\":null",
                  json.out.c_str());
  STRCMP_CONTAINS("input_angle_deg,input_flags,contact,", runProgram("locate", header + "\n").out.c_str());
}

TEST(LocateCommand, OtherColumnsKeepTheirTextInJson) {
  std::string header = "stamp,id,late,\"my, note\"",
              row = "1764312967000000001,007,12345678901234567890,\"a,\"\"b\"\"\"";
  for (int gauge = 0; gauge < 16; ++gauge) {
    header += ",strain_" + std::to_string(gauge);
    row += ",0";
  }
  STRCMP_CONTAINS(
      "{\"stamp\":1764312967000000001,\"id\":\"007\",\"late\":\"12345678901234567890\","
      "\"my, note\":\"a,\\\"b\\\"\",\"contact\":0",
      runProgram("locate --json", header + "\n" + row + "\n").out.c_str());
  STRCMP_CONTAINS("stamp,id,late,\"my, note\",contact,", runProgram("locate", header + "\n").out.c_str());
  STRCMP_CONTAINS("\n1764312967000000001,007,12345678901234567890,\"a,\"\"b\"\"\",0,,",
                  runProgram("locate", header + "\n" + row + "\n").out.c_str());
}

TEST(LocateCommand, WhatJsonWouldChangeStaysText) {
  const auto noteOf = [](const std::string& note) {
    std::string header = "n", row = note;
    for (int gauge = 0; gauge < 16; ++gauge) {
      header += ",strain_" + std::to_string(gauge);
      row += ",0";
    }
    const std::string out = runProgram("locate --json", header + "\n" + row + "\n").out;
    return out.substr(0, out.find(",\"contact\""));
  };
  for (const char* text : {"00e1", "12e4", "0x10", "1.", "+1", "nan", "[1]", "true"})
    STRCMP_EQUAL(("{\"n\":\"" + std::string(text) + "\"").c_str(), noteOf(text).c_str());
  for (const char* number : {"1.5", "-2", "1.5e-3"})
    DOUBLES_EQUAL(std::stod(number), std::stod(noteOf(number).substr(5)), 0);
}

TEST(LocateCommand, ColumnsOfOneNameAreRefused) {
  std::string gauges;
  for (int gauge = 0; gauge < 16; ++gauge) gauges += ",strain_" + std::to_string(gauge);
  for (const std::string names : {"x,x", "input_flags,flags"}) {
    const Run run = runProgram("locate", names + gauges + "\n");
    LONGS_EQUAL(1, run.status);
    STRCMP_CONTAINS("stdin: two columns would be passed through as ", run.err.c_str());
  }
}

TEST(LocateCommand, AHeaderWithoutTheGaugesIsRefused) {
  std::string header = "g0";
  for (int gauge = 1; gauge < 16; ++gauge) header += ",g" + std::to_string(gauge);
  const Run run = runProgram("locate", header + "\n");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("stdin:1:1: the header has no column strain_0: name them strain_0 to strain_15",
                  run.err.c_str());
}
