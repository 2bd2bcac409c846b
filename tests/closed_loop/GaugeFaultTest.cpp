// Gauges that fail: how soon the firmware names them, from the converter's codes on.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "common/fixed_real.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/pipeline.hpp"
#include "host/simulation/converter.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

enum class Kind { kNone, kDead, kOpen, kShort, kStuck };
constexpr std::array kKindNames{"healthy", "dead", "open", "short", "stuck"};

/// Naming after so many sample sets of a touch is in time.
constexpr int kInTime = 2;
constexpr int kIdle = 20;

struct Outcome {
  int trials = 0;
  int named = 0;    ///< in time
  int wrong = 0;    ///< another gauge was named
  int several = 0;  ///< taken for several contacts
};

}  // namespace

TEST_GROUP(GaugeFault) {
  const config::FingerConfig config;
  const ModelRing ring{config};
  const simulation::Converter converter{config.gauges};
  const double analogNoise = simulation::analogNoise_strain(config.gauges);

  using Set = std::array<std::uint16_t, kMaxGauges>;

  Set convert(const std::vector<double>& strains, Presses& random) {
    Set codes{};
    for (std::size_t i = 0; i < strains.size(); ++i)
      codes[i] = converter.codeOf(strains[i] + random.noise(analogNoise));
    return codes;
  }

  /// What gauge `gauge` makes of its codes; it fails before the touch.
  static void fail(Kind kind, std::size_t gauge, const Set& frozen, const Set& untouched, Set& codes) {
    if (kind == Kind::kDead) codes[gauge] = untouched[gauge];
    if (kind == Kind::kOpen) codes[gauge] = 0xFFF0;
    if (kind == Kind::kShort) codes[gauge] = 0;
    if (kind == Kind::kStuck) codes[gauge] = frozen[gauge];
  }

  /// One touch of a finger whose gauge 5 fails; what is out of use after kInTime sample sets of it. Stuck: at
  /// what it read under another touch just before.
  Observation touch(Kind kind, const Press& before, const Press& press, Presses& random) {
    Pipeline pipeline(ring.tables(), FitMode::kRefined);
    const std::vector<double> untouched(16, 0.0);
    const Set frozen = convert(ring.strains(before), random);
    const auto step = [&](const std::vector<double>& strains) {
      Set codes = convert(strains, random);
      fail(kind, 5, frozen, convert(untouched, random), codes);
      pipeline.process(Codes(codes).first(16));
    };
    if (kind != Kind::kStuck)
      for (int i = 0; i < kIdle; ++i) step(untouched);
    for (int i = 0; i < kInTime; ++i) step(ring.strains(press));
    return pipeline.observation();
  }

  Observation seen(Pipeline & pipeline, const std::vector<double>& strains, Presses& random, int sets = 1) {
    for (int i = 0; i < sets; ++i) pipeline.process(Codes(convert(strains, random)).first(16));
    return pipeline.observation();
  }

  /// Two contacts of 10 to 40 N/m so many pitches apart.
  std::vector<double> twoContacts(double apart, Presses& random, std::mt19937_64& loads) {
    std::uniform_real_distribution<double> uniform(std::log(10), std::log(40));
    Press one = random.next(), other = random.next();
    other.position_pitch = one.position_pitch + apart;
    std::vector<double> sum(16);
    for (Press* each : {&one, &other}) {
      const double load = std::exp(uniform(loads));
      each->normal *= load, each->tangential *= load;
      const auto strains = ring.strains(*each);
      for (std::size_t i = 0; i < sum.size(); ++i) sum[i] += strains[i];
    }
    return sum;
  }

  /// Touches of 1000, of 10 to 50 N/m, in four sample sets of which a gauge is blamed for their width.
  int blamedByWidth(double width_m, std::uint64_t seed) {
    config::FingerConfig wide;
    wide.contact.width_m = width_m;
    const ModelRing actual{wide};
    Presses random(16, 1, seed);
    std::mt19937_64 loads(seed);
    std::uniform_real_distribution<double> uniform(std::log(10), std::log(50));
    int blamed = 0;
    for (int trial = 0; trial < 1000; ++trial) {
      Press press = random.next();
      const double load = std::exp(uniform(loads));
      press.normal *= load, press.tangential *= load;
      Pipeline pipeline(ring.tables(), FitMode::kRefined);
      blamed += seen(pipeline, actual.strains(press), random, 4).outOfUse != 0;
    }
    std::printf("%g mm wide: a gauge blamed in %d of 1000\n", width_m * 1e3, blamed);
    return blamed;
  }

  /// Longest of 50 trials; a gauge has so many times its noise and nothing touches.
  int setsUntilNoisyIsNamed(double noisier, std::uint64_t seed) {
    Presses random(16, 1, seed);
    std::vector<int> sets;
    for (int trial = 0; trial < 50; ++trial) {
      Pipeline pipeline(ring.tables(), FitMode::kRefined);
      std::vector<double> strains(16);
      int set = 0;
      while (pipeline.observation().outOfUse == 0 && ++set < 20'000) {
        strains[5] = random.noise(noisier * config.gauges.noise_strain);
        seen(pipeline, strains, random);
      }
      LONGS_EQUAL(1u << 5, pipeline.observation().outOfUse);
      sets.push_back(set);
    }
    std::sort(sets.begin(), sets.end());
    std::printf("%g times the noise: named after %d sample sets (median), %d at most\n", noisier, sets[25],
                sets.back());
    return sets.back();
  }

  /// A contact that goes once round the ring.
  Observation rollRound(Pipeline & pipeline, Presses & random) {
    for (int i = 0; i < 4000; ++i) seen(pipeline, ring.strains({i * 16 / 4000.0, 20, 3}), random);
    return pipeline.observation();
  }

  /// A gauge's reading over what the others read together.
  static double share(double reading, const std::vector<double>& strains) {
    double others = 0;
    for (std::size_t i = 0; i < strains.size(); ++i) others += i == 5 ? 0 : strains[i] * strains[i];
    return std::abs(reading) / std::sqrt(others);
  }

  /// Touches of 10 to 50 N/m anywhere, for which the gauge's reading is off by at least `least` of what the
  /// others read together.
  Outcome run(Kind kind, double least, int count, std::uint64_t seed) {
    Presses random(16, 1, seed);
    std::mt19937_64 loads(seed);
    std::uniform_real_distribution<double> uniform(std::log(10), std::log(50));
    Outcome outcome;
    while (outcome.trials < count) {
      Press before = random.next(), press = random.next();
      for (Press* each : {&before, &press}) {
        const double load = std::exp(uniform(loads));
        each->normal *= load, each->tangential *= load;
      }
      const double held = kind == Kind::kStuck ? ring.strains(before)[5] : 0;
      const auto strains = ring.strains(press);
      if (share(strains[5] - held, strains) < least) continue;
      ++outcome.trials;
      const Observation seen = touch(kind, before, press, random);
      const GaugeSet out = seen.outOfUse;
      if (seen.several) ++outcome.several;
      if (out == 1u << 5) ++outcome.named;
      if ((out & ~(1u << 5)) != 0) ++outcome.wrong;
    }
    std::printf("%s: %d of %d named within %d samples, %d wrong, %d several\n",
                kKindNames[static_cast<std::size_t>(kind)], outcome.named, outcome.trials, kInTime,
                outcome.wrong, outcome.several);
    return outcome;
  }
};

TEST(GaugeFault, AnOpenOrShortedGaugeIsNamedAtOnce) {
  for (const Kind kind : {Kind::kOpen, Kind::kShort}) {
    const Outcome outcome = run(kind, 0, 1000, 401);
    CHECK(outcome.named >= 0.99 * outcome.trials);
    LONGS_EQUAL(0, outcome.wrong);
  }
}

// A gauge that reads nothing where it should read a third of what the others do, or still reads what an
// earlier touch left it at.
TEST(GaugeFault, ADeadGaugeIsNamedByTheFirstTouchThatItShouldFeel) {
  const Outcome outcome = run(Kind::kDead, 1.0 / 3, 1000, 402);
  CHECK(outcome.named >= 0.95 * outcome.trials);
  CHECK(outcome.wrong <= 0.002 * outcome.trials);
}

TEST(GaugeFault, AStuckGaugeIsNamedByTheFirstTouchThatItShouldFeel) {
  const Outcome outcome = run(Kind::kStuck, 1.0 / 3, 1000, 403);
  CHECK(outcome.named >= 0.95 * outcome.trials);
  CHECK(outcome.wrong <= 0.002 * outcome.trials);
}

TEST(GaugeFault, HealthyGaugesAreNeverNamed) {
  const Outcome outcome = run(Kind::kNone, 0, 10'000, 404);
  LONGS_EQUAL(0, outcome.wrong);
  LONGS_EQUAL(0, outcome.named);
  LONGS_EQUAL(0, outcome.several);
}

// Midway between two gauges a contact has a twentieth of the energy that it has over one: such a one stays
// hidden behind what the first one leaves outside its window.
TEST(GaugeFault, TwoContactsTwoPitchesApartAreNoticed) {
  Presses random(16, 1, 405);
  std::mt19937_64 loads(405);
  int several = 0, blamed = 0;
  for (int trial = 0; trial < 1000; ++trial) {
    Pipeline pipeline(ring.tables(), FitMode::kRefined);
    const Observation found = seen(pipeline, twoContacts(2 + trial * 6 / 1000.0, random, loads), random, 4);
    several += found.several;
    blamed += found.outOfUse != 0;
  }
  std::printf("two contacts: %d of 1000 noticed, a gauge blamed in %d\n", several, blamed);
  CHECK(several >= 880);
  CHECK(blamed <= 50);
}

TEST(GaugeFault, AGaugeWronglyBlamedComesBack) {
  Presses random(16, 1, 406);
  std::mt19937_64 loads(406);
  int blamed = 0;
  while (blamed < 8) {
    Pipeline pipeline(ring.tables(), FitMode::kRefined);
    if (seen(pipeline, twoContacts(1, random, loads), random, 4).outOfUse == 0) continue;
    ++blamed;
    LONGS_EQUAL(0, rollRound(pipeline, random).outOfUse);
  }
}

TEST(GaugeFault, ADeadGaugeDoesNotComeBack) {
  Presses random(16, 1, 407);
  Pipeline pipeline(ring.tables(), FitMode::kRefined);
  for (int i = 0; i < 8000; ++i) {
    auto strains = ring.strains({i * 16 / 4000.0, 20, 3});
    strains[5] = 0;
    const Observation found = seen(pipeline, strains, random);
    if (i > 4000) LONGS_EQUAL(1u << 5, found.outOfUse);
  }
}

// A gripper's: the same touch again and again, at which the gauge happens to read right.
TEST(GaugeFault, AStuckGaugeDoesNotComeBackInTouchesLikeTheOneThatItIsStuckAt) {
  Presses random(16, 1, 412);
  Pipeline pipeline(ring.tables(), FitMode::kRefined);
  const auto held = ring.strains({5.2, 20, 3}), released = std::vector<double>(16, 0.0);
  const auto stuck = [&](std::vector<double> strains) {
    strains[5] = held[5];
    return strains;
  };
  seen(pipeline, held, random, 100);
  LONGS_EQUAL(1u << 5, seen(pipeline, stuck(released), random, 100).outOfUse);
  for (int touch = 0; touch < 3; ++touch) {
    LONGS_EQUAL(1u << 5, seen(pipeline, stuck(held), random, 500).outOfUse);
    LONGS_EQUAL(1u << 5, seen(pipeline, stuck(released), random, 100).outOfUse);
  }
}
TEST(GaugeFault, ANoisyGaugeIsNamedWhileNothingTouches) {
  CHECK(setsUntilNoisyIsNamed(10, 408) <= 500);
  CHECK(setsUntilNoisyIsNamed(3, 410) <= 10'000);
}

// A contact of 2 mm is no line: what it leaves of a line's fit can look like a gauge that fails.
TEST(GaugeFault, ContactsLittleWiderThanTheTablesSayBlameNoGauge) {
  CHECK(blamedByWidth(1e-3, 411) <= 5);
  CHECK(blamedByWidth(2e-3, 411) <= 60);
  CHECK(blamedByWidth(4e-3, 411) <= 450);
}

TEST(GaugeFault, BeyondItsRangeTheFingerGoesOnWithTheOtherGauges) {
  Presses random(16, 130, 409);  // twice full scale
  int saturated = 0;
  for (int trial = 0; trial < 500; ++trial) {
    const Press press = random.next();
    Pipeline pipeline(ring.tables(), FitMode::kRefined);
    const Observation found = seen(pipeline, ring.strains(press), random, 2);
    LONGS_EQUAL(found.saturated, found.saturated & found.leftOut);
    saturated += found.saturated != 0;
    const Contact contact = estimate(ring.constants(), *found.fit);
    if (contact.uncertain) continue;
    DOUBLES_EQUAL(0, ring.arc_um(ring.between(press.position_pitch, toReal(contact.angle) * 16)), 100);  // um
    DOUBLES_EQUAL(press.normal, toReal(contact.normal), 0.01 * press.normal);
  }
  CHECK(saturated > 200);
}
