#include "tests/commands/program.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(Main){};

TEST(Main, WhatIsNoCommandIsNamed) {
  checkRefused("locat", "strainfinger: locat is no command; strainfinger --help lists them\n");
  checkRefused("locat --json -c x", "strainfinger: locat is no command");
  checkRefused("--jsn", "strainfinger: --jsn is no command");
}

TEST(Main, AMissingCommandIsAUsageError) { checkRefused("", "A subcommand is required"); }

TEST(Main, WhatIsLeftOverBehindACommandIsNamed) { checkRefused("dbc over", "over"); }

TEST(Main, HelpIsNoError) {
  const Run run = runProgram("--help");
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("\n  locate ", run.out.c_str());
}

TEST(Main, HelpHasALineForEachCommand) {
  const Run run = runProgram("--help");
  STRCMP_CONTAINS("\n  tare                        Lets a finger take the zero of its gauges now. ",
                  run.out.c_str());
  CHECK_TRUE(run.out.find("Exit status") == std::string::npos);
  STRCMP_CONTAINS("--force takes the zero anyway", runProgram("tare --help").out.c_str());
}
