#include "host/contact/tractions.hpp"

#include <cmath>
#include <numbers>

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger::contact;
using std::numbers::pi;

TEST_GROUP(Tractions) {
  /// A semi-ellipse of peak 3 Pa, its shear half of it, and a stuck shear 1 / sqrt(1 - x^2).
  static Tractions ellipse() {
    PatchTractions part;
    part.patch = {0.5, 0.2};
    part.smooth = {kSmoothEdges, Eigen::VectorXd::Constant(1, 3 * std::sqrt(pi / 2))};
    part.friction = 0.5;
    part.stuck = {kStuckEdges, Eigen::VectorXd::Constant(1, std::sqrt(pi))};
    return {part};
  }

  /// 7 arccosh(1/|z|), x0 = 0.3, and as much shear the other way.
  static Tractions tip() {
    PatchTractions part;
    part.patch = {-0.5, 0.1};
    part.tip = {0.3, Eigen::VectorXd::Constant(1, 7 * std::sqrt(pi / 2)), {}};
    part.friction = -1;
    return {part};
  }

  /// The same with series of several terms, and a step of the pressure.
  static Tractions stepped() {
    PatchTractions part = tip()[0];
    part.tip.log = Eigen::Vector3d(1, -2, 3);
    part.tip.step = Eigen::Vector2d(4, 5);
    return {part};
  }

  /// Sum of the line tractions times cos n angle.
  static Traction coefficient(const Tractions& tractions, int n) {
    Traction sum;
    for (const LineTraction& line : lineTractions(tractions, n)) {
      sum.pressure_pa += line.pressure_pa_rad * std::cos(n * line.angle_rad);
      sum.shear_pa += line.shear_pa_rad * std::cos(n * line.angle_rad);
    }
    return sum;
  }
};

TEST(Tractions, AreWhatTheyAreMadeOf) {
  const Traction centre = tractionAt(ellipse(), 0.5), side = tractionAt(ellipse(), 0.38);  // x = -0.6
  DOUBLES_EQUAL(3, centre.pressure_pa, 1e-15);
  DOUBLES_EQUAL(2.5, centre.shear_pa, 1e-15);
  DOUBLES_EQUAL(2.4, side.pressure_pa, 1e-14);
  DOUBLES_EQUAL(1.2 + 1.25, side.shear_pa, 1e-14);
}

TEST(Tractions, AreExactlyZeroOutside) {
  for (const double angle_rad : {0.2999, 0.7001, -3.0}) {
    DOUBLES_EQUAL(0, tractionAt(ellipse(), angle_rad).pressure_pa, 0);
    DOUBLES_EQUAL(0, tractionAt(ellipse(), angle_rad).shear_pa, 0);
  }
}

// int sqrt(1 - x^2) cos(k x) dx = pi J_1(k) / k, int cos(k x) / sqrt(1 - x^2) dx = pi J_0(k).
TEST(Tractions, HaveTheFourierCoefficientsOfLineTractions) {
  for (const int n : {0, 1, 7, 300}) {
    const double k = 0.2 * n, turn = 0.2 * std::cos(n * 0.5) * pi;
    const double root = n == 0 ? 0.5 : std::cyl_bessel_j(1, k) / k;
    const Traction sum = coefficient(ellipse(), n);
    DOUBLES_EQUAL(3 * root * turn, sum.pressure_pa, 2e-14);
    DOUBLES_EQUAL((1.5 * root + std::cyl_bessel_j(0, k)) * turn, sum.shear_pa, 1e-13);
  }
}

TEST(Tractions, TotalsAreTheZerothCoefficients) {
  for (const Tractions& tractions : {ellipse(), tip(), stepped()}) {
    DOUBLES_EQUAL(coefficient(tractions, 0).pressure_pa, totalTraction(tractions).pressure_pa, 1e-14);
    DOUBLES_EQUAL(coefficient(tractions, 0).shear_pa, totalTraction(tractions).shear_pa, 1e-14);
  }
}

// With a step of zero the double exponential rule integrates what product weights do without.
TEST(Tractions, ATipsFourierCoefficientsAreThoseOfItsIntegral) {
  Tractions smooth = stepped(), known = stepped();
  smooth[0].tip.step = {};
  known[0].tip.step.setZero();
  for (const int n : {0, 3, 40, 300}) {
    const Traction sum = coefficient(smooth, n), integral = coefficient(known, n);
    DOUBLES_EQUAL(integral.pressure_pa, sum.pressure_pa, 1e-14);
    DOUBLES_EQUAL(integral.shear_pa, sum.shear_pa, 1e-14);
  }
}

TEST(Tractions, PressureBelowATipIsInfiniteAtTheTipOnly) {
  PatchTractions middle = tip()[0];
  middle.tip.position = 0;
  CHECK_TRUE(std::isinf(tractionAt({middle}, -0.5).pressure_pa));
  const double known = 7 * std::acosh((1 + 0.5 * 0.3) / 0.8);  // x = -0.5
  DOUBLES_EQUAL(known, tractionAt(tip(), -0.55).pressure_pa, 1e-13);
  DOUBLES_EQUAL(-known, tractionAt(tip(), -0.55).shear_pa, 1e-13);
}

// arccos|z| is pi/2 on both sides of the tip; the series' first two polynomials are sqrt(2/pi) {1, 2 x}.
TEST(Tractions, PressureBelowATipJumpsByTheStep) {
  PatchTractions part = stepped()[0];
  part.tip.log.setZero();
  const double root = std::sqrt(2 / pi), known = pi / 2 * root * (4 + 5 * 2 * 0.3);
  const double at_rad = part.patch.centre_rad + 0.3 * part.patch.half_rad, by_rad = 1e-12;
  DOUBLES_EQUAL(known, tractionAt({part}, at_rad + by_rad).pressure_pa, 1e-9);
  DOUBLES_EQUAL(-known, tractionAt({part}, at_rad - by_rad).pressure_pa, 1e-9);
}
