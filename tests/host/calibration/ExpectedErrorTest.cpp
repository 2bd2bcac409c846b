#include "host/calibration/expected_error.hpp"

#include <cmath>

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

// Gains that are known to 1 %, each by itself: so are readings, the largest one best felt.
TEST(ExpectedError, GainsThatAreNotKnownAreAnErrorOfReadings) {
  Eigen::MatrixXd covariance = known();
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge)
    covariance(Drawing::at(gauge, kGain), Drawing::at(gauge, kGain)) =
        std::pow(0.01 / config.tolerance.gain, 2);
  const double error = fingerError(resultOf(none(), covariance));
  CHECK(error > 0.003 && error < 0.01);
}
