#include "host/paper/figure.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <set>
#include <string>

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::paper;

TEST_GROUP(Figure) {
  const Subject finger = paperSubject();

  static const Figure& figure(int number) { return *std::ranges::find(figures(), number, &Figure::number); }

  static Claim claim(int number, const std::string& name) {
    for (Claim& found : figure(number).claims())
      if (found.name == name) return found;
    FAIL(name.c_str());
    return {};
  }
  static void checkClaim(int number, const char* name, const char* verdict, const char* computed) {
    const Claim found = claim(number, name);
    STRCMP_EQUAL_TEXT(verdict, nameOf(found.verdict), name);
    STRCMP_CONTAINS(computed, found.computed.c_str());
  }
};

TEST(Figure, EveryRowOfDataHasItsColumns) {
  for (const Figure& each : figures())
    for (const plot::DataFile& data : each.picture(finger).data) {
      CHECK_TRUE(data.rows.size() > 1);
      for (const auto& row : data.rows) {
        LONGS_EQUAL_TEXT(data.columns.size(), row.size(), each.title);
        CHECK_TRUE_TEXT(std::ranges::none_of(row, [](double value) { return std::isinf(value); }),
                        each.title);
      }
    }
}

TEST(Figure, ClaimsHaveNamesOfTheirOwn) {
  std::set<std::string> names;
  for (const Figure& each : figures())
    for (const Claim& found : each.claims()) {
      CHECK_TRUE_TEXT(names.insert(found.name).second, found.name.c_str());
      CHECK_TRUE(!found.paper.empty() && !found.computed.empty());
    }
}

TEST(Figure, StrainsEndAtTheTwentieth) {
  checkClaim(3, "cut-off", "in part",
             "e_rr 19 (19.29) from a normal and 20 (20.36) from a tangential load; e_rt 15 (15.72)");
  checkClaim(3, "cut-off", "in part", "10.8 %");
}

TEST(Figure, TangentialLoadsActOnShearThreeTimesAsStrongly) {
  checkClaim(3, "loads-compared", "borne out",
             "e_rr normal / tangential 1.66; e_rt tangential / normal 3.03");
}

TEST(Figure, TheHalfPlaneServesUpToTheClaimedAngle) {
  checkClaim(4, "half-plane", "borne out", "5 % of it at 0.3861 rad");
}

TEST(Figure, CutOffsRise) {
  checkClaim(5, "cut-off-rises", "borne out", "19.2 at alpha = 0.7, 44.1 at 0.85, 450.3 at 0.95");
}

TEST(Figure, ShearIsFilteredForTangentialLoadsOnly) {
  checkClaim(5, "shear-filtered", "in part", "9.03 (last 9) from a tangential load, but 43.7 (last 43)");
}

TEST(Figure, TheKnifeEdgeIsFiltered) {
  checkClaim(2, "knife-edge", "borne out", "at the gauges");
  checkClaim(
      2, "knife-edge", "borne out",
      "above the 20th harmonic under a line load, the turn of the whole (n = 0) left out: 0.055 of all");
}

// Fingers of the same proportions are drawn alike, whatever their size and rubber.
TEST(Figure, TheKnifeEdgeMovesSimilarFingersByAsMuchOfTheirRadius) {
  constexpr double kSmaller = 0.5e-3 / 12.7e-3;
  Subject small = finger;
  small.annulus.core_radius_m *= kSmaller;
  small.annulus.outer_radius_m *= kSmaller;
  small.annulus.shear_modulus_pa = 1e9;
  const plot::Picture picture = figure(2).picture(small), known = figure(2).picture(finger);
  for (std::size_t i = 0; i < known.data[0].rows.size(); ++i)
    for (const std::size_t place : {4U, 5U})
      DOUBLES_EQUAL(known.data[0].rows[i][place], picture.data[0].rows[i][place] / kSmaller, 1e-12);
  STRCMP_CONTAINS("applied = '60 N/m at 45°'", known.script.c_str());
  STRCMP_CONTAINS("applied = '2.85e+04 N/m at 45°'", picture.script.c_str());  // 60 kSmaller 1e9 / 8.3e4
}

TEST(Figure, TheHalfPlaneFiltersMore) {
  checkClaim(3, "half-plane-filters", "borne out", "half plane 18 (");
  checkClaim(3, "half-plane-filters", "borne out", "side lobe over peak: 12.5 and ");  // exactly 1/8
}

// At the core nothing moves: the innermost arc's points stay.
TEST(Figure, TheCoreStaysWhereItIs) {
  const plot::Picture picture = figure(2).picture(finger);
  for (const auto& row : picture.data[0].rows) {
    if (row[0] > finger.annulus.core_radius_m) continue;
    DOUBLES_EQUAL(row[2], row[4], 0);
    DOUBLES_EQUAL(row[3], row[5], 0);
  }
}

TEST(Figure, CutOffsAreThoseOfTheAlphaInTheirRow) {
  const auto rows = figure(5).picture(finger).data[0].rows;
  DOUBLES_EQUAL(0.5, rows.front()[0], 1e-12);
  DOUBLES_EQUAL(9.96, rows.front()[1], 0.005);
  DOUBLES_EQUAL(0.95, rows.back()[0], 1e-12);
  DOUBLES_EQUAL(365.0, rows.back()[3], 0.05);
  DOUBLES_EQUAL(2.785, rows.back().back(), 0.0005);
}

TEST(Figure, NineAreDrawn) {
  LONGS_EQUAL(9, figures().size());
  for (int i = 0; i < 9; ++i) LONGS_EQUAL(i + 2, figures()[static_cast<std::size_t>(i)].number);
}

TEST(Figure, LineLoadsStandForNarrowContactsOnly) {
  checkClaim(4, "impulses-vary-little", "in part",
             "lower the peak by 1.9, 7.4, 25 %; after the best scaling 0.9, 3.3, 10.8 %");
}

TEST(Figure, ThreeReadingsAreTwofoldWithSixteenGauges) {
  checkClaim(4, "three-points", "in part", "with 16 gauges, 0.0 % with 24");
}

TEST(Figure, TheFlatIndenterIsHertzianInShapeNotInSize) {
  checkClaim(7, "hertz", "in part", "load 21.4939 N/m and peak 13686.25 Pa, 4.69 % and 4.71 % above Hertz");
  checkClaim(7, "hertz", "in part", "within 3.1e-04 of the peak of a semi-ellipse");
  checkClaim(7, "hertz", "in part", "wrong by 0.41 of the peak, its load by -19 %");
}

TEST(Figure, AsManySingularValuesMatterAsThePaperSays) {
  checkClaim(8, "singular-values", "borne out",
             "8 and 11 (pressure without shear: 7 and 10); the closest to their levels are the 8th, 0.1060");
}

TEST(Figure, CountsGrowLinearly) {
  checkClaim(9, "counts-grow", "borne out", "4 6 8 9 11 12 14 15 17 18 20 above 1/10");
  checkClaim(9, "counts-grow", "borne out", "7 9 11 12 14 16 18 19 21 23 25 above 1/100");
}

TEST(Figure, BasisFunctionsAlternateInParity) {
  checkClaim(10, "parities", "borne out", "odd, even, odd, even");
  checkClaim(10, "parities", "borne out", "at most 0.23 % of the squares of V's columns is shear");
}

// Shares 0.159, 0.0102, 0.2825, 0.0361: computed for this project with another program.
TEST(Figure, OddShapesAreDark) {
  checkClaim(10, "odd-shapes", "borne out", "even 0.159, odd 0.010, even 0.28");
  checkClaim(10, "odd-shapes", "borne out",
             "4.9 times as strongly as odd ones at alpha = 0.7, 2.3 times at 0.85");
}

TEST(Figure, GaugesMatterAsMuchAsDepth) {
  checkClaim(10, "discrimination", "in part", "to 14 % by 32 gauges");
}

TEST(Figure, ShearAidsAsMuchAsOtherGauges) {
  checkClaim(5, "shear-sensing", "not borne out", "to 31.5 % by 16 gauges of e_rr, to 12.5 % by 16 of e_rt");
  checkClaim(5, "shear-sensing", "not borne out", "to 14.1 % by as many more");
}

// Four slopes with one to four zeros, of which the contact's centre is one of every odd one.
TEST(Figure, SlopesCrossZeroOneToFourTimes) {
  const auto rows = figure(10).picture(finger).data[0].rows;
  for (std::size_t k = 1; k <= 4; ++k) {
    std::size_t zeros = 0;
    for (std::size_t i = 1; i < rows.size(); ++i)
      if ((rows[i - 1][4 * k - 2] < 0) != (rows[i][4 * k - 2] < 0)) ++zeros;
    LONGS_EQUAL(k, zeros);
  }
}

TEST(Figure, NoPressureIsDrawnOutsideTheContactButByThePaper) {
  const plot::DataFile data = figure(7).picture(finger).data[0];
  const double half_rad = 1e-3 / 12.7e-3;
  for (const auto& row : data.rows) CHECK_EQUAL(std::abs(row[0]) < half_rad * (1 - 1e-9), row[1] > 0);
  CHECK_TRUE(std::abs(data.rows.front()[3]) > 0);
}

TEST(Figure, TheFlatIndenterFlattensTheSurface) {
  const auto rows = figure(6).picture(finger).data[0].rows;
  for (const auto& row : rows)
    if (row[0] == finger.annulus.outer_radius_m && std::abs(row[1]) < 1e-3 / 12.7e-3)
      DOUBLES_EQUAL(12.7e-3 - 72.0332531e-6, row[4], 1e-6);  // u_t theta is left: 8e-7 m at the edge
}

// A peak 20 um wide: every curve is sampled close enough to reach it.
TEST(Figure, ImpulseResponsesOfShallowGaugesReachTheirPeaks) {
  Subject shallow = finger;
  shallow.gaugeRadius_m = 12.68e-3;
  const plot::DataFile data = figure(4).picture(shallow).data[0];
  for (const std::size_t load : {0U, 1U}) {
    double largest = 0;
    for (const auto& row : data.rows) largest = std::max(largest, std::abs(row[7 + load]));
    // of the half plane at nu = 1/2: 1 / (2 pi mu depth), a quarter of that from a tangential load
    const double exact = 1 / (2 * std::numbers::pi * 8.3e4 * 20e-6) / (load == 0 ? 1 : 4);
    DOUBLES_EQUAL(exact, largest, 0.002 * exact);
  }
  CHECK_TRUE(std::ranges::is_sorted(data.rows, {}, [](const auto& row) { return row[0]; }));
}

// On the core an incompressible rubber has shear alone.
TEST(Figure, GaugesOnTheCoreHaveTheirShearDrawn) {
  Subject deep = finger;
  deep.gaugeRadius_m = deep.annulus.core_radius_m;
  for (const int number : {3, 4, 5}) {
    STRCMP_CONTAINS("e_rr is 0", figure(number).lacks(deep).c_str());
    STRCMP_CONTAINS("gauges.radius_m is the core's", figure(number).lacks(deep).c_str());
    STRCMP_EQUAL("", figure(number).lacks(finger).c_str());
  }
  STRCMP_CONTAINS("last = 30; cylinderRadial = 1; ", figure(3).picture(deep).script.c_str());
  STRCMP_CONTAINS("radialNote = ' (finger: 0)'", figure(4).picture(deep).script.c_str());
  STRCMP_CONTAINS("cylinderNormal = 1; cylinderTangential = 1; ", figure(4).picture(deep).script.c_str());
  STRCMP_CONTAINS("radialTitle(text) = ''", figure(5).picture(deep).script.c_str());
  deep.annulus.poisson_ratio = 0.3;
  STRCMP_CONTAINS("e_tt is 0", figure(5).lacks(deep).c_str());
  STRCMP_EQUAL("", figure(3).lacks(deep).c_str());
}

TEST(Figure, OtherFingersHaveTheirFiguresToo) {
  config::FingerConfig thick;
  thick.finger = {.core_radius_m = 2e-3, .outer_radius_m = 10e-3, .poisson_ratio = 0.3};
  thick.gauges.radius_m = 6e-3;
  for (const Figure& each : figures()) CHECK_FALSE(each.picture(Subject(thick)).data.empty());
}
