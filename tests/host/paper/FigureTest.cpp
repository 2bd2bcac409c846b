#include "host/paper/figure.hpp"

#include <algorithm>
#include <cmath>
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

TEST(Figure, TangentialLoadsActOnShearFourTimesAsStrongly) {
  checkClaim(3, "loads-compared", "in part", "e_rr normal / tangential 1.66; e_rt tangential / normal 3.90");
}

TEST(Figure, TheHalfPlaneServesUpToTheClaimedAngle) {
  checkClaim(4, "half-plane", "borne out", "5 % of it at 0.3861 rad");
}

TEST(Figure, CutOffsRise) {
  checkClaim(5, "cut-off-rises", "borne out", "19.2 at alpha = 0.7, 44.1 at 0.85, 450.3 at 0.95");
}

TEST(Figure, ShearIsFilteredForTangentialLoadsOnly) {
  checkClaim(5, "shear-filtered", "in part", "8.91 (last 8) from a tangential load, but 43.7 (last 43)");
}

TEST(Figure, TheKnifeEdgeIsFiltered) { checkClaim(2, "knife-edge", "borne out", "at the gauges"); }

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
  DOUBLES_EQUAL(2.79, rows.back().back(), 0.005);
}

TEST(Figure, OtherFingersHaveTheirFiguresToo) {
  config::FingerConfig thick;
  thick.finger = {.core_radius_m = 2e-3, .outer_radius_m = 10e-3, .poisson_ratio = 0.3};
  thick.gauges.radius_m = 6e-3;
  for (const Figure& each : figures()) CHECK_FALSE(each.picture(Subject(thick)).data.empty());
}
