#include "firmware/core/locate.hpp"

#include <iterator>
#include <span>

#include "common/fixed_real.hpp"
#include "firmware/core/detect.hpp"
#include "firmware/core/doubt.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/near_fit.hpp"
#include "tests/firmware/core/global_search.hpp"
#include "tests/under_sanitizers.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

constexpr StrainComponent kRadial = StrainComponent::kRadial;
constexpr StrainComponent kHoop = StrainComponent::kHoop;
constexpr StrainComponent kShear = StrainComponent::kShear;
constexpr int kUncertain = 20;
constexpr double kLoad = 30;
constexpr double kMirrored_um = 10;  // what one step of a reading does where an answer is least determined

/// Rings whose strains tell where the contact is. Coarser shear rings don't: placements several hundred
/// micrometres apart give strains that differ by less than the tables' rounding.
struct RingKind {
  int gauges;
  StrainComponent component;
};
constexpr RingKind kRings[] = {{16, kRadial}, {32, kRadial}, {12, kHoop},   {20, kShear}, {12, kRadial},
                               {14, kRadial}, {20, kRadial}, {24, kRadial}, {16, kHoop},  {32, kHoop},
                               {16, kShear},  {24, kShear},  {32, kShear}};
constexpr int kSanitizedRings = 4;  // the first, of each kind: their tables alone take seconds there

}  // namespace

TEST_GROUP(Locate){
    static Fit fitOf(const ModelRing& ring, FitMode mode, const std::vector<std::int32_t>& strains){
        return locate(ring.tables(), mode, strains, gateEnergy(ring.constants(), strains));
}
static Contact contactOf(const ModelRing& ring, FitMode mode, const std::vector<std::int32_t>& strains) {
  return estimate(ring.constants(), fitOf(ring, mode, strains));
}
static double position(const ModelRing& ring, const Contact& contact) {
  return toReal(contact.angle) * ring.gauges();
}

/// Visits every kind of ring in both modes.
template <typename Visit>
static void forEachRing(Visit visit) {
  for (const RingKind& kind : std::span(kRings).first(kSanitized ? kSanitizedRings : std::size(kRings))) {
    const ModelRing ring(ModelRing::configOf(kind.gauges, kind.component));
    for (const FitMode mode : {FitMode::kRefined, FitMode::kThreePoint}) visit(ring, mode);
  }
}

static void checkFound(const ModelRing& ring, FitMode mode, const Press& press) {
  const Contact contact = contactOf(ring, mode, ring.raw(press));
  // 20 um is what three readings leave at their worst; seven leave 8.
  const double error = ring.between(press.position_pitch, position(ring, contact));
  DOUBLES_EQUAL(0, ring.arc_um(error), mode == FitMode::kRefined ? 10 : 20);
  DOUBLES_EQUAL(press.normal, toReal(contact.normal), 0.1);
  DOUBLES_EQUAL(press.tangential, toReal(contact.tangential), 0.1);
  CHECK_TRUE(contact.quality > kUncertain);
}

static std::vector<std::int32_t> noisy(const ModelRing& ring, Presses& presses, double sigma) {
  auto strains = ring.strains(presses.next());
  for (double& strain : strains) strain += presses.noise(sigma);
  return ring.raw(strains);
}

static bool isTold(const ModelRing& ring, const std::vector<std::int32_t>& strains, std::uint32_t energy) {
  const Problem problem = problemOf(ring.tables(), strains, energy);
  return isFirm(problem) && startWeights(problem, deepestOf(problem)).tell();
}
/// Its errors reach another place, and not just the other end of its own.
static bool coversAnother(const ModelRing& ring, const Fit& fit) {
  const double apart = std::ldexp(fit.alternative.position - fit.best.position, -kPitchBits);
  return fit.deficit != kNoRival && std::abs(ring.between(0, apart)) > 1.0 / 12;
}
static bool onNearest(const Fit& fit) {
  return fit.readings == FitMode::kThreePoint && fit.triple == kNearTriple;
}
static bool believesNearest(const ModelRing& ring, const std::vector<std::int32_t>& strains) {
  Fit fit;
  return locateByNearest(fit, ring.tables(), strains.data(), gateEnergy(ring.constants(), strains));
}
/// The same but for noise on all gauges beyond the next ones of `centre`.
static std::vector<std::int32_t> othersDisturbed(const ModelRing& ring, Presses& presses,
                                                 std::vector<std::int32_t> strains, int centre) {
  for (int away = 2; away <= ring.gauges() - 2; ++away)
    strains[static_cast<std::size_t>((centre + away) % ring.gauges())] +=
        static_cast<std::int32_t>(std::ldexp(presses.noise(ring.noise_strain()), 32));
  return strains;
}

/// Extreme rings: what(random, limit) fills one strain.
template <typename What>
static void checkNeverCertain(What what) {
  std::printf("seed 8 ");
  std::mt19937 random(8);
  forEachRing([&](const ModelRing& ring, FitMode mode) {
    const std::int32_t limit = (1 << (15 + ring.constants().gate_shift)) - 1;
    for (int i = 0; i < randomCases(200); ++i) {
      std::vector<std::int32_t> strains(static_cast<std::size_t>(ring.gauges()));
      what(random, limit, strains);
      CHECK_TRUE(contactOf(ring, mode, strains).quality <= kUncertain);
    }
  });
}
}
;

TEST(Locate, FindsContactsAllRoundEveryRing) {
  forEachRing([&](const ModelRing& ring, FitMode mode) {
    for (int step = 0; step < 8 * ring.gauges();
         ++step)  // over gauges, mid-sector and between; wrap included
      for (const double tangential : {-1.0, -0.5, 0.0, 0.5, 1.0}) {
        const double normal = kLoad / std::hypot(1, tangential);
        checkFound(ring, mode, {step / 8.0, normal, normal * tangential});
      }
  });
}

TEST(Locate, FindsContactsBeyondTheFrictionCoefficient) {
  // A fifth beyond: noise may push a sliding contact there.
  const ModelRing ring;
  for (int step = 0; step < 1024; ++step)
    for (const double tangential : {-1.2, 1.2})
      checkFound(ring, FitMode::kRefined, {step / 64.0, 20, 20 * tangential});
}

TEST(Locate, ErrorsOfTheDefaultFingerAreAMicrometreWithoutNoise) {
  const ModelRing ring;
  for (const FitMode mode : {FitMode::kRefined, FitMode::kThreePoint}) {
    Presses presses(16, kLoad, 11);
    double sum = 0;
    for (int i = 0; i < randomCases(20'000); ++i) {
      const Press press = presses.next();
      const Contact contact = contactOf(ring, mode, ring.raw(press));
      const double error = ring.arc_um(ring.between(press.position_pitch, position(ring, contact)));
      CHECK_TRUE(contact.quality > kUncertain);
      CHECK(std::abs(error) < 20);
      sum += error * error;
    }
    CHECK(std::sqrt(sum / randomCases(20'000)) < 1);
  }
}

TEST(Locate, ForcesFromOneToSixtyNewtonsPerMetreAreFound) {
  const ModelRing ring;
  for (const double load : {3.0, 10.0, 60.0})
    for (int step = 0; step < 256; ++step)
      for (const double tangential : {-0.7, 0.0, 0.7}) {
        const Press press{step / 16.0, load, load * tangential};
        const Contact contact = contactOf(ring, FitMode::kRefined, ring.raw(press));
        DOUBLES_EQUAL(0, ring.arc_um(ring.between(press.position_pitch, position(ring, contact))), 20);
        DOUBLES_EQUAL(load, toReal(contact.normal), 0.005 * load);
      }
}

TEST(Locate, WeakContactsAreNeverCertainInTheWrongPlace) {
  // Contacts between two gauges look a lot like others two and three gauges away, up to 5 N/m.
  const ModelRing ring;
  for (const double load : {1.0, 1.5, 2.0, 2.5, 3.0, 3.5, 4.0, 5.0}) {
    Presses presses(16, load, 19);
    for (int i = 0; i < randomCases(5000); ++i) {
      const Press press = presses.next();
      const Contact contact = contactOf(ring, FitMode::kRefined, ring.raw(press));
      const double error = ring.between(press.position_pitch, position(ring, contact));
      CHECK(std::abs(error) < 0.5 || contact.quality <= kUncertain);
    }
  }
}

TEST(Locate, ChoosesTheBranchOfAGlobalSearch) {
  // Noise of 1 % of peak, where branches are hard to tell: a certain answer is the search's own.
  for (const RingKind& kind : {RingKind{16, kRadial}, RingKind{24, kRadial}, RingKind{20, kShear}}) {
    config::FingerConfig config = ModelRing::configOf(kind.gauges, kind.component);
    config.gauges.noise_strain = 0.01 * kLoad * ModelRing(config).peakPerLoad();
    const ModelRing ring(config);
    const GlobalSearch search(ring);
    Presses presses(kind.gauges, kLoad, 12);
    int uncertain = 0;
    for (int i = 0; i < randomCases(2000); ++i) {
      auto strains = ring.strains(presses.next());
      for (double& strain : strains) strain += presses.noise(ring.noise_strain());
      const Contact contact = contactOf(ring, FitMode::kRefined, ring.raw(strains));
      const double expected = search.best(strains, 1.25).press.position_pitch;
      const bool same = std::abs(ring.between(expected, position(ring, contact))) < 0.5;
      CHECK_TRUE(same || contact.quality <= kUncertain);
      if (contact.quality <= kUncertain) ++uncertain;
    }
    std::printf("%d of %d uncertain ", uncertain, randomCases(2000));
    CHECK(uncertain < randomCases(480));  // a fifth of 16 gauges', none of the others'
  }
}

TEST(Locate, AtAThousandthOfNoiseNoContactIsInTheWrongPlace) {
  config::FingerConfig config;
  config.gauges.noise_strain = 0.001 * kLoad * ModelRing().peakPerLoad();
  const ModelRing ring(config);
  for (const FitMode mode : {FitMode::kRefined, FitMode::kThreePoint}) {
    Presses presses(16, kLoad, 13);
    for (int i = 0; i < randomCases(10'000); ++i) {
      const Press press = presses.next();
      auto strains = ring.strains(press);
      for (double& strain : strains) strain += presses.noise(ring.noise_strain());
      const double found = position(ring, contactOf(ring, mode, ring.raw(strains)));
      CHECK(std::abs(ring.between(press.position_pitch, found)) < 0.5);
    }
  }
}

TEST(Locate, TurningTheStrainsByAGaugeTurnsTheAnswer) {
  forEachRing([&](const ModelRing& ring, FitMode mode) {
    Presses presses(ring.gauges(), kLoad, 14);
    for (int i = 0; i < randomCases(50); ++i) {
      auto strains = noisy(ring, presses, ring.noise_strain());
      const Fit fit = fitOf(ring, mode, strains);
      Placement expected = fit.best;
      for (int turn = 0; turn < ring.gauges(); ++turn) {
        std::rotate(strains.begin(), strains.end() - 1, strains.end());
        expected.position = (expected.position + kOnePitch) % (ring.gauges() * kOnePitch);
        CHECK(fitOf(ring, mode, strains).best == expected);
      }
    }
  });
}

TEST(Locate, MirroredStrainsGiveTheMirroredAnswer) {
  forEachRing([&](const ModelRing& ring, FitMode mode) {
    const bool shear = ring.constants().mirror_sign < 0;
    int inexact = 0;
    Presses presses(ring.gauges(), kLoad, 15);
    for (int i = 0; i < randomCases(500); ++i) {
      auto strains = noisy(ring, presses, ring.noise_strain());
      const Fit fit = fitOf(ring, mode, strains);
      std::reverse(strains.begin() + 1, strains.end());
      for (std::int32_t& strain : strains) strain *= ring.constants().mirror_sign;
      const Fit mirrored = fitOf(ring, mode, strains);
      const std::int32_t whole = ring.gauges() * kOnePitch;
      const std::int32_t apart = (fit.best.position + mirrored.best.position) % whole;
      const double apart_um = ring.arc_um(std::ldexp(std::min(apart, whole - apart), -kPitchBits));
      if (apart_um > 0) ++inexact;
      CHECK(apart_um <= kMirrored_um);
    }
    // Differences of two readings that end in a half are rounded up, mirrored or not, and may start a fit
    // from another row; shear's mirror negates sums, too.
    CHECK(shear || inexact <= randomCases(16));
  });
}

TEST(Locate, TheAngleDoesNotDependOnTheScale) {
  const ModelRing ring;
  Presses presses(16, 3, 16);
  for (int i = 0; i < randomCases(500); ++i) {
    auto strains = noisy(ring, presses, 0);
    const std::uint32_t energy = gateEnergy(ring.constants(), strains);
    const Fit fit = locate(ring.tables(), FitMode::kRefined, strains, energy);
    for (int doubling = 1; doubling <= 4; ++doubling) {
      for (std::int32_t& strain : strains) strain *= 2;
      const Fit scaled = locate(ring.tables(), FitMode::kRefined, strains, energy << (2 * doubling));
      // Firm contacts start from the row that is told, others from a scan's: the last row may be another,
      // which rounds differently.
      const double moved = std::ldexp(scaled.best.position - fit.best.position, -kPitchBits);
      DOUBLES_EQUAL(0, ring.arc_um(moved), 3);
      LONGS_EQUAL(fit.up - doubling, scaled.up);
    }
  }
}

// What noise does to the others moves such an answer by a fraction of what it does to the three: only where
// another start leads to other rows that it is solved between.
TEST(Locate, ThreePointRestsOnTheNearestReadingsWhereTheseTellEnough) {
  const ModelRing ring;
  Presses presses(16, kLoad, 18);
  int nearest = 0, tried = 0;
  for (int i = 0; i < randomCases(4000); ++i) {
    const auto strains = noisy(ring, presses, ring.noise_strain());
    const Fit fit = fitOf(ring, FitMode::kThreePoint, strains);
    const Fit other = fitOf(ring, FitMode::kThreePoint, othersDisturbed(ring, presses, strains, fit.centre));
    nearest += onNearest(fit) ? 1 : 0;
    if (!onNearest(fit) || !onNearest(other)) continue;
    ++tried;
    const double moved = std::ldexp(other.best.position - fit.best.position, -kPitchBits);
    DOUBLES_EQUAL(0, ring.arc_um(ring.between(0, moved)), 2);
    DOUBLES_EQUAL(1, std::ldexp(other.best.normal, fit.up - other.up) / fit.best.normal, 4e-3);
  }
  std::printf("%.0f %% by the nearest ", 100.0 * nearest / randomCases(4000));
  CHECK(tried > randomCases(2000));
}

// Between rows of the tables, where noise is a small part of the errors: rounding of the tables adds a
// two-thousandth of the load, straight lines between near rows a two-hundredth and less of the tangential
// one.
TEST(Locate, LoadsOfHeavyTouchesAreRightWhereverTheyAre) {
  const ModelRing ring;
  for (const FitMode mode : {FitMode::kRefined, FitMode::kThreePoint})
    for (int step = -128; step <= 128; ++step)
      for (const double direction : {-0.9, -0.5, -0.2, 0.0, 0.4, 0.8}) {
        const Press press{8 + step / 256.0, 60, 60 * direction};
        const Contact contact = contactOf(ring, mode, ring.raw(press));
        const double rounding = 60.0 / 2000;
        DOUBLES_EQUAL(press.normal, toReal(contact.normal), rounding + 3 * toReal(contact.sigmaNormal));
        DOUBLES_EQUAL(press.tangential, toReal(contact.tangential),
                      rounding + 4 * toReal(contact.sigmaTangential));
      }
}

// A reading that the three don't rest on says no.
TEST(Locate, TheNearestReadingsAreNotBelievedAgainstTheOthers) {
  const ModelRing ring;
  Presses presses(16, kLoad, 23);
  int tried = 0;
  for (int i = 0; i < randomCases(1000); ++i) {
    auto strains = noisy(ring, presses, ring.noise_strain());
    const Fit fit = fitOf(ring, FitMode::kThreePoint, strains);
    if (!believesNearest(ring, strains)) continue;
    ++tried;
    const std::size_t beside = (fit.centre + static_cast<std::size_t>(i % 2 != 0 ? 3 : 13)) % 16;
    strains[beside] += strains[fit.centre] / 8;
    CHECK_FALSE(believesNearest(ring, strains));
  }
  CHECK(tried > randomCases(500));
}

TEST(Locate, TheNearestReadingsAreNotBelievedBeyondTheFrictionCone) {
  const ModelRing ring;
  for (double offset = -0.36; offset < 0.37; offset += 0.01)
    for (const double pull : {-1.0, 1.0}) {
      const auto strains = ring.raw(Press{5 + offset, 10, pull * 20});
      CHECK_FALSE(believesNearest(ring, strains));
    }
}

// The pairs beside the deepest reading tell where to start: no scan is made, and no rival looked for. Neither
// would have said anything else.
TEST(Locate, AToldStartLeadsWhereAScanDoes) {
  for (const int gauges : {16, 20, 24, 32}) {
    config::FingerConfig config = ModelRing::configOf(gauges);
    config.gauges.noise_strain = 0.0005 * kLoad * ModelRing(config).peakPerLoad();
    const ModelRing ring(config);
    TableImage untold = ring.tables();
    untold.start = {};
    Presses presses(gauges, kLoad, 20);
    int told = 0;
    for (int i = 0; i < randomCases(5000); ++i) {
      const auto strains = noisy(ring, presses, ring.noise_strain());
      const std::uint32_t energy = gateEnergy(ring.constants(), strains);
      told += isTold(ring, strains, energy) ? 1 : 0;
      const Fit fit = fitOf(ring, FitMode::kRefined, strains);
      const Fit scanned = locate(untold, FitMode::kRefined, strains, energy);
      const double apart = std::ldexp(fit.best.position - scanned.best.position, -kPitchBits);
      // Other rows round differently, most of all where the readings hardly tell the place.
      const double sigma_pitch = toReal(estimate(ring.constants(), scanned).sigmaAngle) * gauges;
      DOUBLES_EQUAL(0, ring.arc_um(ring.between(0, apart)), 10 + ring.arc_um(sigma_pitch) / 4);
      CHECK(fit.ambiguous == scanned.ambiguous);
      CHECK(coversAnother(ring, fit) == coversAnother(ring, scanned));
    }
    std::printf("%d gauges: %.1f %% told ", gauges, 100.0 * told / randomCases(5000));
    CHECK(told > randomCases(gauges == 16 ? 4250 : 4750));
  }
}

// A reading that is missing misleads what the pairs tell: then all is as if they told nothing.
TEST(Locate, AToldStartThatLeavesDoubtIsForgotten) {
  const ModelRing ring;
  TableImage untold = ring.tables();
  untold.start = {};
  Presses presses(16, kLoad, 22);
  int doubted = 0;
  for (int i = 0; i < randomCases(2000); ++i) {
    auto strains = noisy(ring, presses, ring.noise_strain());
    const auto deepest = static_cast<std::size_t>(deepestGauge(strains.data(), 16, 1));
    strains[(deepest + static_cast<std::size_t>(i % 3) + 15) % 16] = 0;
    const std::uint32_t energy = gateEnergy(ring.constants(), strains);
    const Fit fit = fitOf(ring, FitMode::kRefined, strains);
    if (!doubtful(problemOf(ring.tables(), strains, energy), fit.settled, fit.unexplained, fit.windowEnergy))
      continue;
    ++doubted;
    const Fit scanned = locate(untold, FitMode::kRefined, strains, energy);
    CHECK(fit.best == scanned.best && fit.alternative == scanned.alternative);
    LONGS_EQUAL(scanned.unexplained, fit.unexplained);
    LONGS_EQUAL(scanned.ambiguous, fit.ambiguous);
  }
  std::printf("%d in doubt ", doubted);
  CHECK(doubted > randomCases(1500));
}

TEST(Locate, TheSameStrainsGiveTheSameAnswer) {
  const ModelRing ring;
  Presses presses(16, kLoad, 17);
  for (int i = 0; i < randomCases(200); ++i) {
    const auto strains = noisy(ring, presses, 1e-4);
    const Fit first = fitOf(ring, FitMode::kThreePoint, strains),
              again = fitOf(ring, FitMode::kThreePoint, strains);
    CHECK(first.best == again.best && first.alternative == again.alternative);
    LONGS_EQUAL(first.unexplained, again.unexplained);
  }
}

TEST(Locate, FullScaleEverywhereIsNeverCertain) {
  checkNeverCertain([](std::mt19937& random, std::int32_t limit, std::vector<std::int32_t>& strains) {
    std::fill(strains.begin(), strains.end(), random() % 2 != 0 ? limit : -limit - 1);
  });
}

TEST(Locate, FullScaleOfRandomSignIsNeverCertain) {
  checkNeverCertain([](std::mt19937& random, std::int32_t limit, std::vector<std::int32_t>& strains) {
    for (std::int32_t& strain : strains) strain = random() % 2 != 0 ? limit : -limit - 1;
  });
}

TEST(Locate, AlternatingFullScaleIsNeverCertain) {
  checkNeverCertain([](std::mt19937&, std::int32_t limit, std::vector<std::int32_t>& strains) {
    for (std::size_t i = 0; i < strains.size(); ++i) strains[i] = i % 2 != 0 ? limit : -limit - 1;
  });
}

TEST(Locate, OneGaugeAloneIsNeverCertain) {
  checkNeverCertain([](std::mt19937& random, std::int32_t limit, std::vector<std::int32_t>& strains) {
    strains[random() % strains.size()] = random() % 2 != 0 ? limit : -limit;
  });
}

TEST(Locate, AnythingWithinRangeIsNeverCertain) {
  checkNeverCertain([](std::mt19937& random, std::int32_t limit, std::vector<std::int32_t>& strains) {
    std::uniform_int_distribution<std::int32_t> any(-limit - 1, limit);
    for (std::int32_t& strain : strains) strain = any(random);
  });
}

TEST(Locate, NoStrainAtAllIsNeverCertain) {
  // Energies that the gate would not let through: no strains are so weak that they break the arithmetic.
  const ModelRing ring;
  for (std::uint32_t energy = 0; energy < 64; ++energy)
    for (const std::int32_t strain : {0, 1, (1 << ring.constants().gate_shift) - 1}) {
      const std::vector<std::int32_t> strains(16, strain);
      const Fit fit = locate(ring.tables(), FitMode::kRefined, strains, energy);
      CHECK_TRUE(estimate(ring.constants(), fit).uncertain);
    }
}

TEST(Locate, TwoLikeContactsAGaugeOrMoreApartAreRarelyCertain) {
  // How it is, not how it should be: telling several contacts is not this fit's job, and it looks at the
  // window's readings only.
  const ModelRing ring;
  Presses presses(16, kLoad, 18);
  int certain = 0;
  for (int i = 0; i < randomCases(5000); ++i) {
    const Press one = presses.next();
    Press other = presses.next();
    other.position_pitch = one.position_pitch + 1 + std::fmod(other.position_pitch, 2.5);
    const auto a = ring.strains(one), b = ring.strains(other);
    std::vector<double> sum(16);
    std::transform(a.begin(), a.end(), b.begin(), sum.begin(), std::plus<>());
    if (contactOf(ring, FitMode::kRefined, ring.raw(sum)).quality > kUncertain) ++certain;
  }
  CHECK(certain < randomCases(100));  // 2 %
}
