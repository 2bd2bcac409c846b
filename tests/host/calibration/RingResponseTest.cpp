#include "host/calibration/ring_response.hpp"

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <random>
#include <vector>

#include "host/model/harmonic.hpp"
#include "host/simulation/gauge_strains.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::calibration;

namespace {

using Digits50 =
    boost::multiprecision::number<boost::multiprecision::cpp_bin_float<50>, boost::multiprecision::et_off>;

/// A ring of one gauge's unknowns, the rubber's and the touch's, in 50 digits.
struct Exactly {
  Digits50 gain, zero, angle, radius, core, poisson, logModulus, place, normal, tangential, moment;
};

/// 2 J_1(x) / x with x^2 = 4 n^2 moment, by its power series in x^2 / 4: 4 moment is the ellipse's half width
/// squared.
Digits50 ellipseFactor(int n, const Digits50& moment) {
  const Digits50 quarter = Digits50(n) * n * moment;
  Digits50 term = 1, sum = 1;
  for (int k = 1; k < 400; ++k) {
    term *= -quarter / (Digits50(k) * (k + 1));
    sum += term;
    if (abs(term) < 1e-55 * abs(sum)) break;
  }
  return sum;
}

/// The reading as the sum over harmonics that it is; the shear as Mindlin's, mu = 1, in partial slip.
Digits50 readingOf(const Exactly& x, int lastHarmonic) {
  const Digits50 pi = boost::math::constants::pi<Digits50>(), outer("0.0127");
  const Digits50 modulus = Digits50(8.3e4) * exp(x.logModulus);
  const model::HarmonicModel<Digits50> rubber({x.core, Digits50(12.7e-3), modulus, x.poisson}, x.radius);
  const Digits50 used = abs(x.tangential) / x.normal;
  Digits50 sum = 0;
  for (int n = 0; n <= lastHarmonic; ++n) {
    const auto response = rubber(n);
    const Digits50 wide = ellipseFactor(n, x.moment);
    const Digits50 shear = wide - (1 - used) * ellipseFactor(n, x.moment * (1 - used));
    const Digits50 slid = x.tangential > 0 ? x.normal : Digits50(-x.normal);
    const Digits50 scale = Digits50(n == 0 ? 0.5 : 1) / (pi * Digits50(12.7e-3));
    sum += scale * (-x.normal * wide * response(model::kErr, 0) * cos(n * (x.angle - x.place)) +
                    slid * shear * response(model::kErr, 1) * sin(n * (x.angle - x.place)));
  }
  return x.gain * sum + x.zero;
}

/// Central differences: with 50 digits a step of 1e-16 of the value's scale leaves 1e-30.
double slopeOf(const Exactly& at, Digits50 Exactly::*variable, double scale, int lastHarmonic) {
  const Digits50 step = Digits50(scale) * Digits50("1e-16");
  Exactly above = at, below = at;
  above.*variable += step;
  below.*variable -= step;
  return static_cast<double>((readingOf(above, lastHarmonic) - readingOf(below, lastHarmonic)) / (2 * step));
}

}  // namespace

TEST_GROUP(RingResponse) {
  config::FingerConfig config;
  std::mt19937_64 random{20241120};
  std::normal_distribution<double> normal;

  Eigen::VectorXd someDeviations(const Drawing& drawing) {
    Eigen::VectorXd deviations(drawing.unknowns());
    for (double& each : deviations) each = normal(random);
    deviations[drawing.at(kPoissonRatio)] = -std::abs(deviations[drawing.at(kPoissonRatio)]);
    return deviations;
  }

  Exactly exactly(const Drawing& drawing, const Eigen::VectorXd& deviations, int gauge,
                  const TouchState& touch) {
    const auto placed = drawing.gauge(deviations, gauge);
    const auto annulus = drawing.annulus(deviations);
    const double logModulus = drawing.tolerance(kShearModulus) * deviations[drawing.at(kShearModulus)];
    return {placed.gain,
            drawing.zero_strain(deviations, gauge),
            placed.angle_rad,
            placed.radius_m,
            annulus.core_radius_m,
            annulus.poisson_ratio,
            logModulus,
            touch[kPlace],
            touch[kNormalLoad],
            touch[kTangentialLoad],
            touch[kMoment]};
  }
};

// Every derivative at some gauges, under touches that slip either way, a line among them. The error is
// counted in the largest of the derivatives to the same unknown.
TEST(RingResponse, DerivativesAreThoseOfDifferencesIn50Digits) {
  const Drawing drawing(config);
  const int last = 40;
  const Eigen::VectorXd deviations = someDeviations(drawing);
  const RingResponse ring(drawing, deviations, last);
  for (const TouchState& touch :
       {TouchState{0.3, 20, 7, 1.2e-3}, TouchState{0.5, 30, -25, 4e-3}, TouchState{0.4, 5, 1e-3, 1e-7}}) {
    const auto linear = ring.linearised(touch, true);
    for (const int gauge : {0, 1, 3, 9}) {
      const Exactly x = exactly(drawing, deviations, gauge, touch);
      const auto check = [&](Digits50 Exactly::*variable, double unit, const auto& column) {
        const double largest = column.cwiseAbs().maxCoeff();
        const double slope = unit * slopeOf(x, variable, std::abs(unit), last);
        DOUBLES_EQUAL(slope, column[gauge], 1e-10 * largest);
      };
      DOUBLES_EQUAL(static_cast<double>(readingOf(x, last)), linear.readings[gauge],
                    1e-13 * linear.readings.cwiseAbs().maxCoeff());
      check(&Exactly::place, 1, linear.toTouch.col(kPlace));
      check(&Exactly::normal, 1, linear.toTouch.col(kNormalLoad));
      check(&Exactly::tangential, 1, linear.toTouch.col(kTangentialLoad));
      check(&Exactly::moment, 1e-6, Eigen::VectorXd(1e-6 * linear.toTouch.col(kMoment)));
      const auto own = [&](GaugeUnknown unknown) {
        return Eigen::VectorXd(linear.toFinger.col(Drawing::at(gauge, unknown)));
      };
      check(&Exactly::gain, drawing.tolerance(kGain), own(kGain));
      check(&Exactly::zero, drawing.tolerance(kZero), own(kZero));
      check(&Exactly::angle, drawing.tolerance(kAngleOffset), own(kAngleOffset));
      check(&Exactly::radius, -drawing.tolerance(kDepthOffset), own(kDepthOffset));
      check(&Exactly::core, drawing.tolerance(kCoreRadius), linear.toFinger.col(drawing.at(kCoreRadius)));
      check(&Exactly::poisson, drawing.tolerance(kPoissonRatio),
            linear.toFinger.col(drawing.at(kPoissonRatio)));
      check(&Exactly::logModulus, drawing.tolerance(kShearModulus),
            linear.toFinger.col(drawing.at(kShearModulus)));
    }
  }
}

TEST(RingResponse, AGaugeFeelsItsOwnUnknownsOnly) {
  const Drawing drawing(config);
  const RingResponse ring(drawing, someDeviations(drawing), 30);
  const auto linear = ring.linearised({1, 20, 5, 1e-3}, true);
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge)
    for (int other = 0; other < drawing.gauges(); ++other)
      if (other != gauge)
        DOUBLES_EQUAL(0, linear.toFinger.row(gauge).segment<kGaugeUnknowns>(Drawing::at(other, kGain)).norm(),
                      0);
}

// The simulator sums its harmonics another way, to 1e-9 of the peak; this is cut at 1e-7.
TEST(RingResponse, ReadsWhatTheSimulatedFingerDoes) {
  for (const auto component : {StrainComponent::kRadial, StrainComponent::kHoop, StrainComponent::kShear}) {
    config.gauges.component = component;
    config.gauges.arc_length_m = 1e-3;
    const Drawing drawing(config);
    const RingResponse ring(drawing, Eigen::VectorXd::Zero(drawing.unknowns()),
                            RingResponse::lastHarmonic(drawing));
    const simulation::GaugeStrains simulated(config);
    for (const double tangential_n_per_m : {12.0, -20.0, 0.0}) {
      const simulation::Touch touch{1.3, 20, tangential_n_per_m, 3e-3};
      const Eigen::VectorXd expected = simulated.readings({&touch, 1});
      const double moment_rad2 = model::momentOfWidth(3e-3 / config.finger.outer_radius_m);
      const Eigen::VectorXd found = ring.readings({1.3, 20, tangential_n_per_m, moment_rad2});
      CHECK_COMPARE((found - expected).cwiseAbs().maxCoeff(), <, 1e-6 * expected.cwiseAbs().maxCoeff());
    }
  }
}

TEST(RingResponse, UnitReadingsAreThoseOfUnitLoads) {
  const Drawing drawing(config);
  const RingResponse ring(drawing, someDeviations(drawing), 40);
  const Eigen::MatrixX2d unit = ring.unitReadings(2, ring.spread(1e-3, 1e-3));
  // in full sliding the shear is spread like the pressure
  const Eigen::VectorXd both = ring.readings({2, 10, 10, 1e-3}) - ring.zeros();
  CHECK_COMPARE((10 * unit.rowwise().sum() - both).norm(), <, 1e-12 * both.norm());
}
