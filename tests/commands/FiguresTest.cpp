#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include "tests/commands/program.hpp"
#include "tests/host/plot/TemporaryFolder.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(FiguresCommand) {
  const plot::TemporaryFolder folder;

  Run figures(const std::string& more) const {
    return runProgram("figures -o " + folder.path() + "/out " + more);
  }
  bool has(const std::string& name) const { return std::filesystem::exists(folder.file("out/" + name)); }
  std::string contentOf(const std::string& name) const {
    std::ifstream file(folder.file("out/" + name));
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
};

TEST(FiguresCommand, LeavesDataScriptAndBothPictures) {
  LONGS_EQUAL(0, figures("--only 3").status);
  for (const char* name :
       {"figure-3.svg", "figure-3.png", "figure-3.gp", "figure-3-coefficients.csv", "claims.csv"})
    CHECK_TRUE_TEXT(has(name), name);
  CHECK_FALSE(has("figure-4.png"));
}

TEST(FiguresCommand, PrintsTheClaimsThatItWrites) {
  const Run run = figures("--only 5,3");
  STRCMP_EQUAL(contentOf("claims.csv").c_str(), run.out.c_str());
  STRCMP_CONTAINS("claim,paper,computed,verdict\ncut-off,", run.out.c_str());
  STRCMP_CONTAINS("figure 3: Frequency responses of the strains\nfigure 5: ", run.err.c_str());
}

TEST(FiguresCommand, PrintsJson) {
  STRCMP_CONTAINS("{\"claim\":\"half-plane\",\"paper\":", figures("--only 4 --json").out.c_str());
}

TEST(FiguresCommand, RefusesFiguresThatAreNone) {
  for (const std::string figure : {"1", "11", "x", "2.5"}) {
    const Run run = figures("--only 2," + figure);
    LONGS_EQUAL(2, run.status);
    STRCMP_CONTAINS(("--only: " + figure + " not in {2,3,4,5,6,7,8,9,10}\n").c_str(), run.err.c_str());
  }
  CHECK_FALSE(std::filesystem::exists(folder.file("out")));
}

TEST(FiguresCommand, RefusesListsWithNothingBetweenCommas) {
  const Run run = figures("--only 3,,4");
  LONGS_EQUAL(2, run.status);
  STRCMP_CONTAINS("--only: an item of 3,,4 is empty", run.err.c_str());
}

TEST(FiguresCommand, AFolderWithoutANameIsAUsageError) {
  checkRefused("figures --only 3 -o ''", "figures: --output: the name of a folder is missing");
}

TEST(FiguresCommand, WantsAFolder) {
  const Run run = runProgram("figures");
  LONGS_EQUAL(2, run.status);
  STRCMP_CONTAINS("--output", run.err.c_str());
}

TEST(FiguresCommand, NamesAFolderThatCannotBe) {
  const Run run = runProgram("figures -o /dev/null/figures");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("cannot make the folder /dev/null/figures: Not a directory", run.err.c_str());
}

TEST(FiguresCommand, WithoutGnuplotWritesAllButPictures) {
  const Run run = runShell("PATH=/nowhere $STRAINFINGER figures --only 4 -o " + folder.path() + "/out");
  LONGS_EQUAL(1, run.status);
  STRCMP_CONTAINS("gnuplot is not installed: apt install gnuplot-nox. No picture was drawn in ",
                  run.err.c_str());
  STRCMP_CONTAINS("gnuplot figure-N.gp", run.err.c_str());
  STRCMP_EQUAL(contentOf("claims.csv").c_str(), run.out.c_str());
  for (const char* name : {"figure-4.gp", "figure-4-strains.csv", "claims.csv"})
    CHECK_TRUE_TEXT(has(name), name);
  for (const char* name : {"figure-4.svg", "figure-4.png"}) CHECK_FALSE_TEXT(has(name), name);
  LONGS_EQUAL(0, runShell("cd " + folder.path() + "/out && gnuplot figure-4.gp").status);
  CHECK_TRUE(has("figure-4.png"));
}

TEST(FiguresCommand, SaysWhatGaugesOnTheCoreDoNotRead) {
  std::ofstream(folder.file("finger.toml")) << "schema = 1\n[gauges]\nradius_m = 0.0089\n";
  const Run run = figures("--only 3,4,5,6 -c " + folder.file("finger.toml"));
  LONGS_EQUAL(0, run.status);
  STRCMP_CONTAINS("warning: figure 3: the finger's e_rr is 0: gauges.radius_m is the core's",
                  run.err.c_str());
  STRCMP_CONTAINS("warning: figure 5: e_rr is 0 and has no cut-off", run.err.c_str());
  STRCMP_CONTAINS("figure 6: Displacements under a flat", run.err.c_str());
  CHECK_TRUE(run.err.find("warning: figure 6") == std::string::npos);
}

// A gnuplot of ours interrupts the program that runs it, as Ctrl-C would, and dies of it too.
TEST(FiguresCommand, AnInterruptionLeavesWholeFilesOnly) {
  std::ofstream(folder.file("gnuplot"))
      << "#!/bin/sh\n[ $1 = --version ] && exit 0\nkill -INT $PPID\nexit 1\n";
  std::filesystem::permissions(folder.file("gnuplot"), std::filesystem::perms::owner_all);
  const Run run =
      runShell("PATH=" + folder.path() + ":$PATH $STRAINFINGER figures -o " + folder.path() + "/out");
  LONGS_EQUAL(130, run.status);
  STRCMP_CONTAINS("figures: interrupted at figure 2", run.err.c_str());
  CHECK_TRUE(std::filesystem::is_empty(folder.file("out")));
}
