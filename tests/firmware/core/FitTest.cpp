#include <algorithm>
#include <cmath>

#include "firmware/core/fit.hpp"

#include "tests/firmware/core/exact_fit.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(Fit) {
  static constexpr int kMostSteps = 14;
  const ModelRing ring{ModelRing::asDrawn()};
  Hypothesis hypothesis{1, true, allGauges(16)};
  Linearisation linearisation;

  Solution fitted(const ModelRing& of, const std::vector<double>& strains, const std::vector<Press>& start,
                  int steps = kMostSteps) {
    const ScaledReadings readings = scaledReadings(of.constants(), of.raw(strains), hypothesis.gauges);
    ContactStates contacts{};
    for (std::size_t k = 0; k < start.size(); ++k) contacts[k] = of.stateOf(start[k], readings.shift);
    return fit(of.tables(), hypothesis, contacts, readings, steps, linearisation);
  }
  Press pressOf(const ModelRing& of, const Solution& solution, const std::vector<double>& strains,
                int k = 0) {
    const auto shift = scaledReadings(of.constants(), of.raw(strains), hypothesis.gauges).shift;
    return of.pressOf(solution.contact[static_cast<std::size_t>(k)], shift);
  }
  static Press beside(Press press, double pitches, double wider_mm) {
    press.position_pitch += pitches;
    press.width_mm = std::max(press.width_mm + wider_mm, 0.0);
    return press;
  }
  double reach_pitch() const { return std::ldexp(ring.constants().reach_q32, -32) * ring.gauges(); }
  double energyOutOfReach(const Press& press, const ScaledReadings& readings) const {
    double energy = 0;
    for (int gauge = 0; gauge < ring.gauges(); ++gauge)
      if (std::abs(ring.between(press.position_pitch, gauge)) > reach_pitch())
        energy += std::pow(readings.value[static_cast<std::size_t>(gauge)], 2);
    return energy;
  }
  /// Largest difference of a place, a load or a second moment, over its Cramer-Rao bound.
  static double sigmasBetween(const ModelRing& of, const Press& a, const Press& b,
                              const Eigen::Vector4d& bound) {
    const Eigen::Vector4d apart{of.between(a.position_pitch, b.position_pitch), b.normal - a.normal,
                                b.tangential - a.tangential,
                                momentOf_mm2(b.width_mm) - momentOf_mm2(a.width_mm)};
    double most = 0;
    for (Eigen::Index i = 0; i < 4; ++i)
      if (bound[i] > 0) most = std::max(most, std::abs(apart[i]) / bound[i]);
    return most;
  }
  /// Noisy touches: the fit ends where the exact one does, from the same start.
  void checkAgainstExactFit(double load, double leastWidth_mm, double mostWidth_mm, double rms_sigma) {
    constexpr int kTouches = 100;
    Presses presses(16, load, 201, leastWidth_mm, mostWidth_mm);
    double squares = 0;
    for (int i = 0; i < kTouches; ++i) {
      const Press press = presses.next(), start = beside(press, presses.noise(0.03), 0.1);
      const auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
      const Press exact = ExactFit(ring, strains).from({start}).presses[0];
      const Press found = pressOf(ring, fitted(ring, strains, {start}), strains);
      const double apart = sigmasBetween(ring, exact, found, ring.bound(press));
      CHECK(apart < 5 * rms_sigma);
      squares += apart * apart;
    }
    CHECK(std::sqrt(squares / kTouches) < rms_sigma);
  }
};

TEST(Fit, StepsReachTheOptimumOfTheElasticModel) { checkAgainstExactFit(10, 0.5, 3, 0.2); }

TEST(Fit, SoTheyDoForFirmTouchesWithinTheTablesError) { checkAgainstExactFit(30, 0.5, 3, 0.4); }

// Gauges are off their places and gains: those that read much are trusted less.
TEST(Fit, GaugesAreWeighedByWhatTheyReadWhereTheFingerMayBeOff) {
  constexpr int kTouches = 200;
  config::FingerConfig config;
  config.gauges.model_error = 0.03;
  const ModelRing built(config);
  Presses presses(16, 20, 204, 1, 3);
  double squares = 0, ofEqualWeights = 0;
  for (int i = 0; i < kTouches; ++i) {
    const Press press = presses.next();
    const auto strains = presses.noisy(built.strainsAsBuilt(press, presses), built.noise_strain());
    const auto found = [&](const ModelRing& of) {
      return pressOf(of, fitted(of, strains, {press}), strains);
    };
    const Press exact = ExactFit(built, strains).from({press}).presses[0];
    const Eigen::Vector4d bound = built.bound(exact, built.deviations(strains));
    squares += std::pow(sigmasBetween(built, exact, found(built), bound), 2);
    ofEqualWeights += std::pow(sigmasBetween(built, exact, found(ring), bound), 2);
  }
  std::printf("%.3f, of equal weights %.2f ", std::sqrt(squares / kTouches),
              std::sqrt(ofEqualWeights / kTouches));
  CHECK_COMPARE(std::sqrt(squares / kTouches), <, 0.1);
  CHECK_COMPARE(std::sqrt(ofEqualWeights / kTouches), >, 0.5);
}

TEST(Fit, AShortStepIsAlmostTheLast) {
  constexpr int kTouches = 1000;
  Presses presses(16, 30, 204, 0.5, 3);
  double squares = 0, worst = 0;
  for (int i = 0; i < kTouches; ++i) {
    const Press press = presses.next(), start = beside(press, presses.noise(0.03), 0.1);
    const auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
    const Press found = pressOf(ring, fitted(ring, strains, {start}), strains);
    const Press further = pressOf(ring, fitted(ring, strains, {found}), strains);
    const double apart_sigma = sigmasBetween(ring, further, found, ring.bound(press));
    squares += apart_sigma * apart_sigma;
    worst = std::max(worst, apart_sigma);
  }
  CHECK(std::sqrt(squares / kTouches) < 0.08);
  CHECK(worst < 1);
}

TEST(Fit, WidthsThatNoiseMakesNegativeAre0AndTheRestIsFittedAnew) {
  Presses presses(16, 10, 202);
  int clamped = 0;
  for (int i = 0; i < 100; ++i) {
    const Press press = presses.next();
    const auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
    const Press exact = ExactFit(ring, strains).from({press}).presses[0];
    const Press found = pressOf(ring, fitted(ring, strains, {press}), strains);
    if (found.width_mm == 0) ++clamped;
    DOUBLES_EQUAL(0, sigmasBetween(ring, exact, found, ring.bound(press)), 0.3);
  }
  CHECK(clamped > 30 && clamped < 70);
}

TEST(Fit, StepsConvergeAndLeaveTheResidualsOfTheLastContacts) {
  Presses presses(16, 20, 203, 0.5, 3);
  for (int i = 0; i < 100; ++i) {
    const Press press = presses.next();
    const auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
    const Solution solution = fitted(ring, strains, {beside(press, 0.05, 0.2)});
    CHECK_TRUE(solution.converged);
    const ScaledReadings readings = ring.scaled(strains);
    linearise(ring.tables(), hypothesis, solution.contact, linearisation);
    double energy = 0;
    for (std::size_t k = 0; k < 16; ++k) {
      const double left = readings.value[k] - linearisation.predicted[k];
      energy += left * left;
    }
    // Rounding of sixteen residuals, and a step's gain that is left to be had.
    DOUBLES_EQUAL(energy, static_cast<double>(solution.residualEnergy), 0.05 * energy + 64);
  }
}

TEST(Fit, AWidthThatIsKnownStays) {
  const ModelRing known{ModelRing::ofKnownWidth(2)};
  hypothesis.widthIsFree = false;
  Presses presses(16, 20, 204, 2, 2);
  for (int i = 0; i < 100; ++i) {
    const Press press = presses.next();
    const auto strains = presses.noisy(known.strains(press), known.noise_strain());
    const Press exact = ExactFit(known, strains).from({press}).presses[0];
    const Press found = pressOf(known, fitted(known, strains, {beside(press, 0.05, 0)}), strains);
    DOUBLES_EQUAL(2, found.width_mm, 1e-3);
    DOUBLES_EQUAL(0, sigmasBetween(known, exact, found, known.bound(press, false)), 0.4);
  }
}

TEST(Fit, TwoContactsAreFittedTogether) {
  hypothesis.contacts = 2;
  Presses presses(16, 20, 205, 0.5, 2);
  for (int i = 0; i < 50; ++i) {
    const Press one = presses.next();
    const Press other{one.position_pitch + 5 + i % 3, 15, 4, 1};
    const auto strains = presses.noisy(ring.strains({one, other}), ring.noise_strain());
    const auto exact = ExactFit(ring, strains).from({one, other}).presses;
    const Solution solution = fitted(ring, strains, {beside(one, 0.03, 0.1), beside(other, -0.03, 0.1)});
    const auto bounds = ring.bounds(std::array{one, other});
    for (const int k : {0, 1})
      DOUBLES_EQUAL(0,
                    sigmasBetween(ring, exact[static_cast<std::size_t>(k)],
                                  pressOf(ring, solution, strains, k), bounds[static_cast<std::size_t>(k)]),
                    0.5);
  }
}

TEST(Fit, GaugesThatAreLeftOutMayReadAnything) {
  Presses presses(16, 20, 206, 0.5, 2);
  for (int gauge = 0; gauge < 16; ++gauge) {
    hypothesis.gauges = allGauges(16) & ~(GaugeSet{1} << gauge);
    const Press press{gauge + 0.7, 20, 5, 1};
    auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
    strains[static_cast<std::size_t>(gauge)] = gauge % 2 == 0 ? 0.02 : -0.02;
    const Press exact = ExactFit(ring, strains, hypothesis.gauges, true).from({press}).presses[0];
    const Press found = pressOf(ring, fitted(ring, strains, {beside(press, 0.05, 0.1)}), strains);
    const Eigen::Vector4d bound = ring.bounds({&press, 1}, true, std::array{gauge}).front();
    DOUBLES_EQUAL(0, sigmasBetween(ring, exact, found, bound), 1);
  }
}

TEST(Fit, ThreeReadingsAreSolvedExactly) {
  const ModelRing line{ModelRing::ofKnownWidth(0)};
  hypothesis = {1, false, allGauges(16), 0b0111 << 4};
  Presses presses(16, 20, 207);
  for (int i = 0; i < 50; ++i) {
    const Press press{4.6 + i / 100.0, 20, (i % 5 - 2) * 4.0};
    const auto strains = presses.noisy(line.strains(press), line.noise_strain());
    const Solution solution = fitted(line, strains, {press});
    linearise(line.tables(), hypothesis, solution.contact, linearisation);
    const ScaledReadings readings = line.scaled(strains);
    for (std::size_t gauge = 4; gauge < 7; ++gauge)
      DOUBLES_EQUAL(readings.value[gauge], linearisation.predicted[gauge], 8);
  }
}

TEST(Fit, TheLinearisationPredictsEveryGauge) {
  Presses presses(16, 30, 208, 0, 7);
  for (int i = 0; i < 200; ++i) {
    const Press press = presses.next();
    const auto strains = ring.strains(press);
    const ScaledReadings readings = ring.scaled(strains);
    linearise(ring.tables(), hypothesis, {ring.stateOf(press, readings.shift)}, linearisation);
    // The tables are off by 5.2e-4 of the largest response to either load, which between two gauges is twice
    // what any of them reads.
    for (std::size_t gauge = 0; gauge < 16; ++gauge)
      DOUBLES_EQUAL(readings.value[gauge], linearisation.predicted[gauge], 64);
  }
}

TEST(Fit, GaugesThatDontCountAreRowsOfZeros) {
  hypothesis.gauges = allGauges(16) & ~(GaugeSet{1} << 3);
  linearise(ring.tables(), hypothesis, {ring.stateOf({3.25, 20, 5, 1}, 10)}, linearisation);
  for (std::size_t i = 0; i < 4; ++i)
    for (std::size_t gauge = 2; gauge < 5; ++gauge)
      CHECK_EQUAL(gauge == 3, linearisation.column[i][gauge] == 0);
}

TEST(Fit, AMovedLinearisationPredictsWhatOneOfThatPlaceDoes) {
  Presses presses(16, 30, 210, 0.5, 4);
  Linearisation there;
  for (int i = 0; i < 100; ++i) {
    const Press press = presses.next();
    linearise(ring.tables(), hypothesis, {ring.stateOf(press, 10)}, linearisation);
    const ContactStates moved{ring.stateOf(beside(press, i % 2 == 0 ? 0.01 : 0.3, 0.05), 10)};
    move(ring.tables(), moved, linearisation);
    linearise(ring.tables(), hypothesis, moved, there);
    for (std::size_t gauge = 0; gauge < 16; ++gauge)
      LONGS_EQUAL(there.predicted[gauge], linearisation.predicted[gauge]);
    LONGS_EQUAL(there.at[0].angle_q32, linearisation.at[0].angle_q32);
  }
}

TEST(Fit, ColumnsAreKeptWhereTheyHoldAndAreThoseOfThePlaceElsewhere) {
  const Press press{5.3, 20, 5, 1};
  Linearisation there;
  for (const double pitches : {0.02, 0.05}) {
    linearise(ring.tables(), hypothesis, {ring.stateOf(press, 10)}, linearisation);
    const auto before = linearisation.column;
    const ContactStates moved{ring.stateOf(beside(press, pitches, 0), 10)};
    move(ring.tables(), moved, linearisation);
    linearise(ring.tables(), hypothesis, moved, there);
    const bool isKept = pitches < 1.0 / 32;
    for (std::size_t i = 0; i < 4; ++i)
      for (std::size_t gauge = 0; gauge < 16; ++gauge)
        LONGS_EQUAL((isKept ? before : there.column)[i][gauge], linearisation.column[i][gauge]);
  }
}

// At the farthest that columns are kept, and the largest of four unknowns' errors.
TEST(Fit, AStepWithColumnsFromNearByIsOffByAPartOfSigma) {
  Presses presses(16, 30, 211, 0.5, 3);
  double squares = 0, worst = 0;
  constexpr int kTouches = 500;
  for (int i = 0; i < kTouches; ++i) {
    const Press press = presses.next();
    const auto strains = presses.noisy(ring.strains(press), ring.noise_strain());
    const ScaledReadings readings = ring.scaled(strains);
    const Press exact = pressOf(ring, fitted(ring, strains, {press}), strains);
    linearise(ring.tables(), hypothesis, {ring.stateOf(beside(press, 0.03, 0), readings.shift)},
              linearisation);
    move(ring.tables(), {ring.stateOf(press, readings.shift)}, linearisation);
    const Press found = pressOf(ring, step(ring.tables(), linearisation, readings), strains);
    const double apart_sigma = sigmasBetween(ring, exact, found, ring.bound(press));
    squares += apart_sigma * apart_sigma;
    worst = std::max(worst, apart_sigma);
  }
  CHECK(std::sqrt(squares / kTouches) < 0.45);
  CHECK(worst < 2.5);
}

// Of fingers as built Gauss-Newton's steps may go to and fro between two places for ever.
TEST(Fit, AStepThatLeavesMoreThanWasIsShortened) {
  const ModelRing built;
  Presses presses(16, 20, 212, 0, 3);
  int toAndFro = 0;
  for (int i = 0; i < 600; ++i) {
    const Press press = presses.next();
    const ScaledReadings readings = built.scaled(built.strainsAsBuilt(press, presses));
    const ContactStates start{built.stateOf(beside(press, 0.3, 0), readings.shift)};
    toAndFro += !fit(built.tables(), hypothesis, start, readings, 60, linearisation).converged;

    linearise(built.tables(), hypothesis, start, linearisation, readings.weight_q14);
    Wide left = energyLeft(built.tables(), linearisation, readings);
    Solution solution = step(built.tables(), linearisation, readings);
    for (int steps = 0; steps < 60 && !solution.converged; ++steps) {
      CHECK_COMPARE(descend(built.tables(), readings, linearisation, solution), <=, kDescentMoves);
      CHECK_COMPARE(solution.residualEnergy, <=, left);
      left = solution.residualEnergy;
      LONGS_EQUAL(left, energyLeft(built.tables(), linearisation, readings));
      CHECK(solution.contact == linearisation.at);
      if (!solution.converged) solution = step(built.tables(), linearisation, readings);
    }
    CHECK_TRUE(solution.converged);
  }
  std::printf("%d to and fro ", toAndFro);
  CHECK_COMPARE(toAndFro, >=, 5);
}

// E(f) = E - 2 R f + c f^2 is lowest at R / c, of the way to f = 1 where R was to be taken off.
TEST(Fit, AShortenedStepEndsWhereTheParabolaIsLowest) {
  const ContactStates from{{{100, 1000, -400, 4096}}}, to{{{100 + 25600, 3560, 2160, 14336}}};
  const ContactStates between = partway(from, to, 30, 90);  // a quarter
  LONGS_EQUAL(100 + 6400, between[0].angle_q32);
  LONGS_EQUAL(1640, between[0].normal);
  LONGS_EQUAL(240, between[0].tangential);
  LONGS_EQUAL(6656, between[0].moment_q20);
  CHECK(partway(from, to, 0, 90) == from);
  CHECK(partway(from, to, -5, 90) == from);
  CHECK(partway(from, to, 0, 0) == from);
  const ContactStates back = partway(to, from, 30, 90);
  LONGS_EQUAL(100 + 19200, back[0].angle_q32);
}

TEST(Fit, TheBestLoadsOfAPlaceAreThoseOfLeastSquares) {
  Presses presses(16, 20, 209, 0.5, 4);
  for (int i = 0; i < 100; ++i) {
    const Press press = presses.next(), slid{press.position_pitch, 20, 10, press.width_mm};  // half slips
    const ScaledReadings readings = ring.scaled(ring.strains(slid));
    const ContactState state = ring.stateOf(slid, readings.shift);
    ContactState place = state;
    place.normal = place.tangential = 0;
    const Solution solution =
        fitLoads(ring.tables(), hypothesis, {place}, allOf(ring.tables(), hypothesis, readings),
                 readings.weight_q14, linearisation);
    DOUBLES_EQUAL(state.normal, solution.contact[0].normal, 0.002 * state.normal);
    DOUBLES_EQUAL(state.tangential, solution.contact[0].tangential, 0.002 * state.normal);
    LONGS_EQUAL(state.angle_q32, solution.contact[0].angle_q32);
    CHECK(static_cast<double>(solution.residualEnergy) < energyOutOfReach(slid, readings) + 1e6);
  }
}
