#include "host/plot/log_picture.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string>
#include <vector>

#include "host/base/read_file.hpp"
#include "tests/host/plot/TemporaryFolder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::plot;

TEST_GROUP(LogPicture) {
  LogPoint point_;

  void setup() override {
    can::TouchReport& touch = point_.touch;
    point_.time_s = 1;
    touch.angle_deg = 20;
    touch.sigmaAngle_deg = 2;
    touch.normal_n = 0.5;
    touch.sigmaNormal_n = 0.125;
    touch.tangential_n = -0.25;
    touch.sigmaTangential_n = 0.25;
    touch.width_m = 2e-3;
    touch.sigmaWidth_m = 3e-3;
    touch.flags = FingerFlags{FingerFlag::kContact, FingerFlag::kDegraded};
  }
  LogPoint pointAt(double time_s, double angle_deg) const {
    LogPoint point = point_;
    point.time_s = time_s;
    point.touch.angle_deg = angle_deg;
    return point;
  }

  static std::vector<std::vector<double>> rows(const std::vector<LogPoint>& points, const std::string& name) {
    for (const DataFile& file : logPicture({"heading", points}).data)
      if (file.name == name) return file.rows;
    FAIL(name.c_str());
    return {};
  }
  static void checkRow(const std::vector<double>& expected, const std::vector<double>& row) {
    LONGS_EQUAL(expected.size(), row.size());
    for (std::size_t i = 0; i < row.size(); ++i) DOUBLES_EQUAL(expected[i], row[i], 1e-9);
  }
};

TEST(LogPicture, BandsAreOneSigmaWide) {
  checkRow({1, 0.5, 0.375, 0.625, -0.25, -0.5, 0}, rows({point_}, "force").at(0));
}

TEST(LogPicture, BandsStayWhereValuesCanBe) {
  checkRow({1, 2, 0, 5}, rows({point_}, "width").at(0));
  const auto row = rows({pointAt(0, 1)}, "angle").at(0);
  DOUBLES_EQUAL(0, row[2], 1e-9);
  DOUBLES_EQUAL(3, row[3], 1e-9);
}

TEST(LogPicture, CurvesBreakWhereNothingWasSaid) {
  const auto force = rows({pointAt(0, 20), pointAt(0.1, 20), pointAt(0.5, 20)}, "force");
  LONGS_EQUAL(4, force.size());
  CHECK_TRUE(force[2].empty());
}

TEST(LogPicture, NoBandRunsFromOneTouchToTheNext) {
  LogPoint end{.time_s = 0.1, .touch = {}};
  end.touch.normal_n = end.touch.tangential_n = 0;
  const std::vector<LogPoint> points{pointAt(0, 20), end, pointAt(0.2, 20), end};
  for (const char* name : {"angle", "width"}) {
    const auto file = rows(points, name);
    LONGS_EQUAL(4, file.size());
    CHECK_TRUE(file[1].empty());
    CHECK_TRUE(file[3].empty());
  }
  const auto force = rows(points, "force");  // ends with its zero, which has no sigma
  DOUBLES_EQUAL(0, force.at(1).at(1), 0);
  CHECK_TRUE(std::isnan(force.at(1).at(2)));
  CHECK_TRUE(force.at(2).empty());
}

TEST(LogPicture, AnAngleOfUnknownSigmaHasNoBand) {
  point_.touch.sigmaAngle_deg = kNoValue;
  const auto angle = rows({point_}, "angle");
  DOUBLES_EQUAL(20, angle.at(0).at(1), 0);
  CHECK_TRUE(std::isnan(angle.at(0).at(2)));
  CHECK_TRUE(std::isnan(angle.at(0).at(3)));
  CHECK_TRUE(angle.at(1).empty());
}

TEST(LogPicture, TheAngleBreaksWhereItRunsThroughZero) {
  const std::vector<LogPoint> points{pointAt(0, 359), pointAt(0.01, 1)};
  CHECK_TRUE(rows(points, "angle").at(1).empty());
  LONGS_EQUAL(2, rows(points, "force").size());
}

TEST(LogPicture, EdgesOfBandsThatStandForThatOrMoreAreMarked) {
  point_.touch.sigmaTangential_n = 0.1265;
  LONGS_EQUAL(4, logPicture({"heading", {point_}}).data.size());
  point_.touch.sigmaNormal_n = 0.127;
  point_.touch.sigmaWidth_m = 0.065534;
  const auto marks = rows({point_}, "or-more");
  LONGS_EQUAL(3, marks.size());
  DOUBLES_EQUAL(0.373, marks[0][1], 1e-9);
  DOUBLES_EQUAL(0.627, marks[1][1], 1e-9);
  DOUBLES_EQUAL(67.534, marks[2][2], 1e-9);
  const TemporaryFolder folder;
  draw(logPicture({"heading", {point_}}), folder.file("marked.svg"));
  point_.touch.sigmaNormal_n = 0.1;
  draw(logPicture({"heading", {point_}}), folder.file("width.svg"));
}

// As of a finger whose contact.width_m is known.
TEST(LogPicture, WithoutAnyWidthTheRestIsDrawn) {
  const TemporaryFolder folder;
  point_.touch.width_m = point_.touch.sigmaWidth_m = kNoValue;
  for (const double sigma_n : {0.125, 0.127}) {
    point_.touch.sigmaNormal_n = sigma_n;
    draw(logPicture({"heading", {point_, pointAt(1.01, 21)}}), folder.file("a.svg"));
    STRCMP_CONTAINS("no width is told", readFile(folder.file("a.svg"), ExitCode::kFailure).c_str());
  }
}

TEST(LogPicture, LabelsOfWidthsHaveRoom) {
  point_.touch.sigmaWidth_m = 2.8e-3;  // up to 4.8 mm
  STRCMP_CONTAINS("widthTics = 2;", logPicture({"heading", {point_}}).script.c_str());
}

TEST(LogPicture, SaysWhereItsTimeBegins) {
  STRCMP_CONTAINS("'time since the first frame (s)'", logPicture({"heading", {point_}}).script.c_str());
}

TEST(LogPicture, ASecondContactHasItsAngleAndForces) {
  const LogPoint alone = pointAt(0, 20);
  point_.touch.second = can::ContactReport{.angle_deg = 200, .normal_n = 0.25, .tangential_n = -0.125};
  const std::vector<LogPoint> points{alone, point_, pointAt(1.01, 21), alone};
  const auto second = rows(points, "second");
  checkRow({1, 200, 0.25, -0.125}, second.at(0));
  LONGS_EQUAL(3, second.size());
  CHECK_TRUE(second.at(2).empty());
  const TemporaryFolder folder;
  draw(logPicture({"heading", points}), folder.file("second.svg"));
  for (const DataFile& file : logPicture({"heading", {alone}}).data) CHECK(file.name != "second");
}

TEST(LogPicture, FlagsAreRowsByTheirBits) {
  const auto flags = rows({point_}, "flags");
  LONGS_EQUAL(2, flags.size());
  checkRow({1, 0}, flags[0]);
  checkRow({1, 2}, flags[1]);
}

TEST(LogPicture, CanBeDrawn) {
  const TemporaryFolder folder;
  draw(logPicture({"heading", {point_}}), folder.file("one.svg"));
  draw(logPicture({"heading", {point_, pointAt(2, 30)}}), folder.file("two.png"));
  STRCMP_CONTAINS("</svg>", readFile(folder.file("one.svg"), ExitCode::kFailure).c_str());
  CHECK_COMPARE(std::filesystem::file_size(folder.file("two.png")), >, 5000);
}

// The heading has an interface's name, which a log can have from anywhere.
TEST(LogPicture, WhatStandsInAHeadingIsDrawnAndNotRun) {
  const TemporaryFolder folder;
  const std::string run = folder.file("run");
  draw(logPicture({"can_0';system('touch " + run + "');x='", {point_}}), folder.file("a.svg"));
  CHECK_FALSE(std::filesystem::exists(run));
  STRCMP_CONTAINS("can_0';system(", readFile(folder.file("a.svg"), ExitCode::kFailure).c_str());
}

TEST(LogPicture, AllItsDataFilesAreNamed) {
  point_.touch.sigmaNormal_n = 0.127;
  point_.touch.second = can::ContactReport{.angle_deg = 200, .normal_n = 0.25, .tangential_n = -0.125};
  const Picture picture = logPicture({"heading", {point_}});
  LONGS_EQUAL(kLogData.size(), picture.data.size());
  for (const DataFile& file : picture.data)
    CHECK_TRUE(std::find(kLogData.begin(), kLogData.end(), file.name) != kLogData.end());
}
