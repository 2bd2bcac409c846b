#include "host/bench/model/precise_contact.hpp"

#include <array>

#include "host/bench/model/precise.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger::bench;

TEST_GROUP(PreciseContact) {};

// Known to so many digits from another solver (collocation of Chebyshev series, 2e5 harmonics).
TEST(PreciseContact, HasTheKnownLoads) {
  DOUBLES_EQUAL(21.4939181405, preciseContact(2e-3, 0).load_n_per_m, 1e-10);
  const PreciseContact sliding = preciseContact(2e-3, 0.5);
  DOUBLES_EQUAL(21.4885228, sliding.load_n_per_m, 1e-7);
  DOUBLES_EQUAL(0.0621079e-3, sliding.offset_rad * benchAnnulus().outer_radius_m, 1e-10);
}

// Of another program, in double.
TEST(PreciseContact, HasTheKnownSingularValues) {
  const std::array known{1.,          0.944505742, 0.743237461, 0.616636823, 0.403009559, 0.275608680,
                         0.139374811, 0.106010922, 0.065323193, 0.028658452, 0.0108112,   0.00360923};
  const auto values = preciseSingularValues(2e-3, 12);
  for (std::size_t i = 0; i < known.size(); ++i) DOUBLES_EQUAL(known[i], values[i] / values[0], 6e-9);
}
