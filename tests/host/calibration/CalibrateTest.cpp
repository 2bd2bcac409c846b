#include "host/calibration/calibrate.hpp"

#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <string>
#include <vector>

#include "host/base/failure.hpp"
#include "host/simulation/gauge_strains.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::calibration;

namespace {

constexpr std::uint64_t kSeed = 20240911;

/// Gauges of the simulation with gains and zeros of their own: it doesn't know how they are fitted.
struct Ring {
  explicit Ring(const config::FingerConfig& config)
      : strains(config),
        noise_strain(config.gauges.noise_strain),
        gain(Eigen::VectorXd::Ones(config.gauges.count)),
        zero_strain(Eigen::VectorXd::Zero(config.gauges.count)) {}

  void scatter(double gainSpread, double zeroSpread_strain) {
    for (Eigen::Index i = 0; i < gain.size(); ++i) {
      gain[i] = 1 + gainSpread * normal(random);
      zero_strain[i] = zeroSpread_strain * normal(random);
    }
  }

  Eigen::MatrixXd read(const std::vector<KnownTouch>& touches, double noisier = 1) {
    Eigen::MatrixXd readings(static_cast<Eigen::Index>(touches.size()), gain.size());
    for (Eigen::Index row = 0; row < readings.rows(); ++row) {
      const KnownTouch& touch = touches[static_cast<std::size_t>(row)];
      const simulation::Touch pressed{touch.angle_deg * std::numbers::pi / 180, touch.normal_n_per_m,
                                      touch.tangential_n_per_m};
      const auto strain = strains.under(std::span(&pressed, 1));
      for (Eigen::Index i = 0; i < gain.size(); ++i)
        readings(row, i) = gain[i] * strain[static_cast<std::size_t>(i)] + zero_strain[i] +
                           noisier * noise_strain * normal(random);
    }
    return readings;
  }

  std::mt19937_64 random{kSeed};
  std::normal_distribution<double> normal;
  simulation::GaugeStrains strains;
  double noise_strain;
  Eigen::VectorXd gain, zero_strain;
};

/// One touch over each gauge, the load pulling a little.
std::vector<KnownTouch> roundTouches(const config::FingerConfig& config, double normal_n_per_m) {
  std::vector<KnownTouch> touches;
  for (int i = 0; i < config.gauges.count; ++i)
    touches.push_back({config.gauges.angle_deg(i) + 3, normal_n_per_m, 0.2 * normal_n_per_m});
  return touches;
}

std::vector<KnownTouch> withUntouched(std::vector<KnownTouch> touches, int rows) {
  touches.insert(touches.end(), static_cast<std::size_t>(rows), KnownTouch{});
  return touches;
}

}  // namespace

TEST_GROUP(Calibrate) {
  config::FingerConfig config;

  /// RMS over trials and gauges of errors over their sigmas, of gain and of zero.
  std::pair<double, double> errorsInSigmas(const std::vector<KnownTouch>& touches, double noisier) {
    constexpr int kTrials = 60;
    Ring ring(config);
    double gain = 0, zero = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
      ring.scatter(0.05, touches.back().isTouch() ? 0 : 1e-4);
      const auto fit = calibrate(config, touches, ring.read(touches, noisier));
      for (Eigen::Index i = 0; i < ring.gain.size(); ++i) {
        const GaugeCalibration& gauge = fit.gauges[static_cast<std::size_t>(i)];
        gain += std::pow((gauge.gain.value - ring.gain[i]) / gauge.gain.sigma, 2);
        if (gauge.zero_strain)
          zero += std::pow((gauge.zero_strain->value - ring.zero_strain[i]) / gauge.zero_strain->sigma, 2);
      }
    }
    const double count = kTrials * static_cast<double>(config.gauges.count);
    return {std::sqrt(gain / count), std::sqrt(zero / count)};
  }

  std::string complaint(const std::vector<KnownTouch>& touches, const Eigen::MatrixXd& readings) {
    try {
      calibrate(config, touches, readings);
    } catch (const Failure& failure) {
      LONGS_EQUAL(static_cast<int>(ExitCode::kFailure), static_cast<int>(failure.code()));
      return failure.what();
    }
    return "accepted";
  }

  void checkComplaint(const std::vector<KnownTouch>& touches, const Eigen::MatrixXd& readings,
                      const char* part) {
    STRCMP_CONTAINS(part, complaint(touches, readings).c_str());
  }
};

TEST(Calibrate, FindsGainsAndZerosWithoutNoise) {
  UT_PRINT("seed 20240911");
  for (const int count : {12, 16, 32}) {
    config.gauges.count = count;
    config.gauges.first_angle_deg = 33;
    Ring ring(config);
    ring.scatter(0.1, 1e-3);
    const auto touches = withUntouched(roundTouches(config, 20), 2);
    const auto fit = calibrate(config, touches, ring.read(touches, 0));
    for (Eigen::Index i = 0; i < count; ++i) {
      const GaugeCalibration& gauge = fit.gauges[static_cast<std::size_t>(i)];
      DOUBLES_EQUAL(ring.gain[i], gauge.gain.value, 1e-8);  // the simulation's series ends at 1e-9
      DOUBLES_EQUAL(ring.zero_strain[i], gauge.zero_strain->value, 1e-10);
    }
  }
}

TEST(Calibrate, EveryComponentHasItsGains) {
  for (const auto component : {StrainComponent::kHoop, StrainComponent::kShear}) {
    config.gauges.component = component;
    Ring ring(config);
    ring.scatter(0.1, 0);
    const auto touches = roundTouches(config, 20);
    const auto fit = calibrate(config, touches, ring.read(touches, 0));
    for (Eigen::Index i = 0; i < ring.gain.size(); ++i)
      DOUBLES_EQUAL(ring.gain[i], fit.gauges[static_cast<std::size_t>(i)].gain.value, 1e-8);
  }
}

// 960 errors a case: their RMS is known to 2.3 %, so 20 % is far beyond chance.
TEST(Calibrate, SigmasAreTheActualErrors) {
  const auto tared = errorsInSigmas(roundTouches(config, 5), 1);
  DOUBLES_EQUAL(1, tared.first, 0.1);
  const auto zeroed = errorsInSigmas(withUntouched(roundTouches(config, 5), 4), 1);
  DOUBLES_EQUAL(1, zeroed.first, 0.1);
  DOUBLES_EQUAL(1, zeroed.second, 0.1);
}

TEST(Calibrate, MoreNoiseThanTheConfigSaysIsInTheSigmas) {
  DOUBLES_EQUAL(1, errorsInSigmas(roundTouches(config, 20), 8).first, 0.1);
}

TEST(Calibrate, ResidualsAreTheNoiseOverTheUnknowns) {
  Ring ring(config);
  const auto touches = withUntouched(roundTouches(config, 5), 100);
  const auto fit = calibrate(config, touches, ring.read(touches));
  DOUBLES_EQUAL(1, fit.excess, 0.08);  // 1,824 residuals: 1.7 %
  for (const GaugeCalibration& gauge : fit.gauges)
    DOUBLES_EQUAL(ring.noise_strain, gauge.residual_strain, 0.3 * ring.noise_strain);  // 114 each: 6.6 %
}

TEST(Calibrate, AsManyUnknownsAsRowsLeaveNoResidual) {
  const std::vector<KnownTouch> everywhere{{0, 60, 0}};
  config.gauges.noise_strain = 1e-9;
  const auto fit = calibrate(config, everywhere, Ring(config).read(everywhere));
  DOUBLES_EQUAL(1, fit.excess, 0);
  CHECK_FALSE(fit.gauges[0].zero_strain.has_value());
  DOUBLES_EQUAL(0, fit.gauges[0].residual_strain, 0);
}

TEST(Calibrate, AGaugeThatNoTouchTellsIsNamedWithTheTouchThatWould) {
  auto touches = roundTouches(config, 2);
  touches.erase(touches.begin() + 5);
  const std::string said = complaint(touches, Ring(config).read(touches));
  STRCMP_CONTAINS("don't tell the gain to 1 % of gauge 5 (at 112.5 deg): add touches over each",
                  said.c_str());
  const auto load = std::stod(said.substr(said.find("of these, of ") + 13));
  touches.push_back({config.gauges.angle_deg(5), 1.01 * load, 0});
  STRCMP_EQUAL("accepted", complaint(touches, Ring(config).read(touches)).c_str());
}

TEST(Calibrate, ShearGaugesAreTouchedBesideThem) {
  config.gauges.component = StrainComponent::kShear;
  const std::vector<KnownTouch> one{{0, 10, 0}};
  checkComplaint(one, Ring(config).read(one), " deg beside each of these");
}

TEST(Calibrate, UntouchedRowsAloneTellNoGain) {
  const std::vector<KnownTouch> none(10);
  checkComplaint(none, Ring(config).read(none), "of gauge 0 (at 0 deg), 1 (at 22.5 deg), ");
}

TEST(Calibrate, TouchesOfOtherRowsAreRefused) {
  Ring ring(config);
  const auto touches = roundTouches(config, 20);
  auto turned = touches;
  for (KnownTouch& touch : turned) touch.angle_deg = -touch.angle_deg;
  checkComplaint(turned, ring.read(touches), "the touches don't explain the strains: ");
  checkComplaint(turned, ring.read(touches), "gauges.first_angle_deg");
}

TEST(Calibrate, ADeadAndACrossedGaugeAreNamed) {
  const auto touches = roundTouches(config, 20);
  for (const auto& [gain, said] :
       {std::pair{0.0, "gauge 7 has a gain of "}, {-1.0, "gauge 7 has a gain of -"}}) {
    Ring ring(config);
    ring.gain[7] = gain;
    checkComplaint(touches, ring.read(touches), said);
  }
}

TEST(Calibrate, ReadingsAtFullScaleAreNamed) {
  const auto touches = roundTouches(config, 20);
  Eigen::MatrixXd readings = Ring(config).read(touches);
  for (const double beyond : {0.03, -0.03, 1.0, std::numeric_limits<double>::quiet_NaN()}) {
    readings(3, 9) = beyond;
    checkComplaint(touches, readings, "row 4: gauge 9 reads ");
  }
}

TEST(Calibrate, TouchesThatCannotBeAreNamed) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  auto touches = roundTouches(config, 20);
  const Eigen::MatrixXd readings = Ring(config).read(touches);
  for (const auto& [touch, said] :
       {std::pair{KnownTouch{nan, 1, 0}, "touch 3: its angle and loads must be finite"},
        {KnownTouch{0, 1 / 0.0, 0}, "touch 3: its angle"},
        {KnownTouch{0, 1, nan}, "touch 3: its angle"},
        {KnownTouch{0, -1, 0}, "touch 3 pulls: normal_n_per_m = -1 must be positive"},
        {KnownTouch{0, 0, 1}, "touch 3 has tangential_n_per_m = 1 without"}}) {
    touches[2] = touch;
    checkComplaint(touches, readings, said);
  }
}

TEST(Calibrate, RowsPairWithTouchesAndColumnsWithGauges) {
  const auto touches = roundTouches(config, 20);
  const Eigen::MatrixXd readings = Ring(config).read(touches);
  checkComplaint({}, Eigen::MatrixXd(0, 16), "no touches");
  checkComplaint(touches, readings.topRows(15), "15 rows of strains and 16 touches");
  checkComplaint(touches, readings.leftCols(15),
                 "15 strains in a row; there must be one a gauge, gauges.count = 16");
}
