#include "host/session/session_view.hpp"

#include <algorithm>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::session;

TEST_GROUP(SessionView) {
  config::Gauges gauges;
  session::SessionView view{.bus = "can0", .node = 3};

  void setup() override {
    view.sets = 100;
    view.rows = 62;
    view.coverage = {std::vector<int>(32, 9), 10, 1, {40}};
    view.coverage.touches[12] = 0;
    view.next = "Leave it alone for 5 s.";
  }
  void assess() {
    Assessment known;
    known.gauges.assign(16, {0.0052, 1e-6, 0.031, 3.1e-6});
    known.errors = {{6.4e-4, 5, 4}, {2.5e-5, 0.3, 0.2}, {1e-5, 0.1, 0.08}};
    known.unitOfForce = 0.008;
    known.zeroOfAngle_deg = 0.12;
    known.arcGains.assign(32, 0.05);
    view.assessment = known;
  }
  std::vector<std::string> lines(const live::ScreenForm& form = {}) const {
    return drawSession(view, gauges, form).lines(false);
  }
  std::string text(const live::ScreenForm& form = {}) const {
    std::string all;
    for (const std::string& line : lines(form)) all += line + "\n";
    return all;
  }
};

TEST(SessionView, SaysWhichRowsAreKeptButNotInTheFit) {
  const auto kept = [](std::size_t rows, std::optional<std::size_t> fitted = {}) {
    return keptText(rows, fitted, RowsUse::kToGoOn, "s", "t");
  };
  STRCMP_EQUAL("no rows were collected", kept(0).c_str());
  const std::string all = "487 rows are kept in s and t: the same command goes on with them";
  STRCMP_EQUAL(all.c_str(), kept(487).c_str());
  STRCMP_EQUAL(all.c_str(), kept(487, 487).c_str());
  STRCMP_EQUAL(("the last 74 rows are kept, but not in this fit; " + all).c_str(), kept(487, 413).c_str());
  STRCMP_CONTAINS("the last row is kept, but not in this fit; ", kept(487, 486).c_str());
}

TEST(SessionView, RowsOfFaultyGaugesAreNotGoneOnWith) {
  STRCMP_EQUAL(
      "487 rows are kept in s and t, but are not what the finger reads once it is mended: start again with "
      "another -o then",
      keptText(487, {}, RowsUse::kOfFaults, "s", "t").c_str());
}

TEST(SessionView, RowsOfAnOldZeroAreNotGoneOnWith) {
  STRCMP_EQUAL(
      "487 rows are kept in s and t, of the old zero: start again with another -o; --strains and --touches "
      "calibrate with these alone",
      keptText(487, {}, RowsUse::kOfOldZero, "s", "t").c_str());
}

TEST(SessionView, SaysWhatToDoAndWhatIsThere) {
  STRCMP_EQUAL("can0 node 3  62 rows: 10 untouched, 1 of known load, 1 of known angle", lines()[0].c_str());
  STRCMP_EQUAL("Leave it alone for 5 s.", lines()[1].c_str());
  STRCMP_CONTAINS(kSessionKeys, text().c_str());
}

TEST(SessionView, EveryGaugeHasItsTouchesAndItsSigmas) {
  assess();
  const std::string shown = text({.rows = 24, .columns = 80});
  STRCMP_CONTAINS("    6  135.0    0 ····      9 ██··", shown.c_str());
  STRCMP_CONTAINS("  0.52 %  0.031 deg   3.1 um  1.0e-6", shown.c_str());
  STRCMP_CONTAINS("\n   15  337.5", shown.c_str());  // as large as it is, it has room
  STRCMP_CONTAINS(
      "place 0.640 > 0.025 > 0.010 mm\n  normal 5.00 > 0.30 > 0.10, tangential 4.00 > 0.20 > 0.08 N/m\n",
      shown.c_str());
  STRCMP_CONTAINS("Unit of force +-0.8 %, zero of the angle +-0.12 deg", shown.c_str());
}

TEST(SessionView, GaugesWithoutRoomAreCounted) {
  const auto drawn = lines({.rows = 12, .columns = 80});
  LONGS_EQUAL(12, drawn.size());
  STRCMP_EQUAL("10 more gauges: make the window higher", drawn[10].c_str());
}

TEST(SessionView, AnySizeCanBeDrawn) {
  assess();
  view.complaint = std::string(500, 'x');
  for (int rows = 1; rows < 40; ++rows)
    for (const int columns : {1, 7, 40, 200})
      LONGS_EQUAL(rows, lines({.rows = rows, .columns = columns}).size());
}

TEST(SessionView, LongTextIsWrapped) {
  view.next = "Press it with a known weight over gauge 6. Hold it still.";
  const auto drawn = lines({.rows = 24, .columns = 30});
  STRCMP_EQUAL("Press it with a known weight", drawn[1].c_str());
  STRCMP_EQUAL("over gauge 6. Hold it still.", drawn[2].c_str());
}

TEST(SessionView, WithoutUnicodeItIsAscii) {
  assess();
  const std::string shown = text({.rows = 30, .columns = 100, .unicode = false});
  CHECK_TRUE(std::ranges::all_of(shown, [](char c) { return static_cast<unsigned char>(c) < 0x80; }));
  STRCMP_CONTAINS("9 ##..", shown.c_str());
}

TEST(SessionView, WhatBecameOfACommandIsSaidInFull) {
  view.message =
      "the load of 9.807 N/m was not taken: nothing presses the finger. Press, hold still, and enter it "
      "again";
  STRCMP_EQUAL("still, and enter it again", lines()[4].c_str());
}

TEST(SessionView, WhatIsTypedStandsInPlaceOfTheKeys) {
  view.prompt = "angle in degrees, Return: 4_";
  STRCMP_EQUAL("angle in degrees, Return: 4_", lines().back().c_str());
}

TEST(SessionView, TheFingerIsSaidToBeAsItIs) {
  view.peakGauge = 7;
  for (const auto& [verdict, words] :
       {std::pair{Verdict::kOverRange, "gauge 7 is beyond its range: press less"},
        std::pair{Verdict::kUnsteady, "more slowly"}, std::pair{Verdict::kEnough, "harder or softer"},
        std::pair{Verdict::kWeak, "nothing touches it"}}) {
    view.now = verdict;
    STRCMP_CONTAINS(words, nowText(view).c_str());
  }
  view.silent_s = 2;
  STRCMP_EQUAL("no readings for 2 s", nowText(view).c_str());
  view.sets = 0;
  STRCMP_EQUAL("waiting for readings", nowText(view).c_str());
}

TEST(SessionView, ALineHasItAll) {
  assess();
  view.time_s = 12.34;
  view.complaint = "too few";
  STRCMP_EQUAL(
      "12.3 s  62 rows: 10 untouched, 1 of known load, 1 of known angle; 0 lost; errors to come: place 0.025 "
      "mm (drawn "
      "0.640, noise alone 0.010), normal 0.30 N/m (drawn 5.00, noise alone 0.10), tangential 0.20 N/m (drawn "
      "4.00, noise "
      "alone 0.08); unit of force +-0.8 %, zero of the angle +-0.12 deg; 100 more touches would gain 5 %; no "
      "fit "
      "yet: too few | Leave it "
      "alone for 5 s.",
      sessionLine(view).c_str());
}
