#include <CppUTest/TestHarness.h>

#include <string>

#include "tests/commands/program.hpp"

using namespace strainfinger;

TEST_GROUP(DbcCommand) {};

TEST(DbcCommand, PrintsTheFileOfTheDefaultFinger) {
  const Run run = runProgram("dbc");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("\nBU_: FINGER_1 HOST\n", run.out.c_str());
  STRCMP_EQUAL("", run.err.c_str());
}

TEST(DbcCommand, TakesAnotherNode) {
  STRCMP_CONTAINS("\nBU_: FINGER_63 HOST\n", runProgram("dbc --node 63").out.c_str());
}

TEST(DbcCommand, RefusesNodesThatDoNotExist) {
  for (const char* arguments : {"dbc --node 0", "dbc --node 64", "dbc --node x"}) {
    const Run run = runProgram(arguments);
    LONGS_EQUAL(2, run.status);
    STRCMP_CONTAINS("--node", run.err.c_str());
    STRCMP_EQUAL("", run.out.c_str());
  }
}

TEST(DbcCommand, HasNoJson) {
  const Run run = runProgram("dbc --json");
  LONGS_EQUAL(2, run.status);
  STRCMP_EQUAL("", run.out.c_str());
  STRCMP_CONTAINS("dbc: --json: a DBC file is all that it prints", run.err.c_str());
}

TEST(DbcCommand, WritesAFile) {
  const Run run = runShell(
      "f=$(mktemp); \"$STRAINFINGER\" dbc -o $f && cmp $f <(\"$STRAINFINGER\" dbc) && echo same; rm $f");
  STRCMP_EQUAL("same\n", run.out.c_str());
}

TEST(DbcCommand, WritesToStandardOutputByName) {
  const Run run = runShell(
      "f=$(mktemp -d); ln -s /dev/stdout $f/link; \"$STRAINFINGER\" dbc -o $f/link | "
      "cmp - <(\"$STRAINFINGER\" dbc) && echo same; rm -r $f");
  STRCMP_EQUAL("same\n", run.out.c_str());
}

TEST(DbcCommand, ADeviceThatIsFullIsAFailure) {
  const Run run = runShell(
      "f=$(mktemp -d); ln -s /dev/full $f/link; \"$STRAINFINGER\" dbc -o $f/link; echo $?; rm -r $f");
  STRCMP_EQUAL("1\n", run.out.c_str());
  STRCMP_CONTAINS("link: No space left on device", run.err.c_str());
}

TEST(DbcCommand, AFolderThatIsRemovedMeanwhileIsNamed) {
  const Run run = runShell("cd $(mktemp -d); rmdir $PWD; \"$STRAINFINGER\" dbc -o x.dbc");
  LONGS_EQUAL(1, run.status);
  STRCMP_EQUAL(
      "strainfinger: x.dbc: the current folder is not there any more (No such file or directory): change to "
      "another\n",
      run.err.c_str());
}

TEST(DbcCommand, SaysWhyAFileCannotBeWritten) {
  const Run run = runProgram("dbc -o /nowhere/finger.dbc");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("--output /nowhere/finger.dbc: there is no folder /nowhere", run.err.c_str());
}

TEST(DbcCommand, AFullDiskIsAFailure) {
  const Run run = runProgram("dbc > /dev/full");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("cannot write the output", run.err.c_str());
}
