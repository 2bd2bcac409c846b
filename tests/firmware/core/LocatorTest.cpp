#include "firmware/core/locator.hpp"

#include <bit>

#include "firmware/core/estimate.hpp"
#include "tests/firmware/core/model_ring.hpp"
#include "tests/under_sanitizers.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(Locator) {
  const ModelRing ring{ModelRing::asDrawn()};
  Locator locator{FitMode::kRefined};
  static constexpr int kLongestSearch = 400;  ///< sample sets

  void update(const ModelRing& of, const std::vector<double>& strains, GaugeSet gauges) {
    locator.update(of.tables(), of.raw(strains), gauges);
  }
  void update(const std::vector<double>& strains) { update(ring, strains, ring.allGauges()); }
  /// Until the search, if there is one, is over; returns the updates that it took.
  int settle(const std::vector<double>& strains) { return settle(strains, ring.allGauges()); }
  int settle(const std::vector<double>& strains, GaugeSet gauges) {
    int updates = 0;
    do update(ring, strains, gauges);
    while (locator.answer().searching && ++updates < kLongestSearch);
    return updates;
  }
  Press found(int contact = 0) const { return foundBy(locator, ring, contact); }
  static Press foundBy(const Locator& by, const ModelRing& of, int contact = 0) {
    return of.pressOf(by.answer().solution.contact[static_cast<std::size_t>(contact)], by.answer().shift);
  }
  /// Largest difference of place and loads, over the Cramer-Rao bound.
  double sigmasBetween(const Press& a, const Press& b, const Eigen::Vector4d& bound) const {
    return std::max({std::abs(ring.between(a.position_pitch, b.position_pitch)) / bound[0],
                     std::abs(a.normal - b.normal) / bound[1],
                     std::abs(a.tangential - b.tangential) / bound[2]});
  }
  double off_pitch(const Press& press, int contact = 0) const {
    return std::abs(ring.between(press.position_pitch, found(contact).position_pitch));
  }
  bool areBothFound(const Press& one, const Press& other, double within_pitch) const {
    if (locator.answer().solution.hypothesis.contacts != 2) return false;
    return (off_pitch(one, 0) < within_pitch && off_pitch(other, 1) < within_pitch) ||
           (off_pitch(one, 1) < within_pitch && off_pitch(other, 0) < within_pitch);
  }
  bool isAccepted(const std::vector<std::int32_t>& strains_q32, std::uint32_t noise_q4) {
    locator.release();
    do locator.update(ring.tables(), strains_q32, ring.allGauges(), noise_q4);
    while (locator.answer().searching);
    return locator.answer().accepted && locator.answer().solution.hypothesis.contacts == 1;
  }
};

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

TEST(Locator, TwoContactsAreNeverBlamedOnAGauge) {
  Presses presses(16, 20, 406, 0, 2);
  for (int i = 0; i < 60; ++i) {
    const Press one = presses.next(), other{one.position_pitch + 1 + i % 12 * 0.5, 6 + i % 5 * 4.0, 0, 1};
    locator.release();
    settle(presses.noisy(ring.strains({one, other}), ring.noise_strain()));
    LONGS_EQUAL(0, locator.answer().suspect);
  }
}

TEST(Locator, AWideContactIsNeverBlamedOnAGauge) {
  Presses presses(16, 20, 407, 1, 7);
  for (int i = 0; i < 100; ++i) {
    locator.release();
    settle(presses.noisy(ring.strains(presses.next()), ring.noise_strain()));
    LONGS_EQUAL(0, locator.answer().suspect);
    LONGS_EQUAL(1, locator.answer().solution.hypothesis.contacts);
  }
}

TEST(Locator, AGaugeThatIsFarOffIsSuspectedAndLeftOut) {
  Presses presses(16, 30, 408, 0, 2);
  int found = 0;
  for (int i = 0; i < 50; ++i) {
    const Press press = presses.next();
    const auto gauge = static_cast<std::size_t>(std::lround(press.position_pitch)) % 16;
    auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
    strains[gauge] += i % 2 == 0 ? 6e-3 : -6e-3;
    locator.release();
    settle(strains);
    if (locator.answer().suspect != GaugeSet{1} << gauge) continue;
    ++found;
    if (locator.answer().doubtful) continue;
    DOUBLES_EQUAL(0, off_pitch(press), 0.1);
  }
  CHECK(found >= 44);
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

// Builds leave more than noise and a quarter of the model's error in every set.
TEST(Locator, OnAFingerAsBuiltWhatWasLookedIntoIsNeitherDoubtedNorLookedIntoAgain) {
  const ModelRing built;
  Presses presses(16, 20, 417, 0, 2);
  constexpr int kTouches = kSanitized ? 600 : 2700;
  int settled = 0, doubted = 0;
  for (int i = 0; i < kTouches; ++i) {
    const auto strains = built.strainsAsBuilt(presses.next(), presses);
    const ScaledReadings readings = built.scaled(strains);
    const auto hold = [&](int sets) {
      int searched = 0;
      for (int set = 0; set < sets; ++set) {
        update(built, presses.noisy(strains, built.noise_strain()), built.allGauges());
        searched += locator.isSearching();
      }
      return searched;
    };
    locator.release();
    hold(160);
    const Answer& answer = locator.answer();
    const bool isSettled = answer.solution.hypothesis.contacts == 1 && !answer.searching &&
                           isPlainAsBuilt(built.constants(), answer.solution, readings) &&
                           !isPlain(built.constants(), answer.solution, readings);
    if (!isSettled) continue;
    ++settled;
    doubted += answer.doubtful;
    if (!answer.doubtful && !answer.anyRival) LONGS_EQUAL(0, hold(200));
  }
  std::printf("%d settled, %d doubted ", settled, doubted);
  CHECK_COMPARE(settled, >=, kTouches / 300);
  CHECK_COMPARE(doubted, <=, settled / 3);
}

// Places a tenth of a pitch apart in two sets of one touch that nothing moves, both told without a flag.
TEST(Locator, ATouchThatIsHeldOnAFingerAsBuiltSeldomJumps) {
  const ModelRing built;
  Presses presses(16, 10, 430, 0, 3);
  constexpr int kTouches = kSanitized ? 60 : 1000, kSets = 200;
  int jumps = 0, told = 0;
  for (int i = 0; i < kTouches; ++i) {
    const auto strains = built.strainsAsBuilt(presses.next(), presses);
    locator.release();
    settle(strains);
    std::optional<double> last_pitch;
    for (int set = 0; set < kSets; ++set) {
      update(built, presses.noisy(strains, built.noise_strain()), built.allGauges());
      const Contact contact =
          estimate(built.constants(), locator.answer(), unitErrors(locator.linearisation()), 0);
      const double now_pitch = foundBy(locator, built).position_pitch;
      if (!contact.uncertain) {
        ++told;
        jumps += last_pitch && std::abs(built.between(*last_pitch, now_pitch)) > 0.1;
        last_pitch = now_pitch;
      }
    }
  }
  std::printf("%d of %d ", jumps, told);
  CHECK_COMPARE(told, >, kTouches * kSets / 2);
  CHECK_COMPARE(jumps, <=, told / 2500);
}

// What it leaves behind is a pair whose second contact makes up for how the finger is built.
TEST(Locator, AContactThatIsLiftedFromAFingerAsBuiltIsGoneWithinASecond) {
  const ModelRing built;
  Presses presses(16, 20, 431, 0, 2);
  int gone = 0;
  for (int i = 0; i < 40; ++i) {
    const Press first = presses.next(), second{first.position_pitch + 5, 20, 0, 1};
    Presses same = presses;  // both are of one finger
    const auto one = built.strainsAsBuilt(first, presses), other = built.strainsAsBuilt(second, same);
    locator.release();
    for (int set = 0; set < 1400; ++set) {
      const double down = std::clamp((400.0 - set) / 50, 0.0, 1.0);
      auto both = one;
      for (std::size_t gauge = 0; gauge < both.size(); ++gauge) both[gauge] += down * other[gauge];
      update(built, presses.noisy(both, built.noise_strain()), built.allGauges());
    }
    gone += locator.answer().solution.hypothesis.contacts == 1;
  }
  std::printf("%d gone ", gone);
  LONGS_EQUAL(40, gone);
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

TEST(Locator, ARivalThatIsNearlyAsLikelyIsTold) {
  Presses presses(16, 3, 409, 5, 6);
  int rivals = 0;
  for (int i = 0; i < 50; ++i) {
    locator.release();
    settle(presses.noisy(ring.strains(presses.next()), ring.noise_strain()));
    if (!locator.answer().anyRival) continue;
    ++rivals;
    CHECK(locator.answer().rival[0].angle_q32 != locator.answer().solution.contact[0].angle_q32);
  }
  CHECK(rivals > 10);
}

TEST(Locator, ARivalIsForgottenOnceTheTouchHasTold) {
  Presses presses(16, 3, 412, 5, 6);
  int rivals = 0, left = 0;
  for (int i = 0; i < 50; ++i) {
    locator.release();
    Press press = presses.next();
    settle(presses.noisy(ring.strains(press), ring.noise_strain()));
    if (!locator.answer().anyRival) continue;
    ++rivals;
    for (int set = 0; set < 100; ++set, press.normal *= 1.03, press.tangential *= 1.03)
      update(presses.noisy(ring.strains(press), ring.noise_strain()));
    left += locator.answer().anyRival;
    DOUBLES_EQUAL(0, off_pitch(press), 0.02);
  }
  CHECK(rivals > 10);
  CHECK_COMPARE(left, <=, rivals / 5);
}

// Touches of which one set alone often doesn't tell which of two places is right, for half a second each.
TEST(Locator, AFaintTouchThatIsHeldIsSeldomToldElsewhereUnflagged) {
  constexpr int kTouches = kSanitized ? 4 : 300, kSets = 500;
  Presses presses(16, 1, 415, 0, 2);
  int silent = 0, told = 0;
  for (int i = 0; i < kTouches; ++i) {
    locator.release();
    const Press press = presses.next();
    for (int set = 0; set < kSets; ++set) {
      update(presses.noisy(ring.strains(press), ring.noise_strain()));
      const Contact contact =
          estimate(ring.constants(), locator.answer(), unitErrors(locator.linearisation()), 0);
      if (contact.uncertain) continue;
      ++told;
      silent += off_pitch(press) > 0.5;
    }
  }
  std::printf("%d of %d ", silent, told);
  CHECK_COMPARE(told, >, kTouches * kSets / 4);
  CHECK_COMPARE(silent, <=, told / 500);
}

TEST(Locator, OtherAnswersAreLookedForAgainOnceATouchIsTwiceAsFirm) {
  Presses presses(16, 1, 416);
  const auto searchedWithin = [&](int sets, double normal_n_per_m) {
    int searched = 0;
    for (int set = 0; set < sets; ++set) {
      update(presses.noisy(ring.strains({4.9, normal_n_per_m, 0, 0.85}), ring.noise_strain()));
      searched += locator.isSearching();
    }
    return searched;
  };
  searchedWithin(400, 4);
  LONGS_EQUAL(0, searchedWithin(200, 4));
  CHECK(searchedWithin(200, 9) > 0);
  LONGS_EQUAL(0, searchedWithin(200, 9));
  CHECK_FALSE(locator.answer().anyRival);
}

TEST(Locator, ARivalKeepsItsLoadWhenTheReadingsScaleChanges) {
  Presses presses(16, 5, 413, 2, 6);
  int rescaled = 0;
  for (int i = 0; i < 400; ++i) {
    locator.release();
    const auto strains = ring.strains(presses.next());
    settle(presses.noisy(strains, ring.noise_strain()));
    const auto rivalsLoad = [&] {
      return std::ldexp(locator.answer().rival[0].normal, locator.answer().shift);
    };
    for (double times = 1.01; times < 2.2 && locator.answer().anyRival; times *= 1.01) {
      const double before = rivalsLoad();
      const int shift = locator.answer().shift;
      auto more = strains;
      for (double& strain : more) strain *= times;
      update(presses.noisy(more, ring.noise_strain()));
      if (locator.answer().shift == shift || !locator.answer().anyRival) continue;
      ++rescaled;
      DOUBLES_EQUAL(1, rivalsLoad() / before, 0.2);  // it may have been fitted to the new readings
    }
  }
  CHECK(rescaled > 10);
}

// The residual of a set jitters, and with it what would be told apart.
TEST(Locator, WhetherARivalIsAsLikelyIsJudgedWhenItIsFitted) {
  const ModelRing built{config::FingerConfig{}};
  Presses presses(16, 5, 417, 2, 6);
  int rivals = 0, changes = 0;
  for (int i = 0; i < 50; ++i) {
    locator.release();
    const auto strains = built.strains(presses.next());
    for (int set = 0; set < 160; ++set) {
      const bool before = locator.answer().rivalIsAsLikely;
      update(built, presses.noisy(strains, built.noise_strain()), built.allGauges());
      if (locator.isSearching() || !locator.answer().anyRival) continue;
      ++rivals;
      changes += locator.answer().rivalIsAsLikely != before;
    }
  }
  std::printf("%d changes in %d sets ", changes, rivals);
  CHECK_COMPARE(rivals, >, 1000);
  CHECK_COMPARE(changes, <=, rivals / 8);
}

TEST(Locator, ASearchEndsWhileTwoContactsOfACalibratedFingerTremble) {
  config::FingerConfig config = ModelRing::asDrawn();
  config.calibration.depth_offset_m.assign(16, 0.02e-3);
  const ModelRing calibrated{config};
  Presses noise(16, 20, 414);
  int searching = 0;
  for (int set = 0; set < 6000; ++set) {
    const double off = set < 1500 ? 0 : 0.02 * (set % 2 == 0 ? -1 : 1) * (1 + set / 2 % 2);
    std::vector<Press> presses{{4.6 + off, 20, 3, 2}, {11.2 + off, 20, 0, 2}};
    if (set >= 2000) presses.push_back({8 + off, 3, 0, 1});
    update(calibrated, noise.noisy(calibrated.strains(presses), calibrated.noise_strain()),
           calibrated.allGauges());
    searching = locator.isSearching() ? searching + 1 : 0;
    CHECK_COMPARE(searching, <, 2 * kLongestSearch);
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

// With and without a gauge that is off by a few deviations one contact explains the readings, and of a faint
// touch two contacts do.
TEST(Locator, OnlyAnotherPlaceOrNumberOfContactsIsDoubt) {
  struct Doubts {
    int here = 0, hereDoubted = 0, elsewhere = 0, elsewhereDoubted = 0;
  };
  const auto doubts = [&](double load_n_per_m, int touches) {
    Presses presses(16, load_n_per_m, 418, 0, 2);
    Linearisation scratch;
    Search search;
    Doubts result;
    for (int i = 0; i < touches; ++i) {
      const Press press = presses.next();
      auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
      strains[static_cast<std::size_t>(std::lround(press.position_pitch) + i % 3) % 16] +=
          (i % 2 == 0 ? -6 : 6) * ring.noise_strain();
      locateOnce(ring.tables(), ring.raw(strains), ring.allGauges(), locator);
      const ScaledReadings readings = ring.scaled(strains);
      search.begin(ring.tables(), readings, {1, true, ring.allGauges()});
      while (search.isRunning()) search.advance(ring.tables(), Search::kWork, scratch);
      const Solution &all = search.single().best, &without = search.withoutOne().best;
      if (!search.withoutOne().anyBest || !firmware::isAccepted(ring.constants(), all, readings) ||
          !firmware::isAccepted(ring.constants(), without, readings))
        continue;
      const Wide more = without.residualEnergy + energyOf(readings, threshold::kLeftOut) - all.residualEnergy;
      if (magnitude(more) >= ambiguity(readings.variances, more > 0 ? all : without)) continue;
      const bool isElsewhere = areElsewhere(ring.constants(), 1, all.contact, without.contact);
      ++(isElsewhere ? result.elsewhere : result.here);
      (isElsewhere ? result.elsewhereDoubted : result.hereDoubted) += locator.answer().doubtful;
    }
    return result;
  };
  const Doubts firm = doubts(20, 600), faint = doubts(2, 600);
  std::printf("%d of %d, %d of %d, %d of %d ", firm.hereDoubted, firm.here, faint.hereDoubted, faint.here,
              faint.elsewhereDoubted, faint.elsewhere);
  CHECK_COMPARE(firm.here, >, 8);
  CHECK_COMPARE(firm.hereDoubted, <=, firm.here / 3);
  CHECK_COMPARE(faint.here, >, 30);
  CHECK_COMPARE(faint.hereDoubted, >=, faint.here / 2);
  CHECK_COMPARE(faint.elsewhere, >, 5);
  LONGS_EQUAL(faint.elsewhere, faint.elsewhereDoubted);
}

TEST(Locator, OfAFaintTouchNoOtherGaugeIsSuspected) {
  for (const double load_n_per_m : {1.0, 4.0}) {
    Presses presses(16, load_n_per_m, 419, 0, 2);
    int named = 0;
    for (int i = 0; i < 300; ++i) {
      const Press press = presses.next();
      const auto gauge = static_cast<std::size_t>(std::lround(press.position_pitch) + i % 3) % 16;
      auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
      strains[gauge] += (i % 2 == 0 ? -20 : 20) * ring.noise_strain();
      locateOnce(ring.tables(), ring.raw(strains), ring.allGauges(), locator);
      const GaugeSet suspect = locator.answer().suspect;
      named += suspect != 0;
      CHECK_TRUE(suspect == 0 || suspect == GaugeSet{1} << gauge);
    }
    CHECK_COMPARE(named, >, 15);
  }
}

TEST(Locator, AGaugeThatIsALittleOffIsLeftOutButNotSuspected) {
  Presses presses(16, 30, 427, 0, 1);
  int leftOut = 0;
  for (int i = 0; i < 40; ++i) {
    const Press press = presses.next();
    auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
    strains[static_cast<std::size_t>(std::lround(press.position_pitch) + i % 3) % 16] +=
        20 * ring.noise_strain();
    locator.release();
    settle(strains);
    leftOut += locator.answer().solution.hypothesis.gauges != ring.allGauges();
    LONGS_EQUAL(0, locator.answer().suspect);
  }
  CHECK_COMPARE(leftOut, >, 10);
}

TEST(Locator, ARivalMovesAlongBetweenItsFits) {
  Presses presses(16, 3, 420, 5, 6);
  int rivals = 0, moved = 0;
  const auto apart_q32 = [&] {
    return locator.answer().rival[0].angle_q32 - locator.answer().solution.contact[0].angle_q32;
  };
  for (int i = 0; i < 50; ++i) {
    locator.release();
    Press press = presses.next();
    settle(ring.strains(press));
    if (!locator.answer().anyRival) continue;
    ++rivals;
    const std::uint32_t before_q32 = apart_q32();
    press.position_pitch += 0.02;
    update(ring.strains(press));
    moved += apart_q32() == before_q32;
  }
  CHECK_COMPARE(rivals, >, 10);
  CHECK_COMPARE(moved, >, rivals / 2);  // the others' rivals were fitted to this set
}

TEST(Locator, AFirmTouchForgetsItsRivalAtOnce) {
  Presses presses(16, 1, 422);
  int rivals = 0;
  for (int i = 0; i < 100; ++i) {
    const auto hold = [&](double normal_n_per_m) {
      return presses.noisy(ring.strains({4.727, normal_n_per_m, 0, 0.85}), ring.noise_strain());
    };
    locator.release();
    settle(hold(1));
    if (!locator.answer().anyRival || off_pitch({4.727, 1, 0}) > 0.3) continue;
    ++rivals;
    for (int set = 0; set < 8; ++set) update(hold(40));
    CHECK_TRUE(locator.answer().accepted);
    CHECK_FALSE(locator.answer().anyRival);
  }
  CHECK_COMPARE(rivals, >, 30);
}

TEST(Locator, ARivalIsForgottenWhenItIsRefutedThreeTimesInARow) {
  Presses presses(16, 1, 421);
  int rivals = 0, refuted = 0, twice = 0, thrice = 0, turns = 0, kept = 0;
  const auto hold = [&](double normal_n_per_m, int sets) {  // a fit of the rival for every eight
    for (int set = 0; set < sets; ++set)
      update(presses.noisy(ring.strains({4.727, normal_n_per_m, 0, 0.85}), ring.noise_strain()));
    return locator.answer().rivalIsLost;
  };
  for (int i = 0; i < 100; ++i) {
    locator.release();
    settle(presses.noisy(ring.strains({4.727, 1, 0, 0.85}), ring.noise_strain()));
    if (!locator.answer().anyRival) continue;
    ++rivals;
    const Locator before = locator;
    if (hold(14, 8) && hold(14, 8)) {
      ++refuted;
      twice += locator.answer().anyRival;
      hold(14, 8);
      thrice += locator.answer().anyRival;
    }
    locator = before;
    bool inTurn = true;
    for (int round = 0; round < 3; ++round) inTurn = inTurn && hold(14, 8) && !hold(1, 8);
    if (!inTurn) continue;
    ++turns;
    kept += locator.answer().anyRival;
  }
  CHECK_COMPARE(rivals, >, 50);
  CHECK_COMPARE(refuted, >, 20);
  LONGS_EQUAL(refuted, twice);
  LONGS_EQUAL(0, thrice);
  CHECK_COMPARE(turns, >, 10);
  LONGS_EQUAL(turns, kept);
}

TEST(Locator, OtherAnswersAreLookedForAgainOnceATouchIsFarWider) {
  Presses presses(16, 1, 423);
  const auto searchedWithin = [&](int sets, double from_mm, double to_mm) {
    int searched = 0;
    for (int set = 0; set < sets; ++set) {
      const double width_mm = widthOf_mm(std::lerp(momentOf_mm2(from_mm), momentOf_mm2(to_mm), set / 400.0));
      update(presses.noisy(ring.strains({5, 20, 0, width_mm}), ring.noise_strain()));
      searched += locator.isSearching();
    }
    return searched;
  };
  LONGS_EQUAL(0, searchedWithin(200, 1, 1));
  CHECK(searchedWithin(400, 1, 6) > 0);
  LONGS_EQUAL(0, searchedWithin(200, 6, 6));
}

TEST(Locator, AFirmTouchIsNotLookedIntoHoweverItGrows) {
  Presses presses(16, 1, 424);
  for (const double normal_n_per_m : {18, 40})
    for (int set = 0; set < 200; ++set) {
      update(presses.noisy(ring.strains({5, normal_n_per_m, 0, 1}), ring.noise_strain()));
      CHECK_FALSE(locator.isSearching());
    }
}

// What is plain as built only leaves doubt until gauges were left out, of each touch anew.
TEST(Locator, WhatAnEarlierTouchLeftOutIsNoReasonNotToLookIntoTheNext) {
  config::FingerConfig config = ModelRing::asDrawn();
  config.gauges.model_error = 0.002;
  const ModelRing good{config};
  const auto strainsOf = [&](double normal_n_per_m, double off_sigmas) {
    auto strains = good.strains({5.2, normal_n_per_m, 2, 1});
    strains[9] += off_sigmas * good.noise_strain();
    return strains;
  };
  const auto searched = [&](const std::vector<double>& strains) {
    bool any = false;
    for (int set = 0; set < 4; ++set) {
      update(good, strains, good.allGauges());
      any |= locator.isSearching();
    }
    return any;
  };
  const auto lookedInto = strainsOf(30, 6e-3 / good.noise_strain());
  int sets = 0;
  do update(good, lookedInto, good.allGauges());
  while (locator.answer().searching && ++sets < kLongestSearch);
  CHECK_COMPARE(sets, >, 20);
  locator.release();
  CHECK_FALSE(searched(strainsOf(45, 0)));
  const auto doubted = strainsOf(45, 19.25);
  CHECK_TRUE(searched(doubted));
  const Solution& answer = locator.answer().solution;
  CHECK_TRUE(isPlainAsBuilt(good.constants(), answer, good.scaled(doubted)));
  CHECK_FALSE(isPlain(good.constants(), answer, good.scaled(doubted)));
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

TEST(Locator, EachContactOfAPairHasItsOwnRival) {
  Presses presses(16, 3, 428, 3, 4);
  int rivals = 0;
  for (int i = 0; i < 100; ++i) {
    const Press one = presses.next();
    Press other = presses.next();
    other.position_pitch = one.position_pitch + 4 + i % 5;
    locator.release();
    settle(presses.noisy(ring.strains({one, other}), ring.noise_strain()));
    const Answer& answer = locator.answer();
    if (answer.solution.hypothesis.contacts < 2 || !answer.anyRival) continue;
    ++rivals;
    for (std::size_t k = 0; k < 2; ++k) {
      const Press rival = ring.pressOf(answer.rival[k], answer.shift);
      CHECK_COMPARE(off_pitch(rival, static_cast<int>(k)), <, 2);
    }
  }
  CHECK_COMPARE(rivals, >, 30);
}

TEST_GROUP(ThreePointLocator) {
  const ModelRing ring{ModelRing::ofKnownWidth(0)};
  Locator locator{FitMode::kThreePoint};
};

TEST(ThreePointLocator, SolvesThreeReadingsExactlyWithinTwiceTheBound) {
  Presses presses(16, 30, 411);
  double squares = 0, bounds = 0;
  for (int i = 0; i < 300; ++i) {
    const Press press = presses.next();
    const auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
    locateOnce(ring.tables(), ring.raw(strains), ring.allGauges(), locator);
    const Solution& solution = locator.answer().solution;
    LONGS_EQUAL(3, std::popcount(solution.hypothesis.exact));
    const double off = ring.between(press.position_pitch,
                                    ring.pressOf(solution.contact[0], locator.answer().shift).position_pitch);
    squares += off * off;
    bounds += std::pow(ring.bound(press, false)[0], 2);
  }
  CHECK(std::sqrt(squares / bounds) < 2);
}
