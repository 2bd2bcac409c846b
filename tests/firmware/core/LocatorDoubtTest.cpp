// When a locator looks for other answers, and which gauges and contacts it believes.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <numeric>

#include "firmware/core/estimate.hpp"
#include "tests/firmware/core/located_finger.hpp"
#include "tests/under_sanitizers.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP_BASE(LocatorDoubt, LocatedFinger){};

TEST(LocatorDoubt, TwoContactsAreNeverBlamedOnAGauge) {
  Presses presses(16, 20, 406, 0, 2);
  for (int i = 0; i < 60; ++i) {
    const Press one = presses.next(), other{one.position_pitch + 1 + i % 12 * 0.5, 6 + i % 5 * 4.0, 0, 1};
    locator.release();
    settle(presses.noisy(ring.strains({one, other}), ring.noise_strain()));
    LONGS_EQUAL(0, locator.answer().suspect);
  }
}

TEST(LocatorDoubt, AWideContactIsNeverBlamedOnAGauge) {
  Presses presses(16, 20, 407, 1, 7);
  for (int i = 0; i < 100; ++i) {
    locator.release();
    settle(presses.noisy(ring.strains(presses.next()), ring.noise_strain()));
    LONGS_EQUAL(0, locator.answer().suspect);
    LONGS_EQUAL(1, locator.answer().solution.hypothesis.contacts);
  }
}

TEST(LocatorDoubt, AGaugeThatIsFarOffIsSuspectedAndLeftOut) {
  Presses presses(16, 30, 408, 0, 2);
  int found = 0, back = 0;
  for (int i = 0; i < 50; ++i) {
    const Press press = presses.next();
    const auto gauge = static_cast<std::size_t>(std::lround(press.position_pitch)) % 16;
    auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
    strains[gauge] += i % 2 == 0 ? 6e-3 : -6e-3;
    locator.release();
    settle(strains);
    if (locator.answer().suspect != GaugeSet{1} << gauge) continue;
    ++found;
    if (!locator.answer().doubtful) DOUBLES_EQUAL(0, off_pitch(press), 0.1);
    // Until an answer to all gauges is tried.
    for (int set = 0; set < 16; ++set) update(ring.strains(press));
    const bool isBack = locator.answer().solution.hypothesis.gauges == ring.allGauges();
    back += isBack;
    if (isBack) UNSIGNED_LONGS_EQUAL(0, locator.answer().suspect);
  }
  CHECK(found >= 44);
  CHECK(back >= 40);
}

// Some builds leave more than noise and the model's error do, in every set.
TEST(LocatorDoubt, OnAFingerAsBuiltWhatWasLookedIntoIsNeitherDoubtedNorLookedIntoAgain) {
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
    if (!answer.doubtful && !answer.rival.any) LONGS_EQUAL(0, hold(200));
  }
  std::printf("%d settled, %d doubted ", settled, doubted);
  CHECK_COMPARE(settled, >=, kTouches / 400);
  CHECK_COMPARE(doubted, <=, settled / 3);
}

// What it leaves behind is a pair whose second contact makes up for how the finger is built.
TEST(LocatorDoubt, AContactThatIsLiftedFromAFingerAsBuiltIsGoneWithinASecond) {
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

TEST(LocatorDoubt, OtherAnswersAreLookedForAgainOnceATouchIsTwiceAsFirm) {
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
  CHECK_FALSE(locator.answer().rival.any);
}

TEST(LocatorDoubt, AWeakTouchStaysOneWhileItGrowsByLessThanATwentieth) {
  const auto isWeakFrom = [&](double first, double then) {
    locator.release();
    for (const double load : {first, then})
      for (int set = 0; set < 200; ++set) update(ring.strains({6, load, 0}));
    return locator.answer().weak;
  };
  double least = 0.5;  // that is not weak from the start
  while (isWeakFrom(least, least)) least *= 1.005;
  CHECK_TRUE(isWeakFrom(0.9 * least, 1.02 * least));
  CHECK_FALSE(isWeakFrom(1.02 * least, 1.02 * least));
  CHECK_FALSE(isWeakFrom(0.9 * least, 1.1 * least));
}

TEST(LocatorDoubt, ASearchEndsWhileTwoContactsOfACalibratedFingerTremble) {
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

// With and without a gauge that is off by a few deviations one contact explains the readings, and of a faint
// touch two contacts do.
TEST(LocatorDoubt, OnlyAnotherPlaceOrNumberOfContactsIsDoubt) {
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
      if (magnitude(more) >= ambiguity(readings.variances)) continue;
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

// Of two contacts the fainter is read so badly that the fit of both may be beyond the friction cone.
TEST(LocatorDoubt, APairBeyondTheFrictionConeIsDoubtWhereItExplainsTheReadings) {
  Presses presses(16, 2, 420);
  Linearisation scratch;
  Search search;
  int beyond = 0, doubted = 0;
  for (int i = 0; i < (kSanitized ? 800 : 3000); ++i) {
    const Press one = presses.next();
    const Press other{one.position_pitch + 2.5, one.normal / 4, one.tangential / 4, 0};
    const auto strains = presses.noisy(ring.strains({one, other}), ring.noise_strain());
    locateOnce(ring.tables(), ring.raw(strains), ring.allGauges(), locator);
    const ScaledReadings readings = ring.scaled(strains);
    search.begin(ring.tables(), readings, {1, true, ring.allGauges()});
    while (search.isRunning()) search.advance(ring.tables(), Search::kWork, scratch);
    const Ranking &without = search.withoutOne(), &pair = search.pair();
    if (!without.anyBest || !pair.anyBest || isAdmissible(ring.constants(), pair.best) ||
        !firmware::isAccepted(ring.constants(), without.best, readings) || !isWithinGate(pair.best, readings))
      continue;
    const Number first = pair.best.contact[0].normal, second = pair.best.contact[1].normal;
    const Wide more = pair.best.residualEnergy + energyOf(readings, threshold::kSecondContact) -
                      without.best.residualEnergy - energyOf(readings, threshold::kLeftOut);
    if (8 * std::min(first, second) < std::max(first, second) || more >= ambiguity(readings.variances))
      continue;
    ++beyond;
    doubted += locator.answer().doubtful;
  }
  std::printf("%d of %d ", doubted, beyond);
  CHECK_COMPARE(beyond, >, kSanitized ? 0 : 5);
  LONGS_EQUAL(beyond, doubted);
}

TEST(LocatorDoubt, OfAFaintTouchNoOtherGaugeIsSuspected) {
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

TEST(LocatorDoubt, AGaugeThatIsALittleOffIsLeftOutButNotSuspected) {
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

TEST(LocatorDoubt, OtherAnswersAreLookedForAgainOnceATouchIsFarWider) {
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

TEST(LocatorDoubt, AFirmTouchIsNotLookedIntoHoweverItGrows) {
  Presses presses(16, 1, 424);
  for (const double normal_n_per_m : {18, 40})
    for (int set = 0; set < 200; ++set) {
      update(presses.noisy(ring.strains({5, normal_n_per_m, 0, 1}), ring.noise_strain()));
      CHECK_FALSE(locator.isSearching());
    }
}

// What is plain as built only leaves doubt until gauges were left out, of each touch anew.
TEST(LocatorDoubt, WhatAnEarlierTouchLeftOutIsNoReasonNotToLookIntoTheNext) {
  config::FingerConfig config = ModelRing::asDrawn();
  config.gauges.model_error = 0.003;
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
  int plainAsBuiltOnly = 0;
  for (double off_sigmas = 20; off_sigmas < 22; off_sigmas += 0.1) {
    int sets = 0;
    do update(good, lookedInto, good.allGauges());
    while (locator.answer().searching && ++sets < kLongestSearch);
    CHECK_COMPARE(sets, >, 20);
    locator.release();
    CHECK_FALSE(searched(strainsOf(45, 0)));
    const auto doubted = strainsOf(45, off_sigmas);
    const bool wasSearched = searched(doubted);
    const Solution answer = locator.answer().solution;
    const ScaledReadings readings = good.scaled(doubted);
    locator.release();
    if (isPlain(good.constants(), answer, readings) || !isPlainAsBuilt(good.constants(), answer, readings))
      continue;
    ++plainAsBuiltOnly;
    CHECK_TRUE(wasSearched);
  }
  CHECK_COMPARE(plainAsBuiltOnly, >, 0);
}
