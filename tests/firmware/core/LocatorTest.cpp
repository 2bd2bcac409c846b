#include <algorithm>
#include <cmath>

#include "firmware/core/locator.hpp"

#include "firmware/core/estimate.hpp"
#include "tests/firmware/core/located_finger.hpp"
#include "tests/under_sanitizers.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP_BASE(Locator, LocatedFinger){};

TEST(Locator, AnswersFirmTouchesWithTheSecondSetOrSaysThatItSearches) {
  Presses presses(16, 45, 401, 0, 1.9);
  int searched = 0;
  for (int i = 0; i < 200; ++i) {
    const Press press = presses.next();
    locator.release();
    for (int set = 0; set < 2; ++set) update(presses.noisy(ring.strains(press), ring.noise_strain()));
    if (locator.answer().searching) {
      ++searched;
      continue;
    }
    CHECK_TRUE(locator.answer().accepted);
    DOUBLES_EQUAL(0, off_pitch(press), 6 * ring.bound(press)[0]);
  }
  CHECK(searched < 90);  // with much shear between two gauges all read little
}

TEST(Locator, FollowsAMovingTouchWithTheAnswersOfOneSetAlone) {
  Presses noise(16, 0, 402);
  Locator alone(FitMode::kRefined);
  double squares = 0;
  for (int set = 0; set < 300; ++set) {
    const Press press{3 + set * 0.01, 25, 8 * std::sin(set / 20.0), 1.5};  // 50 um a set
    const auto strains = noise.noisy(ring.strains(press), ring.noise_strain());
    settle(strains);
    locateOnce(ring.tables(), ring.raw(strains), ring.allGauges(), alone);
    const double apart = sigmasBetween(found(), foundBy(alone, ring), ring.bound(press));
    CHECK(apart < 1);
    squares += apart * apart;
  }
  CHECK(std::sqrt(squares / 300) < 0.15);
}

TEST(Locator, FollowsAMovingTouchWhileASearchGoesOn) {
  Presses noise(16, 0, 411);
  int setsOfSearches = 0;
  for (int set = 0; set < 1000; ++set) {
    const Press press{3 + set * 0.03, 20, 5, 4};  // 150 um a set, so wide that other answers are looked for
    update(noise.noisy(ring.strains(press), ring.noise_strain()));
    if (set < 3) continue;
    setsOfSearches += locator.answer().searching;
    DOUBLES_EQUAL(0, off_pitch(press), 6 * ring.bound(press)[0]);
  }
  CHECK_COMPARE(setsOfSearches, >, 5);
}

TEST(Locator, FollowsATouchThatGrowsAndFades) {
  Presses noise(16, 0, 403);
  for (int set = 0; set < 400; ++set) {
    const double load = 1 + 0.2 * std::min(set, 400 - set);
    const Press press{7.3, load, load / 3, 1};
    settle(noise.noisy(ring.strains(press), ring.noise_strain()));
    DOUBLES_EQUAL(load, found().normal, 6 * ring.bound(press)[1] + 0.002 * load);
    DOUBLES_EQUAL(0, off_pitch(press), 6 * ring.bound(press)[0] + 0.01);
  }
}

TEST(Locator, ATouchThatJumpsIsFoundAnew) {
  for (int set = 0; set < 50; ++set) {
    const Press press{set * 5.3, 20, 0, 1};
    settle(ring.strains(press));
    DOUBLES_EQUAL(0, off_pitch(press), 0.02);
  }
}

TEST(Locator, AfterAReleaseNothingIsLeft) {
  update(ring.strains({{2.2, 20, 0, 1}, {9.7, 20, 0, 1}}));
  locator.release();
  CHECK_FALSE(locator.answer().searching);
  CHECK_FALSE(locator.answer().accepted);
  settle(ring.strains({5.5, 20, 0, 1}));
  DOUBLES_EQUAL(5.5, found().position_pitch, 0.01);
}

TEST(Locator, ASearchTakesSeveralUpdatesAndSaysSo) {
  update(ring.strains({{2.2, 20, 0, 1}, {9.7, 20, 0, 1}}));
  CHECK_TRUE(locator.answer().searching);
  const int updates = settle(ring.strains({{2.2, 20, 0, 1}, {9.7, 20, 0, 1}}));
  CHECK(updates > 2 && updates < kLongestSearch);
  CHECK_FALSE(locator.answer().searching);
}

TEST(Locator, ASecondContactIsLocatedFrom4PitchesOn) {
  Presses presses(16, 30, 404, 0, 1);
  int wrong = 0;
  for (int i = 0; i < 40; ++i) {
    const Press one = presses.next(), other{one.position_pitch + 4 + i % 5, 8 + i % 4 * 7.0, i % 3 * 2.0, 1};
    locator.release();
    settle(presses.noisy(ring.strains({one, other}), ring.noise_strain()));
    if (!areBothFound(one, other, 0.1)) ++wrong;
  }
  LONGS_EQUAL(0, wrong);
}

TEST(Locator, ASecondContactIsMostlyLocatedFrom2AndAHalfPitchesOn) {
  Presses presses(16, 30, 405, 0, 1);
  int wrong = 0;
  for (int i = 0; i < 40; ++i) {
    const Press one = presses.next(), other{one.position_pitch + 2.5, 15 + i % 2 * 15.0, 2, 1};
    locator.release();
    settle(presses.noisy(ring.strains({one, other}), ring.noise_strain()));
    if (!areBothFound(one, other, 0.25)) ++wrong;
  }
  CHECK(wrong <= 4);
}

TEST(Locator, ASecondContactThatJoinsIsLocated) {
  const Press first{3.4, 20, 4, 1};
  for (int set = 0; set < 400; ++set) {
    const Press joining{9.8, set / 20.0, 0, 1};
    update(ring.strains({first, joining}));
  }
  settle(ring.strains({first, {9.8, 20, 0, 1}}));
  CHECK_TRUE(areBothFound(first, {9.8, 20, 0, 1}, 0.05));
  CHECK_TRUE(locator.answer().several || locator.answer().solution.hypothesis.contacts == 2);
}

TEST(Locator, WhenOneOfTwoLeavesTheOtherIsFollowed) {
  const Press first{3.4, 20, 4, 1};
  Presses noise(16, 0, 412);
  settle(ring.strains({first, {9.8, 20, 0, 1}}));
  for (int set = 0; set < 200; ++set) settle(noise.noisy(ring.strains(first), ring.noise_strain()));
  LONGS_EQUAL(1, locator.answer().solution.hypothesis.contacts);
  DOUBLES_EQUAL(0, off_pitch(first), 0.02);
}

TEST(Locator, AGaugeThatStopsCountingChangesNothing) {
  const Press press{6.3, 25, 5, 1};
  settle(ring.strains(press));
  for (int gauge = 0; gauge < 16; ++gauge) {
    settle(ring.strains(press), ring.allGauges() & ~(GaugeSet{1} << gauge));
    settle(ring.strains(press), ring.allGauges() & ~(GaugeSet{1} << gauge));
    CHECK_FALSE(contains(locator.answer().solution.hypothesis.gauges, gauge));
    DOUBLES_EQUAL(0, off_pitch(press), 0.01);
  }
}

TEST(Locator, AGaugeAtTheEdgeOfItsRangeDoesNotBeginTheTouchAnew) {
  Presses presses(16, 30, 432);
  const Press press{6.3, 30, 5, 0.5};
  settle(ring.strains(press));
  for (int set = 0; set < 200; ++set) {
    const GaugeSet edge = set % 3 == 0 ? GaugeSet{1} << 6 : 0;
    update(ring, presses.noisy(ring.strains(press), ring.noise_strain()), ring.allGauges() & ~edge);
    CHECK_FALSE(locator.answer().searching);
    CHECK_FALSE(contains(locator.answer().solution.hypothesis.gauges & edge, 6));
    DOUBLES_EQUAL(0, off_pitch(press), 0.02);
  }
}

TEST(Locator, TwoContactsThatBecameOneAreToldAsOneInTheEnd) {
  Presses random(16, 20, 415, 1, 3);
  int pairs = 0;
  for (int i = 0; i < randomCases(150); ++i) {
    locator.release();
    const Press press = random.next();
    const double apart_pitch = 3 + 3 * (i % 10) / 10.0, load = 10 + i % 20;
    for (int set = 0; set < 1600; ++set) {
      const double together = std::clamp((800 - set) / 400.0, 0.0, 1.0);
      const double lifted = std::clamp((1000 - set) / 100.0, 0.0, 1.0);
      const Press one{press.position_pitch, 30, 3, press.width_mm},
          other{press.position_pitch + apart_pitch * together, load * lifted, 0, press.width_mm};
      update(random.noisy(lifted > 0 ? ring.strains({one, other}) : ring.strains(one), ring.noise_strain()));
    }
    pairs += locator.answer().solution.hypothesis.contacts == 2;
  }
  LONGS_EQUAL(0, pairs);
}

TEST(Locator, NoiseThatIsMeasuredWidensTheGate) {
  Presses presses(16, 10, 410);
  int accepted = 0, acceptedAsConfigured = 0;
  for (int i = 0; i < 50; ++i) {
    const auto strains = ring.raw(presses.noisy(ring.strains(presses.next()), 5 * ring.noise_strain()));
    if (isAccepted(strains, 25 * kConfiguredNoise_q4)) ++accepted;
    if (isAccepted(strains, kConfiguredNoise_q4)) ++acceptedAsConfigured;
  }
  CHECK(accepted >= 48 && acceptedAsConfigured <= 5);
}

TEST(Locator, TwoContactsThatSlideTogetherAreWhereTheyAreWhenTheSearchEnds) {
  Presses noise(16, 0, 425);
  for (int i = 0; i < 20; ++i) {
    locator.release();
    Press one{3 + i * 0.77, 20, 3, 1}, other{8 + i * 0.77, 20, 0, 1};
    int sets = 0;
    do {
      one.position_pitch += 0.01;
      other.position_pitch += 0.01;
      update(noise.noisy(ring.strains({one, other}), ring.noise_strain()));
    } while ((sets < 3 || locator.answer().searching) && ++sets < kLongestSearch);
    CHECK_COMPARE(sets, >, 20);
    CHECK_TRUE(areBothFound(one, other, 0.05));
  }
}

TEST(Locator, TwoContactsThatGrowDuringTheSearchAreFoundWhenItEnds) {
  Presses noise(16, 0, 426);
  for (int i = 0; i < 20; ++i) {
    locator.release();
    Press one, other;
    int sets = 0;
    do {
      const double times = std::min(1.0, (sets + 1) / 60.0);
      one = {i * 0.7, 20 * times, 3 * times, 1};
      other = {i * 0.7 + 5, 20 * times, 0, 1};
      update(noise.noisy(ring.strains({one, other}), ring.noise_strain()));
    } while ((sets < 3 || locator.answer().searching) && ++sets < 2 * kLongestSearch);
    CHECK_TRUE(areBothFound(one, other, 0.2));
  }
}

// Such a touch has a second answer 0.1 pitch away that leaves chi-squared of 40 without noise.
TEST(Locator, FirmNarrowTouchesOnALooseRingAreLookedInto) {
  config::FingerConfig config = ModelRing::asDrawn(32);
  config.gauges.radius_m = 11.2e-3;
  config.contact.largest_width_m = 4e-3;
  const ModelRing loose{config};
  const Press press{305.394 / 11.25, 7.79, 4.84};
  locateOnce(loose.tables(), loose.raw(press), loose.allGauges(), locator);
  const Press found = foundBy(locator, loose);
  DOUBLES_EQUAL(0, loose.between(press.position_pitch, found.position_pitch), 0.01);
  DOUBLES_EQUAL(press.normal, found.normal, 0.02);
}
