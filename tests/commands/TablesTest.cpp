#include <string>

#include "tests/commands/program.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(TablesCommand) {
  /// Runs in a folder of its own that holds finger.tables, and thin.toml, another finger.
  static Run inFolder(const std::string& command) {
    return runShell(
        "folder=$(mktemp -d) && trap 'rm -rf \"$folder\"' EXIT && cd \"$folder\" && "
        "printf 'schema = 1\\n[finger]\\ncore_radius_m = 9.2e-3\\n[gauges]\\nradius_m = "
        "9.7e-3\\n' >thin.toml && "
        "\"$STRAINFINGER\" tables -o finger.tables 2>/dev/null && " +
        command);
  }
  static void checkEnds(int status, const char* message, const std::string& command) {
    const Run run = inFolder(command);
    LONGS_EQUAL_TEXT(status, run.status, (command + "\n" + run.err).c_str());
    STRCMP_CONTAINS(message, run.err.c_str());
  }
};

TEST(TablesCommand, AFreshImageVerifies) {
  checkEnds(0, "whole", "\"$STRAINFINGER\" tables verify finger.tables");
}

TEST(TablesCommand, InfoNamesTheFormatTheChecksumAndTheFinger) {
  const Run run = inFolder("\"$STRAINFINGER\" tables info finger.tables");
  LONGS_EQUAL(0, run.status);
  for (const char* key :
       {"key,value\nformat,10\n", "\ncrc32,", "\nfinger.outer_radius_m,0.0127\n", "\ngauges.count,16\n"})
    STRCMP_CONTAINS(key, run.out.c_str());
}

TEST(TablesCommand, InfoHasListsAndWhatIsUnknownAsJsonHasThem) {
  const Run run = inFolder("\"$STRAINFINGER\" tables info finger.tables --json");
  LONGS_EQUAL(0, run.status);
  for (const char* row :
       {"{\"key\":\"gauges.angle_deg\",\"value\":[0.0,22.5,45.0,",
        "{\"key\":\"calibration.gain\",\"value\":[]}\n", "{\"key\":\"contact.width_m\",\"value\":null}\n"})
    STRCMP_CONTAINS(row, run.out.c_str());
  const Run csv = inFolder("\"$STRAINFINGER\" tables info finger.tables");
  STRCMP_CONTAINS("\ngauges.angle_deg,\"[0, 22.5, 45, ", csv.out.c_str());
  STRCMP_CONTAINS("\ncontact.width_m,unknown\n", csv.out.c_str());
}

TEST(TablesCommand, ATruncatedImageFailsVerification) {
  checkEnds(6, "1000 bytes, and 24568 by its header, where an image has 24568",
            "head -c 1000 finger.tables >cut && \"$STRAINFINGER\" tables verify cut");
}

TEST(TablesCommand, AFlippedBitFailsVerification) {
  checkEnds(6, "CRC-32",
            "printf '\\377' | dd of=finger.tables bs=1 seek=3000 conv=notrunc 2>/dev/null && "
            "\"$STRAINFINGER\" tables verify finger.tables");
}

TEST(TablesCommand, AnotherFingersImageIsAMismatchThatNamesTheDifference) {
  checkEnds(5, "finger.core_radius_m", "\"$STRAINFINGER\" tables verify finger.tables -c thin.toml");
}

TEST(TablesCommand, WhatIsNoImageFailsVerification) {
  checkEnds(6, "thin.toml: not a table image: a config goes after -c\n",
            "\"$STRAINFINGER\" tables verify thin.toml");
}

TEST(TablesCommand, AMissingFileIsAFailureThatNamesIt) {
  checkEnds(1, "gone.tables", "\"$STRAINFINGER\" tables verify gone.tables");
}

TEST(TablesCommand, AMissingConfigIsToldByInfoToo) {
  checkEnds(2, "/nowhere.toml", "\"$STRAINFINGER\" tables info finger.tables -c /nowhere.toml");
}

TEST(TablesCommand, AMissingFolderIsAFailureAndLeavesNothing) {
  checkEnds(1, "--output nowhere/finger.tables: there is no folder",
            "\"$STRAINFINGER\" tables -o nowhere/finger.tables");
  checkEnds(1, "--header nowhere/finger.hpp: there is no folder",
            "\"$STRAINFINGER\" tables -o new.tables --header nowhere/finger.hpp; status=$?; "
            "test ! -e new.tables && exit $status");
}

TEST(TablesCommand, ADashIsNoFile) {
  checkEnds(2, "--output -: name a file (./- if that is its name)",
            "\"$STRAINFINGER\" tables -o -; status=$?; test ! -e - && exit $status");
}

TEST(TablesCommand, AHeaderThatCannotBeLeavesTheOldImage) {
  checkEnds(
      1, "--header folder: this is a folder; name a file",
      "mkdir folder && cp finger.tables before && { \"$STRAINFINGER\" tables -c thin.toml -o finger.tables "
      "--header folder; status=$?; cmp before finger.tables && exit $status; }");
}

TEST(TablesCommand, ABadConfigLeavesTheOldImage) {
  checkEnds(2, "bad.toml:3:",
            "cp finger.tables before && printf 'schema = 1\\n[gauges]\\ncount = 15\\n' >bad.toml && "
            "{ \"$STRAINFINGER\" tables -c bad.toml -o finger.tables; status=$?; cmp before finger.tables && "
            "exit $status; }");
}

TEST(TablesCommand, NoiseBelowTheConvertersIsRefusedByEveryCommandThatNeedsTables) {
  const char* complaint =
      "coarse.toml:3:12: gauges.noise_strain = 6e-06 is less than the quantisation alone, 6.77e-05, that "
      "gauges.adc_bits = 8 over +-gauges.full_scale_strain = 0.03 leaves";
  for (const std::string command : {"tables -o coarse.tables", "locate", "run --duration 1"})
    checkEnds(2, complaint,
              "printf 'schema = 1\\n[gauges]\\nadc_bits = 8\\n' >coarse.toml && \"$STRAINFINGER\" " +
                  command + " -c coarse.toml </dev/null");
}

TEST(TablesCommand, WithoutAnythingToDoSaysHow) { checkEnds(2, "-o FILE", "\"$STRAINFINGER\" tables"); }

// What a user finds out only when the finger is built.
TEST(TablesCommand, WarnsOfSparseRingsAndOfForcesBeyondTheFrames) {
  const Run sparse = inFolder(
      "printf 'schema = 1\n[gauges]\ncount = 12\n' >few.toml && \"$STRAINFINGER\" tables -c few.toml -o "
      "few.tables");
  LONGS_EQUAL(0, sparse.status);
  STRCMP_CONTAINS("tables: warning: at the surface the gauges are up to 2.015 times their depth apart",
                  sparse.err.c_str());
  const Run strong = inFolder(
      "printf 'schema = 1\n[finger]\nlength_m = 1\n' >long.toml && \"$STRAINFINGER\" tables -c long.toml -o "
      "l.tables");
  STRCMP_CONTAINS("up to 65.1 N (finger.length_m = 1), FORCE tells 32.767 N at most", strong.err.c_str());
  const Run plain = inFolder("\"$STRAINFINGER\" tables -o plain.tables");
  CHECK_TRUE(plain.err.find("warning") == std::string::npos);
}

TEST(TablesCommand, WhatTheFirmwareCannotDoNamesTheConfig) {
  checkEnds(2, "narrow.toml: contact.largest_width_m = 5e-05: the firmware fits widths when it is from",
            "printf 'schema = 1\n[contact]\nlargest_width_m = 5e-5\n' >narrow.toml && "
            "\"$STRAINFINGER\" tables -c narrow.toml -o x");
  checkEnds(2, "gauges.noise_strain = 6e-06 is too large for gauges.full_scale_strain = 0.005",
            "printf 'schema = 1\n[gauges]\nfull_scale_strain = 0.005\n' >low.toml && "
            "\"$STRAINFINGER\" tables -c low.toml -o x");
}
