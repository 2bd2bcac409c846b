#include "host/calibration/expected_error.hpp"

#include <cmath>
#include <random>

#include "host/calibration/touch_fit.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::calibration;

TEST_GROUP(ExpectedError) {
  strainfinger::config::FingerConfig config;
  const Drawing drawing{config};

  CalibrationResult resultOf(const Eigen::VectorXd& deviations, const Eigen::MatrixXd& covariance) {
    return {drawing, deviations, covariance, {}, {0, 0}};
  }
  Eigen::VectorXd none() const { return Eigen::VectorXd::Zero(drawing.unknowns()); }
  Eigen::MatrixXd known() const {
    return 1e-12 * Eigen::MatrixXd::Identity(drawing.unknowns(), drawing.unknowns());
  }
};

TEST(ExpectedError, OfAFingerThatIsKnownIsTheNoises) {
  const auto errors = expectedErrors(resultOf(none(), known()));
  for (int i = 0; i < 3; ++i) DOUBLES_EQUAL(errors.bound[i], errors.after[i], 1e-6 * errors.bound[i]);
  CHECK_COMPARE(errors.before.norm(), <, 0.01 * errors.bound.norm());
  CHECK(errors.bound[0] > 5e-6 && errors.bound[0] < 20e-6);
}

// A ring turned by 0.1 deg, glued so or not known better, is 22 um of arc.
TEST(ExpectedError, OfATurnedRingIsTheTurn) {
  const double turn = 0.1 / config.tolerance.angle_deg, arc_m = 0.1 * 3.14159265 / 180 * 12.7e-3;
  Eigen::VectorXd turned = none();
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge) turned[Drawing::at(gauge, kAngleOffset)] = turn;
  DOUBLES_EQUAL(arc_m, expectedErrors(resultOf(turned, known())).before[0], 1e-3 * arc_m);
  const auto after = expectedErrors(resultOf(none(), known() + turned * turned.transpose()));
  DOUBLES_EQUAL(std::hypot(arc_m, after.bound[0]), after.after[0], 1e-3 * arc_m);
}

TEST(ExpectedError, ATurnAndAUnitOfForceAreNoErrorOfReadings) {
  Eigen::VectorXd turned = none();
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge) turned[Drawing::at(gauge, kAngleOffset)] = 1;
  Eigen::MatrixXd covariance = known() + turned * turned.transpose();
  covariance(drawing.at(kShearModulus), drawing.at(kShearModulus)) += 1;
  CHECK_COMPARE(fingerError(resultOf(none(), covariance)), <, 1e-6);
}

// Fingers whose gains are drawn with a standard deviation of 1 %: touches located as drawn are off by one
// sigma (RMS) of readings that are off by as much of the largest as is said, in what is off most. Chance of
// the RMS of 20 draws of 16 gains is 4 %.
TEST(ExpectedError, TouchesAreOffAsByIndependentErrorsOfReadings) {
  constexpr double kGainSigma = 0.01;
  Eigen::MatrixXd covariance = known();
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge)
    covariance(Drawing::at(gauge, kGain), Drawing::at(gauge, kGain)) =
        std::pow(kGainSigma / config.tolerance.gain, 2);
  const double error = fingerError(resultOf(none(), covariance));

  const RingResponse ring(drawing, none(), RingResponse::lastHarmonic(drawing));
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  const auto drawn = [&] {
    Eigen::VectorXd values(drawing.gauges());
    for (double& value : values) value = normal(random);
    return values;
  };
  Eigen::Array3d squares = Eigen::Array3d::Zero();  // of errors over sigmas
  for (int draw = 0; draw < 20; ++draw) {
    const Eigen::VectorXd gains = kGainSigma * drawn();
    for (const TouchState& touch : judgedTouches(drawing)) {
      const Eigen::VectorXd exact = ring.readings(touch);
      const double sigma_strain = error * exact.cwiseAbs().maxCoeff();
      const TouchState found = refineTouch(ring, {exact + gains.cwiseProduct(exact), 1e-6, {}}, touch).touch;
      const TouchState variance = touchVariances(ring, touch, known(), sigma_strain).noise;
      squares += (found - touch).cwiseAbs2().cwiseQuotient(variance).head<3>().array();
    }
  }
  const auto count = static_cast<double>(20 * judgedTouches(drawing).size());
  DOUBLES_EQUAL(1, (squares / count).sqrt().maxCoeff(), 0.12);
}
