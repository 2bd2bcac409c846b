// What host/paper/ERRATA.md says of the printed equations, shown.

#include <Eigen/Dense>
#include <array>
#include <cmath>
#include <numbers>
#include <set>
#include <utility>
#include <vector>

#include "host/contact/contact.hpp"
#include "host/contact/contact_field.hpp"
#include "host/contact/slope_map.hpp"
#include "host/model/field.hpp"
#include "host/model/harmonic.hpp"
#include "tests/host/model/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

using Real = long double;
using Matrix2 = Eigen::Matrix<Real, 2, 2>;
using std::numbers::pi;
using testing::kDefaultFinger;
using testing::kGaugeRadius_m;

constexpr std::array kRowsOfThePaper{model::kTrr, model::kTrt, model::kUr, model::kUt, model::kErr};

/// The appendix at one radius. Names as there; s is sigma-hat.
struct Appendix {
  Real n, a, b, g, s, r, mu;

  Appendix(const model::Annulus<double>& finger, double radius_m, int harmonic)
      : n(harmonic),
        a(Real(finger.core_radius_m) / finger.outer_radius_m),
        b(Real(finger.core_radius_m) / radius_m),
        g(Real(radius_m) / finger.outer_radius_m),
        s(3 - 4 * Real(finger.poisson_ratio)),
        r(radius_m),
        mu(finger.shear_modulus_pa) {}

  Real delta() const {
    return std::pow(1 - a * a, 2) * (1 - n * n) -
           (std::pow(a, -2 * n) + a * a * s) * (std::pow(a, 2 * n) + a * a * s);
  }
  Eigen::Matrix<Real, 5, 2> A() const {
    const Real in = std::pow(b, 2 + 2 * n) * s, out = std::pow(b, 2 - 2 * n) * s, bb = b * b;
    const Real up = std::pow(g, n), down = std::pow(g, -n), half = 1 / (2 * mu);
    Eigen::Matrix<Real, 5, 2> matrix;
    matrix << up * (1 + n) * (2 - n + in - bb * (1 - n)), down * (1 - n) * (2 + n + out - bb * (1 + n)),
        up * (1 + n) * (-n - in + bb * (-1 + n)), down * (-1 + n) * (n - out - bb * (1 + n)),
        half * up * r * (s - in + (-1 + bb) * (1 + n)), half * down * r * (s - out + (-1 + bb) * (1 - n)),
        half * up * r * (-s + in + (-1 + bb) * (1 + n)), half * down * r * (s - out + (1 - bb) * (1 - n)),
        half * up * (1 + n) * (-1 - n + s + in + bb * (-1 + n)),
        half * down * (1 - n) * (-1 + n + s + out - bb * (1 + n));
    return matrix;
  }
  /// With what stands above the fractions' bars.
  Matrix2 B(Real upper, Real lower) const {
    Matrix2 matrix;
    matrix << 1 - a * a, -upper / (1 + n), -lower / (1 - n), 1 - a * a;
    return matrix;
  }
  Matrix2 correctB() const { return B(1 + std::pow(a, 2 - 2 * n) * s, 1 + std::pow(a, 2 + 2 * n) * s); }
  Matrix2 printedB() const { return B(1 + a * a - 2 * n * s, 1 + a * a + 2 * n * s); }

  Eigen::Matrix<Real, 5, 2> response(const Matrix2& B) const {
    const Matrix2 L = (Matrix2() << 0.5L, 0.5L, 0.5L, -0.5L).finished();
    return A() * B * L / delta();
  }
};

}  // namespace

TEST_GROUP(Errata) {};

// Long double: the printed form loses digits to alpha^-2n, 1e-5 of them by harmonic 20.
TEST(Errata, TheAppendixHoldsWithTheExponentsRead) {
  for (const model::Annulus<double>& finger : {kDefaultFinger, model::Annulus<double>{5e-3, 10e-3, 1e5, 0.3}})
    for (int n = 2; n <= 12; ++n) {
      const double radius_m = (finger.core_radius_m + finger.outer_radius_m) / 2;
      const Appendix appendix(finger, radius_m, n);
      const auto printed = appendix.response(appendix.correctB());
      const auto known = model::HarmonicModel<double>(finger, radius_m)(n);
      for (std::size_t i = 0; i < kRowsOfThePaper.size(); ++i) {
        const auto row = known.row(kRowsOfThePaper[i]);
        const auto difference = printed.row(static_cast<Eigen::Index>(i)).cast<double>() - row;
        DOUBLES_EQUAL(0, difference.cwiseAbs().maxCoeff() / row.cwiseAbs().maxCoeff(), 1e-11);
      }
    }
}

// At r_b stresses have to be the tractions.
TEST(Errata, TheAppendixAsPrintedDoesNotMeetTheLoad) {
  const Appendix appendix(kDefaultFinger, kDefaultFinger.outer_radius_m, 5);
  const auto missed = [&](const Matrix2& B) {
    return static_cast<double>(
        (appendix.response(B).topRows<2>() - Matrix2::Identity()).cwiseAbs().maxCoeff());
  };
  DOUBLES_EQUAL(0, missed(appendix.correctB()), 1e-15);
  CHECK_TRUE(missed(appendix.printedB()) > 0.1);
}

TEST(Errata, APositiveLambdaPulls) {
  constexpr std::array kRows{model::kErr};
  const std::vector<double> above{0.0};
  const double outwards =
      model::computeField(kDefaultFinger, kGaugeRadius_m, {.normal_n_per_m = -1}, above, kRows)(0, 0);
  const double coefficient =
      model::HarmonicModel<double>(kDefaultFinger, kGaugeRadius_m)(5)(model::kErr, model::kNormal);
  CHECK_TRUE(coefficient > 0);  // of p, and so the impulse response of eq. p_k = lambda / pi cos k theta_c
  CHECK_TRUE(outwards > 0);
}

// theta_w "in radians" is the total width (sec. 2.1), and 2 mm hold 7.5 periods of the 300th harmonic.
// Of a frictionless contact, at its surface: there is no shear to slip under, yet the printed inequality says
// it slips.
TEST(Errata, FrictionAsPrintedLetsNothingStick) {
  constexpr double kFriction = 0.5;
  const contact::SurfaceKernel kernel(kDefaultFinger);
  const contact::Contact flat = contact::solveContact(kernel, {});
  const std::vector<double> angles_rad{-0.06, -0.02, 0.01, 0.05};
  constexpr std::array kRows{model::kTrr, model::kTrt};
  const Eigen::MatrixXd tractions =
      contact::computeContactField(kernel, flat.tractions, kDefaultFinger.outer_radius_m, angles_rad, kRows);
  for (const auto& row : tractions.rowwise()) {
    const double p = row[0], q = row[1];  // tension positive, as sec. 2.1 has it
    CHECK_FALSE(q < kFriction * p);
    CHECK_TRUE(std::abs(q) <= kFriction * std::abs(p));
  }
}

TEST(Errata, TheSamplesOfEquation5SpanTwiceTheWidth) {
  constexpr double kWidth_rad = 2 / 12.7;
  constexpr int kPoints = 604;
  const auto sample = [](int i) { return -2 * (i - kPoints / 2.0) * kWidth_rad / kPoints; };
  DOUBLES_EQUAL(2 * kWidth_rad, sample(0) - sample(kPoints), 1e-15);
  DOUBLES_EQUAL(7.5, 300 * kWidth_rad / (2 * pi), 0.05);
}

// k = int((j - 1) / 2) gives column 2 the wave number 0 and leaves out the cosine of n_c.
TEST(Errata, TheColumnsOfEquation8AreNumberedByHalfOfJ) {
  constexpr int kLast = 10;
  std::set<std::pair<int, bool>> printed, meant;
  for (int j = 2; j <= 2 * kLast + 1; ++j) {
    printed.insert({(j - 1) / 2, j % 2 == 0});
    meant.insert({j / 2, j % 2 == 0});
  }
  CHECK_TRUE(printed.contains({0, true}));
  CHECK_FALSE(printed.contains({kLast, true}));
  for (int k = 1; k <= kLast; ++k) CHECK_TRUE(meant.contains({k, true}) && meant.contains({k, false}));
}

// A shear of cosines, as under a tangential load at 0, makes sines of u_r by +[0 1], the u^c of eq. 7; eq. 8
// puts u^s, by -[0 1], before the cosines of the slope.
TEST(Errata, TheShearColumnsOfEquation8HaveTheirSuperscriptsExchanged) {
  constexpr double kWidth_rad = 0.2;
  constexpr int kAngles = 400, kHarmonic = 4;
  constexpr std::array kRows{model::kUr};
  std::vector<double> angles_rad;
  for (int i = 0; i < kAngles; ++i) angles_rad.push_back(2 * pi * (i + 0.5) / kAngles);
  const auto field =
      model::computeField(kDefaultFinger, kDefaultFinger.outer_radius_m,
                          {.tangential_n_per_m = 1, .width_rad = kWidth_rad}, angles_rad, kRows);
  double sine = 0, cosine = 0;
  for (int i = 0; i < kAngles; ++i) {
    sine += field(i, 0) * std::sin(kHarmonic * angles_rad[static_cast<std::size_t>(i)]) * 2 / kAngles;
    cosine += field(i, 0) * std::cos(kHarmonic * angles_rad[static_cast<std::size_t>(i)]) * 2 / kAngles;
  }
  const double window = std::sin(kHarmonic * kWidth_rad / 2) / (kHarmonic * kWidth_rad / 2);
  const double load = window / (pi * kDefaultFinger.outer_radius_m);
  const auto response =
      model::HarmonicModel<double>(kDefaultFinger, kDefaultFinger.outer_radius_m)(kHarmonic);
  DOUBLES_EQUAL(response(model::kUr, model::kTangential), sine / load, 1e-3 * std::abs(sine / load));
  DOUBLES_EQUAL(0, cosine / sine, 1e-9);
}

TEST(Errata, TheConstantTermHasNoSlopeButADisplacement) {
  const model::Annulus<double> cork{8.9e-3, 12.7e-3, 8.3e4, 0.3};
  contact::FourierTractions constant = contact::FourierTractions::Zero(1, 4);
  constant(0, 0) = 1e3;
  const contact::SurfacePoint surface = contact::surfaceAt(cork, constant, 0.3);
  DOUBLES_EQUAL(0, surface.urSlope_m, 0);
  CHECK_TRUE(std::abs(surface.ur_m) > 1e-6);  // what eq. 9 has in the slope's place
}

// Columns of U and V, as libraries return them, rebuild a block as U Sigma V^T; the paper's are the rows.
TEST(Errata, TheDecompositionOfEquation14HasItsPairsInRows) {
  contact::SlopeMapRequest request;
  request.width_rad = 2 / 12.7;
  const contact::SlopeMap map(kDefaultFinger, request);
  for (const bool isEven : {false, true}) {
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(map.block(isEven).rows(), map.block(isEven).cols());
    for (const auto& pair : contact::singularPairs(map))
      if (pair.isEvenSlope == isEven) sum += pair.value * pair.slopes * pair.unknowns.transpose();
    DOUBLES_EQUAL(0, (sum - map.block(isEven)).norm() / map.block(isEven).norm(), 1e-13);
  }
}
