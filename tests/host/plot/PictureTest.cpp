#include "host/plot/picture.hpp"

#include <array>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <string>

#include "host/base/failure.hpp"
#include "tests/host/plot/TemporaryFolder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::plot;

TEST_GROUP(Picture) {
  const TemporaryFolder folder;
  Picture picture{320, 200, "plot data('curve') using 1:(gap(2)) every ::1 with lines\n", {}};

  void setup() override {
    const double gap = std::numeric_limits<double>::quiet_NaN();
    picture.data = {{"curve", {"x", "y"}, {{0, 1}, {1, gap}, {2, 0.1}}}};
  }
  std::string contentOf(const std::string& name) {
    std::ifstream file(folder.file(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  std::string complaintAbout(const std::string& path, ExitCode expected) {
    try {
      draw(picture, path);
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(expected), static_cast<int>(failure.code()));
      return failure.what();
    }
    return "drawn";
  }
};

TEST(Picture, TheLastColumnMayHaveGaps) {
  const double gap = std::numeric_limits<double>::quiet_NaN();
  picture.data = {{"curve", {"x", "y"}, {{0, 0.25}, {1, 0.25}, {1.5, gap}, {1.75, gap}, {2, 5}}}};
  picture.script = "set table 'points'\n" + picture.script + "unset table\n" + picture.script;
  draw(picture, folder.file("a.svg"));
  STRCMP_CONTAINS(" 1.5  NaN  u\n 1.75  NaN  u\n", contentOf("points").c_str());
}

TEST(Picture, APngIsDrawnInTheSizeAskedFor) {
  draw(picture, folder.file("a.png"));
  const std::string png = contentOf("a.png");
  STRCMP_EQUAL("PNG", png.substr(1, 3).c_str());
  LONGS_EQUAL(320, static_cast<unsigned char>(png[18]) * 256 + static_cast<unsigned char>(png[19]));
  LONGS_EQUAL(200, static_cast<unsigned char>(png[22]) * 256 + static_cast<unsigned char>(png[23]));
}

TEST(Picture, MayHaveAnApostropheInItsName) {
  draw(picture, folder.file("Bob's finger.svg"));
  STRCMP_CONTAINS("</svg>", contentOf("Bob's finger.svg").c_str());
}

// gnuplot would take the name of its script for an option.
TEST(Picture, MayBeginWithADash) {
  draw(picture, folder.file("-y.svg"));
  STRCMP_CONTAINS("</svg>", contentOf("-y.svg").c_str());
}

TEST(Picture, OneThatIsNotDrawnIsAFailure) {
  picture.script = "exit status 0\n";
  picture.script = "set output 'elsewhere.svg'\n" + picture.script;
  STRCMP_CONTAINS("a.svg: gnuplot has not drawn it",
                  complaintAbout(folder.file("a.svg"), ExitCode::kFailure).c_str());
  CHECK_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Picture, AnSvgIsDrawnWhole) {
  draw(picture, folder.file("a.svg"));
  STRCMP_CONTAINS("</svg>", contentOf("a.svg").c_str());
}

TEST(Picture, DataAndScriptStayBesideThePicture) {
  draw(picture, folder.file("a.svg"));
  STRCMP_EQUAL("x,y\n0,1\n1,\n2,0.1\n", contentOf("a-curve.csv").c_str());
  STRCMP_EQUAL(completeScript(picture, "a", ".svg").c_str(), contentOf("a.gp").c_str());
}

TEST(Picture, WhatIsUndrawnIsAllButThePicture) {
  writeUndrawn(picture, folder.file("a.png"));
  STRCMP_EQUAL("x,y\n0,1\n1,\n2,0.1\n", contentOf("a-curve.csv").c_str());
  STRCMP_EQUAL(completeScript(picture, "a", ".png").c_str(), contentOf("a.gp").c_str());
  CHECK_FALSE(std::filesystem::exists(folder.file("a.png")));
}

TEST(Picture, WhatIsWrittenBesideItIsKnownBefore) {
  draw(picture, folder.file("a.svg"));
  for (const std::string& file : filesBeside(folder.file("a.svg"), std::array{"curve"}))
    CHECK_TRUE(std::filesystem::remove(file));
  CHECK_TRUE(std::filesystem::remove(folder.file("a.svg")));
  CHECK_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Picture, OtherEndingsAreAUsageErrorAndLeaveNothingBehind) {
  STRCMP_EQUAL("pictures are .svg or .png, not \".gif\"",
               complaintAbout(folder.file("a.gif"), ExitCode::kUsage).c_str());
  CHECK_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Picture, AFolderThatIsNotThereIsNamedWithTheReason) {
  STRCMP_CONTAINS("nowhere/a.png: cannot write the file: No such file or directory",
                  complaintAbout(folder.file("nowhere/a.png"), ExitCode::kFailure).c_str());
}

TEST(Picture, WhatGnuplotComplainsAboutIsPassedOn) {
  picture.script = "plot nonsense\n";
  STRCMP_CONTAINS("undefined variable: nonsense",
                  complaintAbout(folder.file("a.png"), ExitCode::kFailure).c_str());
  CHECK_TRUE(std::filesystem::is_empty(folder.path()));
}

TEST(Picture, IsRefusedBeforeAnyWorkWithoutGnuplot) {
  const std::string searchPath = std::getenv("PATH");
  requirePicturePath("a.png");
  setenv("PATH", folder.path().c_str(), 1);
  std::string complaint = "none";
  try {
    requirePicturePath("a.png");
  } catch (const Failure& failure) {
    complaint = failure.what();
  }
  setenv("PATH", searchPath.c_str(), 1);
  STRCMP_EQUAL("gnuplot is not installed: apt install gnuplot-nox", complaint.c_str());
}

TEST(Picture, LeavesNothingElseBehind) {
  draw(picture, folder.file("a.png"));
  int files = 0;
  for (const auto& file : std::filesystem::directory_iterator(folder.path())) {
    CHECK_TRUE(file.is_regular_file());
    ++files;
  }
  LONGS_EQUAL(3, files);
}
