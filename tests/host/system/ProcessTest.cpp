#include "host/system/process.hpp"

#include <cstdlib>
#include <filesystem>
#include <string>

#include "host/base/failure.hpp"
#include "tests/host/plot/TemporaryFolder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::system;

TEST_GROUP(Process) {
  const plot::TemporaryFolder folder;
  const std::string searchPath = std::getenv("PATH");

  void teardown() override { setenv("PATH", searchPath.c_str(), 1); }
  std::string complaintOf(const std::vector<std::string>& command) {
    try {
      runIn(folder.path(), command, "the-package");
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(ExitCode::kFailure), static_cast<int>(failure.code()));
      return failure.what();
    }
    return "done";
  }
};

TEST(Process, ItRunsInItsFolderWithItsArgumentsAsTheyAre) {
  STRCMP_EQUAL("done", complaintOf({"touch", "a b;$(c)"}).c_str());
  CHECK_TRUE(std::filesystem::exists(folder.file("a b;$(c)")));
}

TEST(Process, AProgramThatIsNotInstalledIsNamedWithItsPackage) {
  setenv("PATH", folder.path().c_str(), 1);
  STRCMP_EQUAL("touch is not installed: apt install the-package", complaintOf({"touch", "x"}).c_str());
}

TEST(Process, WhatItWritesIsReturned) {
  STRCMP_EQUAL("said\n", runIn(".", {"sh", "-c", "echo aside >&2; echo said"}, "the-package").c_str());
}

TEST(Process, AFailureCarriesWhatTheProgramSaid) {
  STRCMP_EQUAL("sh -c echo bad >&2; exit 3 failed:\nbad\n",
               complaintOf({"sh", "-c", "echo bad >&2; exit 3"}).c_str());
}

TEST(Process, AProgramThatIsKilledHasFailed) {
  STRCMP_CONTAINS(" failed:", complaintOf({"sh", "-c", "kill -9 $$"}).c_str());
}

TEST(Process, OutputLongerThanAPipeDoesNotBlockIt) {
  STRCMP_EQUAL("done",
               complaintOf({"sh", "-c", "head -c 1000000 /dev/zero; head -c 1000000 /dev/zero >&2"}).c_str());
}
