#include "host/calibration/expected_error.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include "host/calibration/touch_fit.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::calibration;

TEST_GROUP(ExpectedError) {
  strainfinger::config::FingerConfig config;
  const Drawing drawing{config};

  CalibrationResult resultOf(const Eigen::VectorXd& deviations, const Eigen::MatrixXd& covariance) {
    return {drawing, deviations, covariance, {}, {0, 0}, true};
  }
  Eigen::VectorXd none() const { return Eigen::VectorXd::Zero(drawing.unknowns()); }
  Eigen::MatrixXd known() const {
    return 1e-12 * Eigen::MatrixXd::Identity(drawing.unknowns(), drawing.unknowns());
  }
};

TEST(ExpectedError, OfAFingerThatIsKnownIsTheNoises) {
  const auto errors = expectedErrors(resultOf(none(), known()));
  for (int i = 0; i < 3; ++i) {
    DOUBLES_EQUAL(errors.bound[i], errors.after[i], 1e-6 * errors.bound[i]);
    DOUBLES_EQUAL(errors.bound[i], errors.before[i], 1e-3 * errors.bound[i]);
  }
  CHECK(errors.bound[0] > 5e-6 && errors.bound[0] < 20e-6);
}

// A ring turned by 0.1 deg, glued so or not known better, is 22 um of arc.
TEST(ExpectedError, OfATurnedRingIsTheTurn) {
  const double turn = 0.1 / config.tolerance.angle_deg, arc_m = 0.1 * 3.14159265 / 180 * 12.7e-3;
  Eigen::VectorXd turned = none();
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge) turned[Drawing::at(gauge, kAngleOffset)] = turn;
  const auto before = expectedErrors(resultOf(turned, known()));
  DOUBLES_EQUAL(std::hypot(arc_m, before.bound[0]), before.before[0], 1e-3 * arc_m);
  const auto after = expectedErrors(resultOf(none(), known() + turned * turned.transpose()));
  DOUBLES_EQUAL(std::hypot(arc_m, after.bound[0]), after.after[0], 1e-3 * arc_m);
}

// What the calibration doesn't know the drawing did not know either.
TEST(ExpectedError, CalibratingMakesNothingWorse) {
  Eigen::MatrixXd covariance = known();
  covariance(drawing.at(kShearModulus), drawing.at(kShearModulus)) += 1;
  const auto errors = expectedErrors(resultOf(none(), covariance));
  CHECK_TRUE(errors.after[1] > 3);
  for (int i = 0; i < 3; ++i) CHECK_TRUE(errors.after[i] <= errors.before[i]);
}

// A fifth, the modulus' tolerance.
TEST(ExpectedError, AUnitOfForceOfWhichNothingIsKnownIsTheDrawings) {
  Eigen::MatrixXd covariance = known();
  covariance(drawing.at(kShearModulus), drawing.at(kShearModulus)) += 1;
  DOUBLES_EQUAL(config.tolerance.shear_modulus, calibrationErrors(resultOf(none(), covariance)).load, 1e-4);
}

// A mark that is 0.05 deg off is 11 um of arc, a scale that is 1 % off 1 % of the loads.
TEST(ExpectedError, ATurnAndAUnitOfForceThatWereToldAreAsGoodAsTold) {
  constexpr double kTurn_deg = 0.05, kScale = 0.01;
  Eigen::VectorXd turned = none();
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge)
    turned[Drawing::at(gauge, kAngleOffset)] = kTurn_deg / config.tolerance.angle_deg;
  Eigen::MatrixXd covariance = known() + turned * turned.transpose();
  const Eigen::Index modulus = drawing.at(kShearModulus);
  covariance(modulus, modulus) += std::pow(kScale / config.tolerance.shear_modulus, 2);
  const auto errors = calibrationErrors(resultOf(none(), covariance));
  const double arc_m = kTurn_deg * 3.14159265 / 180 * 12.7e-3;
  DOUBLES_EQUAL(arc_m, errors.place_m, 1e-3 * arc_m);
  DOUBLES_EQUAL(kScale, errors.load, 1e-3 * kScale);
  CHECK_COMPARE(errors.moment_m2, <, 1e-10);
}

// Fingers whose gains are drawn with a standard deviation of 1 %: touches located as drawn are off by as much
// as is said (RMS). Chance of the RMS of 20 draws of 16 gains is 4 %.
TEST(ExpectedError, TouchesAreOffAsMuchAsIsSaid) {
  constexpr double kGainSigma = 0.01;
  Eigen::MatrixXd covariance = known();
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge)
    covariance(Drawing::at(gauge, kGain), Drawing::at(gauge, kGain)) =
        std::pow(kGainSigma / config.tolerance.gain, 2);
  const auto said = calibrationErrors(resultOf(none(), covariance));

  const RingResponse ring(drawing, none(), RingResponse::lastHarmonic(drawing));
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal;
  TouchState squares = TouchState::Zero();
  for (int draw = 0; draw < 20; ++draw) {
    Eigen::VectorXd gains(drawing.gauges());
    for (double& gain : gains) gain = 1 + kGainSigma * normal(random);
    for (const TouchState& touch : judgedTouches(drawing)) {
      const Eigen::VectorXd readings = ring.readings(touch).cwiseProduct(gains);
      squares += (refineTouch(ring, {readings, 1e-6, {}}, touch).touch - touch).cwiseAbs2();
    }
  }
  const double radius_m = config.finger.outer_radius_m;
  const auto count = static_cast<double>(20 * judgedTouches(drawing).size());
  const TouchState rms = (squares / count).cwiseSqrt();
  const auto checkClose = [](double expected, double value) {
    DOUBLES_EQUAL(expected, value, 0.12 * expected);
  };
  checkClose(radius_m * rms[kPlace], said.place_m);
  checkClose(std::max(rms[kNormalLoad], rms[kTangentialLoad]) / 30, said.load);
  checkClose(radius_m * radius_m * rms[kMoment], said.moment_m2);
}
