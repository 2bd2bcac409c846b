#include "host/plot/touch_picture.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numbers>
#include <string>

#include "tests/host/plot/TemporaryFolder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::plot;

TEST_GROUP(TouchPicture) {
  const TemporaryFolder folder;

  /// A touch that slides backwards through 0 deg, its estimate 0.1 deg behind.
  TouchRecord slide() {
    TouchRecord record;
    record.outerRadius_m = 0.01;
    record.profile = {{0, 1e-3, 2e-3}, {180, -1e-3, -2e-3}};
    record.readings = {{370, 1.5e-3, 1.4e-3, 6e-6}};
    for (const double angle : {2.0, 1.0, -1.0, -2.0})
      record.track.push_back({angle / 10, {{{angle, 20, 5}, {angle - 0.1, 19, 4}, 0.2}}});
    return record;
  }
  DataFile file(const Picture& picture, const std::string& name) {
    return *std::find_if(picture.data.begin(), picture.data.end(),
                         [&](const auto& f) { return f.name == name; });
  }
  void checkRow(const std::vector<double>& expected, const std::vector<double>& row) {
    LONGS_EQUAL(expected.size(), row.size());
    for (std::size_t i = 0; i < row.size(); ++i) DOUBLES_EQUAL(expected[i], row[i], 1e-9);
  }
};

TEST(TouchPicture, ProfileAndReadingsAreInThousandthsAndMillionths) {
  const Picture picture = touchPicture(slide());
  checkRow({0, 1, 2}, file(picture, "profile").rows.at(0));
  checkRow({10, 1.5, 100, 6}, file(picture, "readings").rows.at(0));
}

TEST(TouchPicture, AllItsDataFilesAreNamed) {
  const Picture picture = touchPicture(slide());
  LONGS_EQUAL(kTouchData.size(), picture.data.size());
  for (std::size_t i = 0; i < kTouchData.size(); ++i)
    STRCMP_EQUAL(kTouchData[i], picture.data[i].name.c_str());
}

TEST(TouchPicture, TheTrackHasErrorAndSigmaAsArcsInMillimetres) {
  const double mmPerDeg = std::numbers::pi / 180 * 10;
  const auto row = file(touchPicture(slide()), "track").rows.at(0);
  CHECK_TRUE(std::isnan(row.back()));  // not flagged
  checkRow({0.2, 2, 20, 5, 1.9, 19, 4, -0.1 * mmPerDeg, 0.2 * mmPerDeg}, {row.begin(), row.end() - 1});
}

TEST(TouchPicture, EachContactHasColumnsAndWordsOfItsOwn) {
  STRCMP_CONTAINS("touches = 1;", touchPicture(slide()).script.c_str());
  TouchRecord record = slide();
  record.track.at(1).contacts.push_back({{200, 10, 0}, {200.1, 11, 1}, 0.3});
  record.contacts = {{{90, 30, 0}, {90, 30, 0}, 0.2}, {{200, 10, 0}, {200.1, 11, 1}, 0.3}};
  const Picture picture = touchPicture(record);
  STRCMP_CONTAINS("touches = 2;", picture.script.c_str());
  STRCMP_CONTAINS("contacts = '90 200 '", picture.script.c_str());
  STRCMP_CONTAINS("\\n200.00°, 10.0 N/m, +0.0 along: told 200.10°, 11.0 N/m, +1.0 along\"",
                  picture.script.c_str());
  const DataFile track = file(picture, "track");
  STRCMP_EQUAL("flagged_2", track.columns.back().c_str());
  for (const auto& row : track.rows) LONGS_EQUAL(19, row.size());
  DOUBLES_EQUAL(200.1, track.rows.at(2).at(13), 1e-9);  // behind the gap where the second touch begins
  CHECK_TRUE(std::isnan(track.rows.at(1).at(10)));
  draw(picture, folder.file("two.svg"));
}

TEST(TouchPicture, AnswersThatAreFlaggedAreNotDrawnLikeTheOthers) {
  TouchRecord record = slide();
  STRCMP_CONTAINS("flagged = 0;", touchPicture(record).script.c_str());
  record.track.at(1).contacts[0].isFlagged = true;
  STRCMP_CONTAINS("flagged = 1;", touchPicture(record).script.c_str());
  DOUBLES_EQUAL(1, file(touchPicture(record), "track").rows.at(1).back(), 0);
  draw(touchPicture(record), folder.file("flagged.svg"));
}

TEST(TouchPicture, TheTrueAngleHasAGapWhereItRunsThroughZero) {
  const auto rows = file(touchPicture(slide()), "track").rows;
  LONGS_EQUAL(5, rows.size());
  CHECK_TRUE(std::isnan(rows[2][1]));
  DOUBLES_EQUAL(359, rows[3][1], 1e-9);
}

TEST(TouchPicture, TheErrorGoesTheShortWayAround) {
  TouchRecord record = slide();
  record.track = {{0, {{{0.05, 20, 5}, {359.95, 19, 4}, 0.2}}}};
  DOUBLES_EQUAL(-0.1 * std::numbers::pi / 18, file(touchPicture(record), "track").rows.at(0).at(7), 1e-9);
}

TEST(TouchPicture, TheErrorPanelReachesErrorsAndSigmas) {
  TouchRecord record = slide();  // sigmas of 0.2 deg are 0.035 mm, twice the errors
  STRCMP_CONTAINS("errorRange = 0.05\n", touchPicture(record).script.c_str());
  for (TrackPoint& point : record.track) point.contacts[0].sigmaAngle_deg = 0.01;
  STRCMP_CONTAINS("errorRange = 0.02\n", touchPicture(record).script.c_str());
  for (TrackPoint& point : record.track) point.contacts[0].sigmaAngle_deg = strainfinger::kNoValue;
  STRCMP_CONTAINS("errorRange = 0.02\n", touchPicture(record).script.c_str());
}

TEST(TouchPicture, NothingWithoutAValueIsDrawnAsANumber) {
  TouchRecord record = slide();
  record.track = {{0, {{}}}, {1, {}}};
  const DataFile track = file(touchPicture(record), "track");
  for (const auto& row : track.rows)
    CHECK_TRUE(std::all_of(row.begin() + 1, row.end(), [](double value) { return std::isnan(value); }));
}

TEST(TouchPicture, EveryRecordCanBeDrawnEvenAnEmptyOne) {
  TouchRecord idle;
  idle.track = {{0, {{}}}, {1, {}}};
  int count = 0;
  for (const TouchRecord& record : {slide(), idle, TouchRecord{}}) {
    const std::string path = folder.file(std::to_string(++count).append(".svg"));
    draw(touchPicture(record), path);
    CHECK_TRUE(std::filesystem::file_size(path) > 5000);
  }
}
