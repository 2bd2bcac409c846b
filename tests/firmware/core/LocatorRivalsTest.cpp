// The second answer that a locator follows beside its own.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdio>
#include <optional>

#include "firmware/core/estimate.hpp"
#include "tests/firmware/core/located_finger.hpp"
#include "tests/under_sanitizers.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP_BASE(LocatorRivals, LocatedFinger){};

// Places a tenth of a pitch apart in two sets of one touch that nothing moves, both told without a flag.
TEST(LocatorRivals, ATouchThatIsHeldOnAFingerAsBuiltSeldomJumps) {
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

TEST(LocatorRivals, ARivalThatIsNearlyAsLikelyIsTold) {
  Presses presses(16, 3, 409, 5, 6);
  int rivals = 0;
  for (int i = 0; i < 50; ++i) {
    locator.release();
    settle(presses.noisy(ring.strains(presses.next()), ring.noise_strain()));
    if (!locator.answer().rival.any) continue;
    ++rivals;
    CHECK(locator.answer().rival.contact[0].angle_q32 != locator.answer().solution.contact[0].angle_q32);
  }
  CHECK(rivals > 10);
}

// Without a model error noise is all that may mix answers up; with one of 5 % a firm touch's noise mixes up
// hardly any, while the model's error may.
TEST(LocatorRivals, WhetherNoiseAloneMayHaveToldTheWrongOneIsToldBeside) {
  Presses presses(16, 3, 434, 5, 6);
  for (int i = 0; i < 50; ++i) {
    locator.release();
    settle(presses.noisy(ring.strains(presses.next()), ring.noise_strain()));
    CHECK_EQUAL(locator.answer().rival.isAsLikely, locator.answer().rival.isWithinNoise);
  }
  const ModelRing unsure{config::FingerConfig{}};
  Presses firm(16, 30, 435, 0, 3);
  int asLikely = 0, withinNoise = 0;
  for (int i = 0; i < 700; ++i) {
    locator.release();
    const auto strains = firm.noisy(unsure.strains(firm.next()), unsure.noise_strain());
    for (int set = 0; set < 200; ++set) update(unsure, strains, unsure.allGauges());
    asLikely += locator.answer().rival.isAsLikely;
    withinNoise += locator.answer().rival.isWithinNoise;
  }
  CHECK_COMPARE(asLikely, >, 10);
  CHECK_COMPARE(withinNoise, <, asLikely / 2);
}

// With a model error one contact and its rival are compared in a fading mean, so that noise does not take the
// flag back and forth; pairs, and fingers without one, by single sets.
TEST(LocatorRivals, AModelErrorHasOneContactAndItsRivalComparedInAMeanOfSets) {
  const ModelRing unsure{config::FingerConfig{}};
  const auto mostCompared = [&](const ModelRing& finger, bool isPair) {
    Presses presses(16, isPair ? 15 : 3, 436, 1, 3);
    int most = 0;
    for (int i = 0; i < 20; ++i) {
      locator.release();
      const Press press = presses.next(), second{press.position_pitch + 3, 15, 0, 2};
      const auto strains = isPair ? finger.strains({press, second}) : finger.strains(press);
      for (int set = 0; set < 400; ++set) {
        update(finger, presses.noisy(strains, finger.noise_strain()), finger.allGauges());
        const Answer& answer = locator.answer();
        if (answer.rival.any && (answer.solution.hypothesis.contacts == 2) == isPair)
          most = std::max(most, int{answer.rival.setsCompared});
      }
    }
    return most;
  };
  LONGS_EQUAL(4, mostCompared(unsure, false));
  LONGS_EQUAL(1, mostCompared(ring, false));
  LONGS_EQUAL(1, mostCompared(unsure, true));
}

// Energies are those of readings of one scale.
TEST(LocatorRivals, AtAnotherScaleOfReadingsTheComparisonBeginsAnew) {
  const ModelRing unsure{config::FingerConfig{}};
  Presses presses(16, 4, 437, 1, 3);
  int begun = 0;
  for (int i = 0; i < 200; ++i) {
    locator.release();
    const auto strains = unsure.strains(presses.next());
    for (int set = 0; set < 100; ++set)
      update(unsure, presses.noisy(strains, unsure.noise_strain()), unsure.allGauges());
    for (double times = 1.01; times < 2.2 && locator.answer().rival.any; times *= 1.01) {
      const Answer before = locator.answer();
      auto more = strains;
      for (double& strain : more) strain *= times;
      update(unsure, presses.noisy(more, unsure.noise_strain()), unsure.allGauges());
      if (locator.answer().shift == before.shift || !locator.answer().rival.any) continue;
      begun += before.rival.setsCompared > 1;
      CHECK_COMPARE(int{locator.answer().rival.setsCompared}, <=, 1);
    }
  }
  CHECK_COMPARE(begun, >, 5);
}

// A rival that such a set refutes is compared in it as if it left four times what would be ambiguous.
TEST(LocatorRivals, OneSetThatIsFarOffDoesNotDecideTheMean) {
  const ModelRing unsure{config::FingerConfig{}};
  Presses presses(16, 4, 438, 0, 3);
  int rivals = 0, limited = 0;
  for (int i = 0; i < 1500; ++i) {
    locator.release();
    const auto strains = unsure.strainsAsBuilt(presses.next(), presses);
    const auto press = [&](double times) {
      auto pressed = strains;
      for (double& strain : pressed) strain *= times;
      update(unsure, presses.noisy(pressed, unsure.noise_strain()), unsure.allGauges());
    };
    for (int set = 0; set < 150; ++set) press(1);
    const Wide compared = locator.answer().rival.more;
    for (int set = 0; set < 8 && locator.answer().rival.more == compared; ++set) press(1);
    for (int set = 0; set < 7; ++set) press(1);
    const Answer before = locator.answer();
    if (!before.rival.any || before.rival.setsCompared < 4) continue;
    press(2);
    const Answer& after = locator.answer();
    if (!after.rival.any || after.rival.setsCompared < 4) continue;
    ++rivals;
    const Wide most = threshold::kRefuted * ambiguity(after.variances);
    CHECK(after.rival.more <= before.rival.more + (most - before.rival.more) / 4);
    limited += after.rival.more == before.rival.more + (most - before.rival.more) / 4;
  }
  std::printf("%d of %d limited ", limited, rivals);
  CHECK_COMPARE(limited, >, 2);
}

TEST(LocatorRivals, ARivalIsForgottenOnceTheTouchHasTold) {
  Presses presses(16, 3, 412, 5, 6);
  int rivals = 0, left = 0;
  for (int i = 0; i < 50; ++i) {
    locator.release();
    Press press = presses.next();
    settle(presses.noisy(ring.strains(press), ring.noise_strain()));
    if (!locator.answer().rival.any) continue;
    ++rivals;
    for (int set = 0; set < 100; ++set, press.normal *= 1.03, press.tangential *= 1.03)
      update(presses.noisy(ring.strains(press), ring.noise_strain()));
    left += locator.answer().rival.any;
    DOUBLES_EQUAL(0, off_pitch(press), 0.02);
  }
  CHECK(rivals > 10);
  CHECK_COMPARE(left, <=, rivals / 5);
}

// Touches of which one set alone often doesn't tell which of two places is right, for half a second each.
TEST(LocatorRivals, AFaintTouchThatIsHeldIsSeldomToldElsewhereUnflagged) {
  constexpr int kTouches = kSanitized ? 4 : 300, kSets = 500;
  Presses presses(16, 1.5, 415, 0, 2);
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

TEST(LocatorRivals, ARivalKeepsItsLoadWhenTheReadingsScaleChanges) {
  Presses presses(16, 5, 413, 2, 6);
  int rescaled = 0;
  for (int i = 0; i < 400; ++i) {
    locator.release();
    const auto strains = ring.strains(presses.next());
    settle(presses.noisy(strains, ring.noise_strain()));
    const auto rivalsLoad = [&] {
      return std::ldexp(locator.answer().rival.contact[0].normal, locator.answer().shift);
    };
    for (double times = 1.01; times < 2.2 && locator.answer().rival.any; times *= 1.01) {
      const double before = rivalsLoad();
      const int shift = locator.answer().shift;
      auto more = strains;
      for (double& strain : more) strain *= times;
      update(presses.noisy(more, ring.noise_strain()));
      if (locator.answer().shift == shift || !locator.answer().rival.any) continue;
      ++rescaled;
      DOUBLES_EQUAL(1, rivalsLoad() / before, 0.2);  // it may have been fitted to the new readings
    }
  }
  CHECK(rescaled > 10);
}

// The residual of a set jitters, and with it what would be told apart.
TEST(LocatorRivals, WhetherARivalIsAsLikelyIsJudgedWhenItIsFitted) {
  const ModelRing built{config::FingerConfig{}};
  Presses presses(16, 5, 417, 2, 6);
  int rivals = 0, cleared = 0, changes = 0;
  for (int i = 0; i < 50; ++i) {
    locator.release();
    const auto strains = built.strains(presses.next());
    for (int set = 0; set < 160; ++set) {
      const bool wasSearching = locator.isSearching(), was = locator.answer().rival.isAsLikely;
      update(built, presses.noisy(strains, built.noise_strain()), built.allGauges());
      const Answer& answer = locator.answer();
      if (wasSearching || locator.isSearching() || !answer.rival.any) continue;
      ++rivals;
      changes += answer.rival.isAsLikely != was;
      cleared += was && !answer.rival.isAsLikely;
    }
  }
  std::printf("%d changes, %d to less likely, in %d sets ", changes, cleared, rivals);
  CHECK_COMPARE(rivals, >, 1000);
  CHECK_COMPARE(cleared, >, 0);
  CHECK_COMPARE(changes, <=, rivals / 8);
}

TEST(LocatorRivals, ARivalMovesAlongBetweenItsFits) {
  Presses presses(16, 3, 420, 5, 6);
  int rivals = 0, moved = 0;
  const auto apart_q32 = [&] {
    return locator.answer().rival.contact[0].angle_q32 - locator.answer().solution.contact[0].angle_q32;
  };
  for (int i = 0; i < 50; ++i) {
    locator.release();
    Press press = presses.next();
    settle(ring.strains(press));
    if (!locator.answer().rival.any) continue;
    ++rivals;
    const std::uint32_t before_q32 = apart_q32();
    press.position_pitch += 0.02;
    update(ring.strains(press));
    moved += apart_q32() == before_q32;
  }
  CHECK_COMPARE(rivals, >, 10);
  CHECK_COMPARE(moved, >, rivals / 2);  // the others' rivals were fitted to this set
}

TEST(LocatorRivals, AFirmTouchForgetsItsRivalAtOnce) {
  Presses presses(16, 1, 422);
  int rivals = 0;
  for (int i = 0; i < 100; ++i) {
    const auto hold = [&](double normal_n_per_m) {
      return presses.noisy(ring.strains({4.727, normal_n_per_m, 0, 0.85}), ring.noise_strain());
    };
    locator.release();
    settle(hold(1));
    if (!locator.answer().rival.any || off_pitch({4.727, 1, 0}) > 0.3) continue;
    ++rivals;
    for (int set = 0; set < 8; ++set) update(hold(40));
    CHECK_TRUE(locator.answer().accepted);
    CHECK_FALSE(locator.answer().rival.any);
  }
  CHECK_COMPARE(rivals, >, 30);
}

TEST(LocatorRivals, ARivalIsForgottenWhenItIsRefutedThreeTimesInARow) {
  Presses presses(16, 1, 421);
  int rivals = 0, refuted = 0, twice = 0, thrice = 0, turns = 0, kept = 0;
  const auto hold = [&](double normal_n_per_m, int sets) {  // a fit of the rival for every eight
    for (int set = 0; set < sets; ++set)
      update(presses.noisy(ring.strains({4.727, normal_n_per_m, 0, 0.85}), ring.noise_strain()));
    return locator.answer().rival.isLost;
  };
  for (int i = 0; i < 100; ++i) {
    locator.release();
    settle(presses.noisy(ring.strains({4.727, 1, 0, 0.85}), ring.noise_strain()));
    if (!locator.answer().rival.any) continue;
    ++rivals;
    const Locator before = locator;
    if (hold(14, 8) && hold(14, 8)) {
      ++refuted;
      twice += locator.answer().rival.any;
      hold(14, 8);
      thrice += locator.answer().rival.any;
    }
    locator = before;
    bool inTurn = true;
    for (int round = 0; round < 3; ++round) inTurn = inTurn && hold(14, 8) && !hold(1, 8);
    if (!inTurn) continue;
    ++turns;
    kept += locator.answer().rival.any;
  }
  CHECK_COMPARE(rivals, >, 50);
  CHECK_COMPARE(refuted, >, 20);
  LONGS_EQUAL(refuted, twice);
  LONGS_EQUAL(0, thrice);
  CHECK_COMPARE(turns, >, 10);
  LONGS_EQUAL(turns, kept);
}

TEST(LocatorRivals, EachContactOfAPairHasItsOwnRival) {
  Presses presses(16, 3, 428, 3, 4);
  int rivals = 0;
  for (int i = 0; i < 100; ++i) {
    const Press one = presses.next();
    Press other = presses.next();
    other.position_pitch = one.position_pitch + 4 + i % 5;
    locator.release();
    settle(presses.noisy(ring.strains({one, other}), ring.noise_strain()));
    const Answer& answer = locator.answer();
    if (answer.solution.hypothesis.contacts < 2 || !answer.rival.any) continue;
    ++rivals;
    for (std::size_t k = 0; k < 2; ++k) {
      const Press rival = ring.pressOf(answer.rival.contact[k], answer.shift);
      CHECK_COMPARE(off_pitch(rival, static_cast<int>(k)), <, 2);
    }
  }
  CHECK_COMPARE(rivals, >, 30);
}
