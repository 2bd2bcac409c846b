#include <cmath>

#include "firmware/core/search.hpp"

#include "tests/firmware/core/exact_fit.hpp"
#include "tests/under_sanitizers.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(Search) {
  const ModelRing ring{ModelRing::asDrawn()};
  Search search;
  Linearisation scratch;
  int advances = 0;

  void searchOn(const ModelRing& of, const std::vector<double>& strains) {
    const bool isWidthFree = of.constants().width_is_known == 0;
    search.begin(of.tables(), of.scaled(strains), {1, isWidthFree, of.allGauges()});
    for (advances = 0; search.isRunning(); ++advances) search.advance(of.tables(), Search::kWork, scratch);
  }
  Press found(const ModelRing& of, const Solution& solution, int contact = 0) const {
    return of.pressOf(solution.contact[static_cast<std::size_t>(contact)], search.readings().shift);
  }
  /// How many of these touches the search puts elsewhere than the most likely contact is, by so much of
  /// chi-squared that rounding and the tables' errors don't explain it.
  int missed(const ModelRing& of, double load, double leastWidth_mm, double mostWidth_mm, int touches) {
    const ExactSearch everywhere(of);
    Presses presses(of.gauges(), load, 301, leastWidth_mm, mostWidth_mm);
    int missed = 0;
    for (int i = 0; i < randomCases(touches); ++i) {
      const auto strains = presses.noisy(of.strains(presses.next()), of.noise_strain());
      searchOn(of, strains);
      const double best = everywhere.best(strains).chiSquared;
      const Press answer = found(of, search.single().best);
      if (!search.single().anyBest || ExactFit(of, strains).chiSquared(answer) > 1.1 * best + 2) ++missed;
    }
    return missed;
  }
  /// Is one of the solution's contacts there?
  bool isAt(const ModelRing& of, const Solution& solution, const Press& press, double within_pitch) const {
    for (int k = 0; k < solution.hypothesis.contacts; ++k)
      if (std::abs(of.between(found(of, solution, k).position_pitch, press.position_pitch)) < within_pitch)
        return true;
    return false;
  }
  bool isAt(const Solution& solution, const Press& press, double within_pitch) const {
    return isAt(ring, solution, press, within_pitch);
  }
};

TEST(Search, FindsTheMostLikelyContactWhateverItsWidth) {
  LONGS_EQUAL(0, missed(ring, 20, 0, 3, 40));
  CHECK(missed(ring, 20, 3, 6, 40) <= 1);
}

TEST(Search, FindsTheMostLikelyContactHoweverFaint) {
  CHECK(missed(ring, 2, 0, 6, 40) <= 2);
  CHECK(missed(ring, 5, 0, 6, 40) <= 2);
}

TEST(Search, FindsTheMostLikelyContactHoweverFirm) { CHECK(missed(ring, 60, 0, 3, 40) <= 1); }

TEST(Search, FindsContactsOfAKnownWidth) {
  for (const double width_mm : {0.0, 2.0}) {
    const ModelRing known(ModelRing::ofKnownWidth(width_mm));
    LONGS_EQUAL(0, missed(known, 5, width_mm, width_mm, 30));
    LONGS_EQUAL(0, missed(known, 30, width_mm, width_mm, 30));
  }
}

// What the others read most then lies on one side of them only, up to three pitches away.
TEST(Search, FindsContactsBesideAGaugeThatDoesNotCount) {
  const ModelRing lines(ModelRing::ofKnownWidth(0));
  const auto missedOn = [this](const ModelRing& of) {
    constexpr int kOut = 5;
    const Hypothesis without = oneContact(of.constants(), of.allGauges() & ~(GaugeSet{1} << kOut));
    int missed = 0;
    for (double beyond_pitch = -2; beyond_pitch <= 2; beyond_pitch += 0.05)
      for (double tangential = -20; tangential <= 20; tangential += 2) {
        const Press press{kOut + beyond_pitch, 27, tangential, 0};
        search.begin(of.tables(), of.scaled(of.strains(press)), without);
        while (search.isRunning()) search.advance(of.tables(), Search::kWork, scratch);
        missed += !isAt(of, search.single().best, press, 0.1);
      }
    return missed;
  };
  LONGS_EQUAL(0, missedOn(lines));
  CHECK(missedOn(ring) <= 1);  // of 1,701
}

TEST(Search, FindsContactsOnOtherRings) {
  const ModelRing fine(ModelRing::asDrawn(24)), shear(ModelRing::asDrawn(16, StrainComponent::kShear));
  CHECK(missed(fine, 20, 0, 4, 20) <= 1);
  CHECK(missed(shear, 20, 0, 3, 20) <= 1);
}

TEST(Search, ATouchThatOneContactExplainsIsNotLookedIntoFurther) {
  Presses presses(16, 20, 302, 0, 2);
  for (int i = 0; i < 20; ++i) {
    searchOn(ring, presses.noisy(ring.strains(presses.next()), ring.noise_strain()));
    CHECK_TRUE(search.single().anyBest);
    CHECK_FALSE(search.withoutOne().anyBest);
    CHECK_FALSE(search.pair().anyBest);
  }
}

// Some builds leave more than noise and the model's error do.
TEST(Search, OnAFingerAsBuiltASecondContactIsLookedForUnlessOneIsPlainAsBuilt) {
  const ModelRing built;
  Presses presses(16, 20, 308, 0, 2);
  int settled = 0, unsettled = 0;
  for (int i = 0; i < 3000; ++i) {
    searchOn(built, built.strainsAsBuilt(presses.next(), presses));
    const Solution& one = search.single().best;
    if (isPlain(built.constants(), one, search.readings())) continue;
    const bool isSettled = isPlainAsBuilt(built.constants(), one, search.readings());
    ++(isSettled ? settled : unsettled);
    CHECK_EQUAL(!isSettled, search.pair().anyBest);
  }
  std::printf("%d settled, %d unsettled ", settled, unsettled);
  CHECK(settled > 10);
  CHECK(unsettled > 10);
}

TEST(Search, TellsTheSecondBestAnswerThatLiesElsewhere) {
  // Between two gauges a wide contact has a rival that is hardly less likely.
  Presses presses(16, 3, 303, 4, 6);
  int seconds = 0, elsewhere = 0;
  for (int i = 0; i < 30; ++i) {
    searchOn(ring, presses.noisy(ring.strains(presses.next()), ring.noise_strain()));
    const Ranking& single = search.single();
    if (!single.anySecond) continue;
    ++seconds;
    CHECK(likelihoodEnergy(ring.constants(), single.best, search.readings()) <=
          likelihoodEnergy(ring.constants(), single.second, search.readings()));
    elsewhere += areElsewhere(ring.constants(), 1, single.best.contact, single.second.contact);
  }
  CHECK(seconds > 10);
  CHECK_COMPARE(elsewhere, >, 3);
}

// Most candidates lead to a wide contact a pitch away, in whose valley many of them stop at once.
TEST(Search, FindsTheSecondAnswerThoughMostCandidatesLeadToTheFirst) {
  const Press press{4.727, 1, 0, 0.85};
  Presses presses(16, 1, 307);
  int rivals = 0, missed = 0;
  for (int i = 0; i < 400; ++i) {
    const auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
    searchOn(ring, strains);
    const Ranking& single = search.single();
    if (isAt(single.best, press, 0.5)) continue;
    const ExactFit exact(ring, strains);
    const double more = exact.from({press}).chiSquared - exact.chiSquared(found(ring, single.best));
    if (more > threshold::kAmbiguous - 1) continue;
    ++rivals;
    missed += !single.anySecond || !isAt(single.second, press, 0.5);
  }
  CHECK_COMPARE(rivals, >, 50);
  CHECK_COMPARE(missed, <=, 1);
}

TEST(Search, FindsTheGaugeWithoutWhichOneContactExplainsAll) {
  for (int gauge = 0; gauge < 16; gauge += 3) {
    auto strains = ring.strains({gauge + 1.3, 20, 5, 1});
    strains[static_cast<std::size_t>(gauge)] += 4e-3;
    searchOn(ring, strains);
    const Ranking& without = search.withoutOne();
    CHECK_TRUE(without.anyBest && isAccepted(ring.constants(), without.best, search.readings()));
    UNSIGNED_LONGS_EQUAL(GaugeSet{1} << gauge, ring.allGauges() & ~without.best.hypothesis.gauges);
    CHECK_TRUE(isAt(without.best, {gauge + 1.3, 20, 5, 1}, 0.05));
  }
}

TEST(Search, FindsTwoContacts) {
  Presses presses(16, 30, 304, 0, 1);
  int wrong = 0;
  for (int i = 0; i < 20; ++i) {
    const Press one = presses.next(), other{one.position_pitch + 4 + i % 5, 10.0 + i, i % 3 * 3.0, 1};
    searchOn(ring, presses.noisy(ring.strains({one, other}), ring.noise_strain()));
    const Ranking& pair = search.pair();
    if (!pair.anyBest || !isAt(pair.best, one, 0.1) || !isAt(pair.best, other, 0.1)) ++wrong;
  }
  CHECK(wrong <= 1);
}

// Half-way between gauges, of quite different loads that pull towards each other: what the ring reads most
// lies between them.
TEST(Search, FindsTwoContactsThatPullTowardsEachOther) {
  Presses presses(16, 30, 309);
  int wrong = 0, wrongAndAccepted = 0;
  for (double place_pitch = 3.4; place_pitch <= 3.65; place_pitch += 0.05)
    for (double normal = 6; normal <= 14; normal += 2)
      for (double width_mm = 0; width_mm <= 3; width_mm += 0.5) {
        const Press one{place_pitch, 27, 14, width_mm}, other{place_pitch + 4, normal, -0.9 * normal, 1};
        searchOn(ring, presses.noisy(ring.strains({one, other}), ring.noise_strain()));
        const Ranking& pair = search.pair();
        if (pair.anyBest && isAt(pair.best, one, 0.5) && isAt(pair.best, other, 0.5)) continue;
        ++wrong;
        wrongAndAccepted += pair.anyBest && isAccepted(ring.constants(), pair.best, search.readings());
      }
  CHECK_COMPARE(wrong, <=, 4);  // of 210
  LONGS_EQUAL(0, wrongAndAccepted);
}

TEST(Search, TakesItsTimeInParts) {
  searchOn(ring, ring.strains({{2.2, 20, 0, 1}, {9.7, 20, 0, 1}}));
  const int ofSixteen = advances;
  const ModelRing large(ModelRing::asDrawn(32));
  searchOn(large, large.strains({{4.4, 20, 0, 1}, {19.4, 20, 0, 1}}));
  std::printf("in %d parts, with 32 gauges in %d ", ofSixteen, advances);
  CHECK(ofSixteen > 5 && ofSixteen < 170);
  CHECK(advances > ofSixteen && advances < 320);
}

TEST(Search, CanBeStopped) {
  search.begin(ring.tables(), ring.scaled(ring.strains({3, 20, 0})), {1, true, ring.allGauges()});
  CHECK_TRUE(search.isRunning());
  search.stop();
  CHECK_FALSE(search.isRunning());
}

TEST(Search, OfReadingsOfNothingAnyAnswerWillDo) {
  searchOn(ring, std::vector<double>(16, 0.0));
  CHECK_FALSE(search.isRunning());
}

TEST_GROUP(Ranking) {
  TableConstants constants{};
  ScaledReadings readings;
  Ranking ranking;

  void setup() override {
    constants.gauge_count = 16;
    constants.cone_q8 = 256;
    readings.variances = {16, 16, 16};
  }
  void take(int degrees, Wide energy, Number tangential = 0, Number moment_q20 = 0, GaugeSet leftOut = 0) {
    Solution solution{{1, true, allGauges(16) & ~leftOut}, {}};
    solution.contact[0] = {static_cast<std::uint32_t>(degrees) * 11'930'465u, 1000, tangential, moment_q20};
    solution.residualEnergy = energy;
    ranking.take(constants, solution, readings);
  }
  static int degreesOf(const Solution& solution) {
    return static_cast<int>((solution.contact[0].angle_q32 + 5'000'000u) / 11'930'465u);
  }
};

TEST(Ranking, KeepsTheTwoMostLikely) {
  CHECK_FALSE(ranking.anyBest);
  take(10, 500);
  CHECK_TRUE(ranking.anyBest);
  CHECK_FALSE(ranking.anySecond);
  take(50, 100);
  take(90, 300);
  take(130, 900);
  LONGS_EQUAL(50, degreesOf(ranking.best));
  LONGS_EQUAL(90, degreesOf(ranking.second));
}

TEST(Ranking, TheSameAnswerIsNoSecond) {
  take(10, 500);
  take(11, 600);
  CHECK_FALSE(ranking.anySecond);
  take(11, 400);
  CHECK_FALSE(ranking.anySecond);
  LONGS_EQUAL(400, ranking.best.residualEnergy);
}

TEST(Ranking, AnAnswerElsewhereIsASecondBeforeAnotherWidthOfTheSamePlace) {
  take(10, 100);
  take(12, 105, 0, 300'000);
  LONGS_EQUAL(12, degreesOf(ranking.second));
  take(50, 110);
  LONGS_EQUAL(50, degreesOf(ranking.second));
  take(11, 103, 0, 500'000);
  LONGS_EQUAL(50, degreesOf(ranking.second));
}

TEST(Ranking, AnAnswerElsewhereThatIsFarLessLikelyGivesWayToAnotherWidth) {
  take(10, 100);
  take(50, 100 + threshold::kAmbiguous);
  LONGS_EQUAL(50, degreesOf(ranking.second));
  take(12, 105, 0, 300'000);
  LONGS_EQUAL(12, degreesOf(ranking.second));
  take(90, 100 + threshold::kAmbiguous);
  LONGS_EQUAL(12, degreesOf(ranking.second));
}

TEST(Ranking, WhereABetterAnswerIsAnotherWidthOfTheBestTheRivalElsewhereStays) {
  take(10, 100);
  take(50, 104);
  take(12, 95, 0, 300'000);
  LONGS_EQUAL(12, degreesOf(ranking.best));
  LONGS_EQUAL(50, degreesOf(ranking.second));
}

TEST(Ranking, ASecondThatIsTheSameAsABetterAnswerIsNone) {
  take(10, 100);
  take(12, 105);
  LONGS_EQUAL(12, degreesOf(ranking.second));
  take(11, 90);
  CHECK_FALSE(ranking.anySecond);
}

// Which gauge is at fault is asked of all gauges near by, wherever the contact is without them.
TEST(Ranking, OfOtherHypothesesTheNextBestIsTheSecond) {
  take(10, 100, 0, 0, 1u << 3);
  take(10, 105, 0, 0, 1u << 4);
  take(50, 113, 0, 0, 1u << 5);
  LONGS_EQUAL(105, ranking.second.residualEnergy);
}

TEST(Ranking, AnswersBeyondTheFrictionConeAreLessLikely) {
  take(10, 100, 2000);
  take(50, 120);
  LONGS_EQUAL(50, degreesOf(ranking.best));
  take(90, 95, 2000);
  LONGS_EQUAL(50, degreesOf(ranking.best));
}

TEST(Ranking, AnswersThatCannotBeAreNotTaken) {
  take(10, 0, 1'000'000);
  CHECK_FALSE(ranking.anyBest);
}
