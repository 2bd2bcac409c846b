#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <string>

#include "tests/stability/report.hpp"
#include "tests/stability/survey.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::stability;

TEST_GROUP(Stability) {
  const HarmonicRegion good{{0.1, 0.5}, {1, 1}, {0.5, 0.5}, Place::kCore, {}};
  const FieldRegion field{0.7, 0.5, 1e-6, 0.5, {}, false};
  const ContactRegion contact{0.7, 0.5, 0.1, contact::Regime::kSliding, "flat", 1e-12, false, false};
};

// The whole survey is the stability preset's; these few samples of every region are for every day.
TEST(Stability, HarmonicsAreWithinTheBarEverywhere) {
  const unsigned seed = std::random_device{}();
  std::printf("seed %u ", seed);
  const auto regions = surveyHarmonics(2, seed);
  LONGS_EQUAL(630, regions.size());
  CHECK_TRUE_TEXT(holds(regions), harmonicTable(regions).c_str());
}

TEST(Stability, FieldsAreWithinTheBarFromNarrowLoadsToAQuarterTurn) {
  const auto regions = surveyFields(150);
  CHECK_TRUE(regions.size() > 100);
  CHECK_TRUE_TEXT(holds(regions), fieldTable(regions).c_str());
}

TEST(Stability, ContactsFitOrSayThatTheyDoNot) {
  const auto regions = surveyContacts(std::array{0.7}, std::array{0.3, 0.5});
  LONGS_EQUAL(2 * 6 * 3 * 3, regions.size());
  CHECK_TRUE_TEXT(holds(regions), contactTable(regions).c_str());
}

// A quarter as wide as the finger on a layer of 0.13 mm: too much for the series.
TEST(Stability, AStuckContactThatMissesSaysSo) {
  const contact::SurfaceKernel kernel({0.99 * 12.7e-3, 12.7e-3, 8.3e4, 0.5});
  contact::ContactRequest request;
  request.regime = contact::Regime::kStick;
  request.size.value = std::numbers::pi / 4 * 12.7e-3;
  const contact::Contact wide = solveContact(kernel, request);
  CHECK_TRUE(wide.residual_m > 1e-6 * wide.depth_m);
  CHECK_FALSE(wide.warnings.empty());
}

TEST(Stability, AContactThatMissesSilentlyIsSeen) {
  auto regions = std::vector{contact, contact};
  CHECK_TRUE(holds(regions));
  regions[1].misfit = 1.1e-6;
  CHECK_FALSE(holds(regions));
  regions[1].isWarnedOf = true;
  CHECK_TRUE(holds(regions));
  regions[1].misfit = double{NAN};
  CHECK_FALSE(holds(regions));
}

TEST(Stability, AnErrorAboveTheBarIsSeen) {
  auto regions = std::vector{good, good};
  CHECK_TRUE(holds(regions));
  regions[1].worst.error[model::kUt] = 1.1e-13;
  CHECK_FALSE(holds(regions));
  regions[1].worst.error[model::kUt] = double{NAN};
  CHECK_FALSE(holds(regions));
}

TEST(Stability, WhatIsNotFiniteIsSeen) {
  auto regions = std::vector{field};
  regions[0].worst.notFinite = 1;
  CHECK_FALSE(holds(regions));
}

TEST(Stability, WhatIsRefusedSaysSo) {
  auto refused = field;
  refused.isRefused = true;
  auto refusedContact = contact;
  refusedContact.isRefused = true;
  CHECK_TRUE(holds(std::vector{refusedContact}));
  const std::string text = summary({{good}, {refused}, {refusedContact}});
  STRCMP_CONTAINS("| 0.7 | refused |", text.c_str());
  STRCMP_CONTAINS("| alpha \\ width, rad | 0.1 |\n|--|--|\n| 0.7 | refused |", text.c_str());
}

TEST(Stability, NotANumberCountsInContactsToo) {
  auto worse = contact;
  worse.misfit = double{NAN};
  LONGS_EQUAL(1, countNotFinite({{good}, {field}, {contact, worse}}));
}

TEST(Stability, NothingSurveyedIsNotGood) { CHECK_FALSE(holds(std::vector<FieldRegion>{})); }

TEST(Stability, TheSummaryShowsTheWorstOfARegion) {
  auto worse = good;
  worse.worst.error[model::kTrr] = 3e-15;
  STRCMP_CONTAINS("| 0.1 to 0.5 | 3.0e-15 |", summary({{good, worse, good}, {field}, {contact}}).c_str());
}

TEST(Stability, TheSummaryHasACellForEveryPairOfBounds) {
  std::vector<ContactRegion> contacts;
  for (int i = 0; i < 9; ++i) {
    contacts.push_back(contact);
    contacts.back().width_rad = i + 1;
    contacts.back().misfit = i * 1e-9;
  }
  STRCMP_CONTAINS("\n| 0.7 | 0.0e+00 | 1.0e-09 | 2.0e-09 | 3.0e-09 | 4.0e-09 |",
                  summary({{good}, {field}, contacts}).c_str());
}

TEST(Stability, TablesHaveARowARegion) {
  STRCMP_CONTAINS("\n0.1,0.5,1,1,0.5,0.5,core,0,0,0,0,0,0,0,0,0,0,0\n", harmonicTable({good}).c_str());
  STRCMP_CONTAINS("\n0.7,0.5,1e-06,0.5,0,0,0,0,0,0,0,0,0,0,0\n", fieldTable({field}).c_str());
  STRCMP_CONTAINS("\n0.7,0.5,0.1,flat,sliding,1e-12,0,0\n", contactTable({contact}).c_str());
}
