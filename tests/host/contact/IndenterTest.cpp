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

// Between points that are 0.1 apart the fifth derivative of a sine is as small as the fourth.
TEST(Indenter, OfASmoothShapeTheCurveIsTheCubicOfItsNeighbours) {
  std::vector<double> x, y;
  for (int i = -20; i <= 20; ++i) x.push_back(0.1 * i), y.push_back(std::sin(0.1 * i));
  // half way between even points the error of a cubic is 3/128 h^4 of the fourth derivative
  const double ofCubic = 3.0 / 128 * 1e-4;
  DOUBLES_EQUAL(ofCubic, Indenter::measured(x, y).swing(-1.5, 1.5).height_m, 0.02 * ofCubic);
  DOUBLES_EQUAL(0, measuredCubic().swing(-1, 1).height_m, 1e-14);
  DOUBLES_EQUAL(0, Indenter::wedge(45).swing(-1, 1).height_m, 0);
}

TEST(Indenter, AtAStepTheCurveSwingsAndSaysWhere) {
  std::vector<double> x, y;
  for (int i = 0; i <= 40; ++i) x.push_back(i), y.push_back(i < 20 ? 0 : 1);
  const Indenter step = Indenter::measured(x, y);
  const Indenter::Swing swing = step.swing(0, 40);
  CHECK_TRUE(swing.height_m > 0.03 && swing.height_m < 0.1);
  DOUBLES_EQUAL(19.5, swing.position_m, 2);
  DOUBLES_EQUAL(swing.height_m, step.swing(21, 25).height_m, 0);
  CHECK_TRUE(step.swing(30, 40).height_m < 1e-2 * swing.height_m);
}
