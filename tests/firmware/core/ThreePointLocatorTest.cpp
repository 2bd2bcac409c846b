#include <cmath>

#include "firmware/core/locator.hpp"

#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

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
