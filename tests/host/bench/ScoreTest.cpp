#include "host/bench/score.hpp"

#include <cmath>
#include <limits>
#include <memory>
#include <string_view>

#include "host/bench/make_bundle.hpp"
#include "host/bench/methods/catalogue.hpp"
#include "host/tables/table_builder.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::bench;

TEST_GROUP(Score) {
  const BenchFinger finger;
  const double pitch_um = finger.arc_um(1);

  static Reading readingAt(double position) { return {{position, 20, 5}, {}, {0.01, 0.5, 0.25}}; }
};

TEST(Score, ErrorsAreOverTheBoundAndRootMeanSquares) {
  const std::vector<Reading> readings{readingAt(2), readingAt(15.995)};
  const std::vector<Place<double>> answers{{2.01, 21, 5}, {0.005, 20, 5.5}};  // across the seam
  const Score score = scoreOf(finger, readings, answers);
  LONGS_EQUAL(0, score.gross);
  DOUBLES_EQUAL(1, score.overBound[0], 1e-9);
  DOUBLES_EQUAL(std::sqrt(2.0), score.overBound[1], 1e-9);
  DOUBLES_EQUAL(std::sqrt(2.0), score.overBound[2], 1e-9);
  DOUBLES_EQUAL(0.01 * pitch_um, score.arc_um, 1e-6);
  DOUBLES_EQUAL(0.01 * pitch_um, score.arcBound_um, 1e-6);
}

TEST(Score, GrossAnswersAreCountedAndInNoFigureButTheLast) {
  const std::vector<Reading> readings{readingAt(2), readingAt(4)};
  const std::vector<Place<double>> answers{{2, 20, 5}, {4.6, 99, 99}};
  const Score score = scoreOf(finger, readings, answers);
  LONGS_EQUAL(1, score.gross);
  DOUBLES_EQUAL(0, score.arc_um, 1e-9);
  DOUBLES_EQUAL(0, score.normal_n_per_m, 1e-9);
  DOUBLES_EQUAL(0.6 / std::sqrt(2.0) * pitch_um, score.arcOfAll_um, 1e-6);
}

TEST(Score, AnAnswerThatIsNoNumberIsGross) {
  const std::vector<Reading> readings{readingAt(2)};
  const auto nowhere = placeWithoutLoads(std::numeric_limits<double>::quiet_NaN());
  const Score score = scoreOf(finger, readings, {{nowhere}});
  LONGS_EQUAL(1, score.gross);
  DOUBLES_EQUAL(8 * pitch_um, score.arcOfAll_um, 1e-6);
}

TEST(Score, WithoutNoiseThereIsNoRatio) {
  std::vector<Reading> readings{readingAt(2)};
  readings[0].bound.setZero();
  const Score score = scoreOf(finger, readings, {{{2.01, 20, 5}}});
  CHECK(std::isnan(score.overBound[0]));
  DOUBLES_EQUAL(0.01 * pitch_um, score.arc_um, 1e-6);
}

TEST(Score, AContactOfTheFirmwareIsAPlaceInPitches) {
  config::FingerConfig config;
  config.gauges.first_angle_deg = 10;
  const TableImage tables = tables::buildTableImage(config);
  Contact contact;
  contact.angle = TurnQ32::fromRaw(tables.gauge_angle_q32[0] + (3u << 28));
  contact.normal = LineLoadQ12::fromRaw(5 << 12);
  const Place<double> place = placeOf(tables, contact);
  DOUBLES_EQUAL(3, place.position_pitch, 1e-9);
  DOUBLES_EQUAL(5, place.normal, 1e-9);
}

// A locator's answer is in units of its own tables, whichever it has.
TEST(Score, WhatFindingSigmasAddsChangesNoAnswer) {
  const LevelSettings& wide = kLevelSettings.back();
  const auto tables = std::make_unique<NoiseTables>(tablesFor(finger, wide));
  const std::vector<Reading> readings = readingsOf(finger, wide, 4);
  std::vector<Place<double>> answers;
  visitOurs(*tables, [&](const Method& method, auto fit) {
    if (method.name.find("three-point") != std::string_view::npos) return;
    for (const Reading& reading : readings) answers.push_back(placeOf(tables->line, fit(reading.sample)));
  });
  const std::size_t count = readings.size();
  LONGS_EQUAL(4 * count, answers.size());
  for (std::size_t i = 0; i < answers.size(); i += i % count == count - 1 ? count + 1 : 1) {
    DOUBLES_EQUAL(answers[i + count].position_pitch, answers[i].position_pitch, 0);
    DOUBLES_EQUAL(answers[i + count].normal, answers[i].normal, 0);
    DOUBLES_EQUAL(answers[i + count].tangential, answers[i].tangential, 0);
  }
}
