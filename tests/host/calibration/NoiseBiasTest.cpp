#include "host/calibration/noise_bias.hpp"

#include <cmath>
#include <random>
#include <vector>

#include "host/calibration/touch_fit.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger::calibration;

TEST_GROUP(NoiseBias) {
  const strainfinger::config::FingerConfig config;
  const Drawing drawing{config};
  const int last = RingResponse::lastHarmonic(drawing);
  const Eigen::VectorXd deviations = Eigen::VectorXd::Zero(drawing.unknowns());
  const RingResponse ring{drawing, deviations, last};
  const Eigen::MatrixXd identity = Eigen::MatrixXd::Identity(drawing.unknowns(), drawing.unknowns());
  JointFit fit{deviations, {}};

  /// Wide and weak, so that noise moves them along much of a curve. Each is there eight times: then it is
  /// given all sixteen patterns.
  void setup() override {
    for (int i = 0; i < 64; ++i) {
      const int touch = i / 8;
      fit.touches.push_back({0.8 * touch, 8, 1 + 0.2 * touch, 3e-3});
    }
  }
  std::vector<TouchData> data(double sigma_strain) const {
    std::vector<TouchData> all;
    for (const TouchState& touch : fit.touches) all.push_back({ring.readings(touch), sigma_strain, {}});
    return all;
  }
  double ofPoisson(const Eigen::VectorXd& unknowns) const { return unknowns[drawing.at(kPoissonRatio)]; }
};

// Normal noise of the standard library's in place of the patterns; its mirror image beside it, as the mean of
// what is linear would take 10,000 times as many draws to vanish.
TEST(NoiseBias, IsTheMeanOfWhatNoiseMakesOfTheSlopes) {
  constexpr double kSigma = 6e-6;
  constexpr int kDraws = 30;
  std::mt19937_64 random{20241123};
  std::normal_distribution<double> normal(0, kSigma);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(drawing.unknowns());
  for (const TouchState& touch : fit.touches)
    for (int draw = 0; draw < kDraws; ++draw) {
      Eigen::VectorXd noise(drawing.gauges());
      for (double& each : noise) each = normal(random);
      for (const double sign : {1.0, -1.0}) {
        const Eigen::VectorXd readings = ring.readings(touch) + sign * noise;
        const auto model = ring.linearised(refineTouch(ring, {readings, kSigma, {}}, touch).touch, true);
        sum += model.toFinger.transpose() * (readings - model.readings) / (kSigma * kSigma);
      }
    }
  const double expected = ofPoisson(sum) / (2 * kDraws);
  DOUBLES_EQUAL(expected, ofPoisson(noiseBias(drawing, last, data(kSigma), fit, identity)),
                0.15 * std::abs(expected));
}

// Slopes count residuals, which grow with noise squared, in noise squared.
TEST(NoiseBias, OfTheSlopesIsTheSameForSmallerNoise) {
  const double of3 = ofPoisson(noiseBias(drawing, last, data(3e-6), fit, identity));
  CHECK_COMPARE(std::abs(of3), >, 0);
  DOUBLES_EQUAL(of3, ofPoisson(noiseBias(drawing, last, data(1e-6), fit, identity)), 0.1 * std::abs(of3));
}

TEST(NoiseBias, OfAFingerThatIsKnownIsNone) {
  const Eigen::VectorXd bias = noiseBias(drawing, last, data(6e-6), fit, 0 * identity);
  DOUBLES_EQUAL(0, bias.norm(), 0);
}

// Larger loads on stiffer rubber read the same. What a fit's last step leaves must not tell them apart: the
// sum over thousands of touches would be a unit of force of its own.
TEST(NoiseBias, TouchesOfUnknownLoadTellNothingOfTheUnitOfForce) {
  const Eigen::VectorXd bias = noiseBias(drawing, last, data(6e-6), fit, identity);
  DOUBLES_EQUAL(0, bias[drawing.at(kShearModulus)], 1e-9);
}
