#include "host/contact/indenter.hpp"

#include <cmath>
#include <limits>
#include <vector>

#include "host/base/failure.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using strainfinger::Failure;
using strainfinger::contact::Indenter;

TEST_GROUP(Indenter) {
  /// y = a cubic, measured at uneven places.
  static double cubic(double x) { return 2 * x * x * x - x * x + 3 * x - 5; }
  static Indenter measuredCubic() {
    std::vector<double> x{-1, -0.7, 0.1, 0.2, 0.9, 1.5}, y;
    for (const double position : x) y.push_back(cubic(position));
    return Indenter::measured(x, y);
  }
};

TEST(Indenter, AFlatOneHasNoHeight) {
  DOUBLES_EQUAL(0, Indenter::flat().height(1e-3), 0);
  DOUBLES_EQUAL(0, Indenter::flat().slope(1e-3), 0);
}

TEST(Indenter, ACylinderIsItsParabola) {
  DOUBLES_EQUAL(1e-4, Indenter::cylinder(5e-3).height(-1e-3), 1e-19);
  DOUBLES_EQUAL(-0.2, Indenter::cylinder(5e-3).slope(-1e-3), 1e-16);
}

TEST(Indenter, AWedgeHasTheSlopeOfItsFaces) {
  const Indenter wedge = Indenter::wedge(45);
  DOUBLES_EQUAL(1e-3, wedge.height(-1e-3), 1e-18);
  DOUBLES_EQUAL(-1, wedge.slope(-1e-3), 1e-15);
  DOUBLES_EQUAL(1, wedge.slope(1e-3), 1e-15);
  DOUBLES_EQUAL(1, wedge.edgeSlope(), 1e-15);
}

TEST(Indenter, AMeasuredCubicIsThatCubicBeyondItsPointsToo) {
  const Indenter measured = measuredCubic();
  for (const double x : {-1.2, -1.0, -0.8, 0.0, 0.15, 0.5, 1.4, 1.7}) {
    DOUBLES_EQUAL(cubic(x), measured.height(x), 1e-13);
    DOUBLES_EQUAL(6 * x * x - 2 * x + 3, measured.slope(x), 1e-12);
  }
}

TEST(Indenter, KnowsWhereItWasMeasured) {
  DOUBLES_EQUAL(-1, measuredCubic().firstPosition_m(), 0);
  DOUBLES_EQUAL(1.5, measuredCubic().lastPosition_m(), 0);
  CHECK_TRUE(std::isinf(Indenter::flat().lastPosition_m()));
}

TEST(Indenter, RefusesAShapeThatIsNone) {
  CHECK_THROWS(Failure, Indenter::measured({0, 1, 2}, {0, 0, 0}));
  CHECK_THROWS(Failure, Indenter::measured({0, 1, 1, 2}, {0, 0, 0, 0}));
  CHECK_THROWS(Failure, Indenter::measured({0, 2, 1, 3}, {0, 0, 0, 0}));
}
