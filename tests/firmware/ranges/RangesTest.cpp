// No intermediate result of the locator's arithmetic leaves its word, for any strains that conditioning gives
// and any tables that checkTableImage() accepts: the firmware's own code, compiled with bounds for numbers.
#include <cmath>
#include <cstdint>

#include "firmware/core/fit_step.hpp"
#include "firmware/core/side_energies.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(Ranges){void setup() override{overflows = 0;
}
void checkNone() { LONGS_EQUAL(0, overflows); }

/// Any readings of a window, as long as they may be together.
static Signal anySignal() {
  const Number any(-32767, 32767, 16);  // below kFoldedLength
  const auto pair = [&](unsigned part) { return Pair{any, any, kSignalLength, part}; };
  return {{pair(1), pair(2)}, {pair(4), pair(8)}};
}
/// Calls visit for a row of each scale that tables may have.
template <typename Visit>
static void forEachScale(Visit visit) {
  for (int exponent = kLeastGradientExponent; exponent <= kMostGradientExponent; ++exponent) {
    provedRow.gradient_exponent = static_cast<std::int8_t>(exponent);
    visit();
  }
}
}
;

TEST(Ranges, AStepOverflowsNothing) {
  forEachScale([&] {
    const FitStep step = fitStep(provedRow, anySignal());
    step.energy();
    CHECK(step.length.most() < 1 << 17);
  });
  checkNone();
}

TEST(Ranges, AmplitudesAndTheirSlopesOverflowNothing) {
  forEachScale([&] { amplitudesOf(provedRow, fitStep(provedRow, anySignal())); });
  checkNone();
}

TEST(Ranges, EnergiesOverflowNothing) {
  const Signal signal = anySignal();
  energyOf(signal);
  exactEnergies(sideParts(provedRow, signal));
  roughEnergies(sideParts(provedRow, signal));
  checkNone();
}

TEST(Ranges, ASignalTwiceAsLongWouldBeFound) {
  Signal signal = anySignal();
  for (Pair* pair : {&signal.even[0], &signal.even[1], &signal.odd[0], &signal.odd[1]})
    pair->length = 4 * kSignalLength;
  fitStep(provedRow, signal);
  CHECK(overflows > 0);
}

TEST(Ranges, APairTakenThreeTimesWouldBeFound) {
  const Signal signal = anySignal();
  const Pair weights = pairAt(&provedRow.basis[0][0]);
  const Number twice = dot(weights, signal.even[0], dot(weights, signal.even[0]));
  checkNone();
  dot(weights, signal.even[0], twice);
  CHECK(overflows > 0);
}
