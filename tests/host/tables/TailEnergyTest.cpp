#include "host/tables/tail_energy.hpp"

#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(TailEnergy){
    /// Outside the seven gauges about the nearest, over inside.
    static double share(const ModelRing& ring, const Press& press){const auto strains = ring.strains(press);
double inside = 0, outside = 0;
for (int gauge = 0; gauge < ring.gauges(); ++gauge) {
  const double strain = strains[static_cast<std::size_t>(gauge)];
  const bool near = std::abs(ring.between(std::round(press.position_pitch), gauge)) <= kWindowReach;
  (near ? inside : outside) += strain * strain;
}
return outside / inside;
}
static double most(const ModelRing& ring) {
  Presses presses(ring.gauges(), 1, 701);
  double most = 0;
  for (int i = 0; i < 4000; ++i) most = std::max(most, share(ring, presses.next()));
  return most;
}
}
;

TEST(TailEnergy, IsTheMostThatContactsLeaveOutsideTheirWindow) {
  for (const int gauges : {12, 16, 24, 32}) {
    const ModelRing ring(ModelRing::configOf(gauges));
    const double table = ring.constants().tail_q16 / 65536.0, found = most(ring);
    CHECK(found <= table);
    CHECK(table <= 2 * found);  // a margin of a quarter, and loads a quarter beyond the friction cone
  }
}

TEST(TailEnergy, AWindowOfTheWholeRingHasNone) {
  const model::ImpulseResponse response(config::Finger{}.annulus(), 9.4e-3, StrainComponent::kRadial);
  DOUBLES_EQUAL(0, tables::tailEnergy(response, 7, 1), 0);
}
