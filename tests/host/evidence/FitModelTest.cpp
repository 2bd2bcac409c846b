#include "host/evidence/fit_model.hpp"

#include <array>
#include <cmath>

#include "host/simulation/gauge_strains.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::evidence;

TEST_GROUP(FitModel) {
  config::FingerConfig config;

  /// Largest difference of a fit's readings from the simulated ones.
  double misfitOf(const simulation::Touch& touch) {
    const FitModel model(config);
    const FittedContact contact = model.describe(touch);
    return (model.readings({&contact, 1}) - simulation::GaugeStrains(config).readings({&touch, 1}))
        .cwiseAbs()
        .maxCoeff();
  }
};

TEST(FitModel, LineLoadsAndHertzPressuresAreDescribedExactly) {
  for (const double width_m : {0.0, 2e-3, 6e-3}) CHECK_TRUE(misfitOf({1.3, 20, 0, width_m}) < 1e-11);
  CHECK_TRUE(misfitOf({1.3, 20, 7, 0.0}) < 1e-11);
}

// What is left of 9 millistrain: the moments beyond the second.
TEST(FitModel, OtherPressuresAndMindlinsShearAreDescribedByTheirSecondMoments) {
  CHECK_TRUE(misfitOf({1.3, 20, 0, 2e-3, model::Profile::kUniform}) < 3e-6);
  CHECK_TRUE(misfitOf({1.3, 20, 7, 2e-3}) < 1e-5);
}

TEST(FitModel, SlopesAreDerivativesOfTheReadings) {
  config.contact.friction_coefficient = 0.6;
  const FitModel model(config);
  for (const double tangential : {4.0, -4.0, 20.0}) {
    const FittedContact contact = model.describe({1.3, 20, tangential, 3e-3});
    const Eigen::MatrixX4d slopes = model.slopes(contact);
    const std::array<double, 4> steps{1e-5, 1e-3, 1e-3, 1e-6};
    for (std::size_t i = 0; i < 4; ++i) {
      const auto readingsAt = [&](double step) {
        FittedContact moved = contact;
        double* const members[] = {&moved.angle_rad, &moved.load.normal_n_per_m,
                                   &moved.load.tangential_n_per_m, &moved.load.moment_rad2};
        *members[i] += step;
        return model.readings({&moved, 1});
      };
      const Eigen::VectorXd rise = (readingsAt(steps[i]) - readingsAt(-steps[i])) / (2 * steps[i]);
      const Eigen::VectorXd slope = slopes.col(static_cast<Eigen::Index>(i));
      DOUBLES_EQUAL(0, (rise - slope).norm() / slope.norm(), 1e-5);
    }
  }
}

TEST(FitModel, KnowsWhatCalibrationFound) {
  config.calibration.gain.assign(16, 1.1);
  config.calibration.angle_offset_deg.assign(16, 0.7);
  config.calibration.depth_offset_m.assign(16, 1e-4);
  CHECK_TRUE(misfitOf({1.3, 20, 4, 0.0}) < 1e-11);
  config.as_built.gain = 0.01;  // now calibration is no more than what the firmware was told
  CHECK_TRUE(misfitOf({1.3, 20, 4, 0.0}) > 1e-4);
}

TEST(FitModel, ATouchThatDoesntSayHowWideItIsHasTheWidthThatIsKnown) {
  config.contact.width_m = 2e-3;
  CHECK_TRUE(misfitOf({1.3, 20, 0}) < 3e-6);
}

// sigma_w = 6 sigma_m / w, by w^2 = 12 m.
TEST(FitModel, WidthsAreOfTheUniformPressure) {
  const FitModel model(config);
  const double moment = model.describe({0, 20, 0, 3e-3, model::Profile::kUniform}).load.moment_rad2;
  DOUBLES_EQUAL(3e-3, model.uniformWidth_m(moment), 1e-15);
  const double sigma = 1e-4 * moment;
  DOUBLES_EQUAL((model.uniformWidth_m(moment + sigma) - model.uniformWidth_m(moment - sigma)) / 2,
                model.uniformWidthSigma_m(moment, sigma), 1e-12);
  DOUBLES_EQUAL(3e-3 * std::sqrt(0.75),
                model.uniformWidth_m(model.describe({0, 20, 0, 3e-3}).load.moment_rad2), 1e-15);
}
