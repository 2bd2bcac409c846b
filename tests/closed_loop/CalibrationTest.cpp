// Gauges that differ, calibrated by what they read themselves, against gauges that don't.

#include "host/calibration/calibrate.hpp"

#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <random>
#include <utility>
#include <vector>

#include "host/evidence/accuracy.hpp"
#include "host/evidence/touches.hpp"
#include "host/model/pressure_profile.hpp"
#include "host/simulation/simulated_finger.hpp"
#include "host/study/calibration_session.hpp"
#include "host/tables/gauge_gains.hpp"
#include "host/tables/table_builder.hpp"
#include "tests/closed_loop/stateless_locator.hpp"
#include "tests/doubles/fake_can_port.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::simulation;

namespace {

constexpr std::uint64_t kSeed = 20240912;
constexpr double kNormal_n_per_m = 20;
constexpr double kTangential_n_per_m = 4;

/// Once around the ring in two seconds.
Scenario roundTrip() {
  return Scenario({{0.2, 2.2, Course({{0, 0}, {2, 360}}), Course({{0, kNormal_n_per_m}}),
                    Course({{0, kTangential_n_per_m}})}});
}

struct Errors {
  double angle_deg;
  double normal_n_per_m;
};

/// A finger of gauges as `gauges` says, that works with tables made from `known`.
class Trip {
 public:
  Trip(const config::FingerConfig& gauges, const config::FingerConfig& known, std::uint64_t seed)
      : length_m_(gauges.finger.length_m),
        tables_(std::make_unique<TableImage>(tables::buildTableImage(known))) {
    doubles::FakeCanPort port;
    SimulatedFinger<doubles::FakeCanPort> finger(gauges, roundTrip(), *tables_, firmware::FitMode::kRefined,
                                                 seed, port);
    for (int i = 0; i < 2200; ++i)
      finger.pass(1,
                  [&](const Moment& moment) { keep(moment, finger.readings().strains(known.gauges.count)); });
  }

  /// RMS.
  Errors errors() const {
    Errors sum{};
    for (const ComparedTouch& each : compared_) {
      const Touch& truth = each.truth.front();
      const double turned = each.report.angle_deg - truth.angle_rad * 180 / std::numbers::pi;
      sum.angle_deg += std::pow(std::remainder(turned, 360), 2);
      sum.normal_n_per_m += std::pow(each.report.normal_n / length_m_ - truth.normal_n_per_m, 2);
    }
    const auto count = static_cast<double>(compared_.size());
    return {std::sqrt(sum.angle_deg / count), std::sqrt(sum.normal_n_per_m / count)};
  }

  bool isAllMarked(FingerFlag flag, bool on) const {
    for (const ComparedTouch& each : compared_)
      if (each.report.flags.has(flag) != on) return false;
    return !compared_.empty();
  }

  /// The config with what the readings tell, of some touches that were measured.
  config::FingerConfig calibrated(const config::FingerConfig& config) const {
    constexpr std::size_t kEvery = 8;
    Eigen::MatrixXd readings(static_cast<Eigen::Index>(rows_.size() / kEvery), config.gauges.count);
    std::vector<calibration::KnownTouch> touches;
    for (Eigen::Index i = 0; i < readings.rows(); ++i) {
      readings.row(i) = rows_[kEvery * static_cast<std::size_t>(i)];
      touches.push_back(touches_[kEvery * static_cast<std::size_t>(i)]);
    }
    return calibration::calibrate(config, touches, readings, {.load = 1e-3, .angle_deg = 0.01}).applied();
  }

 private:
  void keep(const Moment& moment, std::span<const std::int32_t> strains) {
    if (moment.compared && !moment.compared->truth.empty()) compared_.push_back(*moment.compared);
    if (moment.truth.empty()) return;
    const Touch& touch = moment.truth.front();
    touches_.push_back(
        {touch.angle_rad * 180 / std::numbers::pi, touch.normal_n_per_m, touch.tangential_n_per_m});
    Eigen::RowVectorXd row(static_cast<Eigen::Index>(strains.size()));
    for (std::size_t i = 0; i < strains.size(); ++i)
      row[static_cast<Eigen::Index>(i)] = std::ldexp(strains[i], -32);
    rows_.push_back(row);
  }

  double length_m_;
  std::unique_ptr<TableImage> tables_;
  std::vector<ComparedTouch> compared_;
  std::vector<calibration::KnownTouch> touches_;
  std::vector<Eigen::RowVectorXd> rows_;
};

/// Touches of up to 3 mm of the finger that `glued` simulates, located one by one with tables from `known`.
evidence::Accuracy located(const config::FingerConfig& glued, const config::FingerConfig& known) {
  constexpr int kLocatedTouches = 200;
  const evidence::TouchedRing ring(glued, kSeed);
  const evidence::TouchDraws draws(glued.gauges, {.load_n_per_m = {5, 40}, .width_m = {0, 3e-3}}, kSeed);
  StatelessLocator locator(known);
  const auto factors =
      tables::correctionFactors(tables::gaugeGains(known, tables::depthFit(known)), glued.gauges.count);
  const auto factor = Eigen::Map<const Eigen::VectorXd>(factors.data(), glued.gauges.count);
  evidence::Accuracy accuracy(std::numbers::pi / glued.gauges.count);
  for (std::uint64_t i = 0; i < kLocatedTouches; ++i) {
    const Touch touch = draws.at(i);
    const auto found = locator.locate(ring.noisy(ring.exact(touch), i).cwiseProduct(factor)).contacts;
    const double width_m = std::sqrt(12 * model::momentOf(touch.profile, *touch.width_m));
    const evidence::Parameters truth{touch.angle_rad, touch.normal_n_per_m, touch.tangential_n_per_m,
                                     width_m};
    if (found.empty())
      accuracy.addMissed();
    else
      accuracy.add(truth, evidence::Parameters::Zero(), found.front());
  }
  return accuracy;
}

}  // namespace

TEST_GROUP(CalibrationLoop) {
  /// Exactly as drawn; every contact is known to be a line.
  const config::FingerConfig nominal_ = [] {
    config::FingerConfig perfect;
    perfect.gauges.model_error = 0;
    perfect.contact.width_m = 0;
    return perfect;
  }();

  /// Gains 5 % off, as an RMS.
  config::FingerConfig scattered() {
    config::FingerConfig config = nominal_;
    std::mt19937_64 random(kSeed);
    std::normal_distribution<double> gain(1, 0.05);
    for (int i = 0; i < config.gauges.count; ++i) config.calibration.gain.push_back(gain(random));
    return config;
  }
};

// Where one gauge has most of the energy, its 5 % are 5 % of the load: 1 N/m, 16 times what noise (0.065 % of
// the peak) makes of it, and 5 % of the 11 deg in which a response ends: 0.5 deg. The tables' corrections are
// rounded to 2^-14, 0.002 % as an RMS, which is nothing beside the noise; chance is 3 % for 1000 reports.
TEST(CalibrationLoop, GaugesThatDifferAreAsGoodAsNominalOnesOnceCalibrated) {
  UT_PRINT("seed 20240912");
  const Trip uncalibrated(scattered(), nominal_, 1);
  const Trip calibrated(scattered(), uncalibrated.calibrated(nominal_), 2);
  const Errors before = uncalibrated.errors(), after = calibrated.errors();
  const Errors ideal = Trip(nominal_, nominal_, 2).errors();
  CHECK(before.angle_deg > 10 * ideal.angle_deg);
  CHECK(before.normal_n_per_m > 10 * ideal.normal_n_per_m);
  CHECK(after.angle_deg < 1.2 * ideal.angle_deg);
  CHECK(after.normal_n_per_m < 1.2 * ideal.normal_n_per_m);
}

// A finger glued by hand, calibrated by touches that nobody measured. Chance of the ratio of errors to their
// sigmas is 5 % for the 200 touches; what they all share, the calibration's own error, is one draw.
TEST(CalibrationLoop, AGluedFingerIsLocatedWithTrueSigmasOnceCalibrated) {
  const config::FingerConfig glued = study::randomFinger(kSeed);
  const auto session = study::sessionOf(glued, {.touches = 100}, kSeed);
  const auto calibrated =
      calibration::calibrate(glued, session.known, session.readings, study::kExactlyKnown).applied();
  const auto before = located(glued, glued), after = located(glued, calibrated);
  const auto overSigma = [&](evidence::Parameter what) { return after.overSigma(what).rms(); };
  std::printf(
      "\narc before %.1f um, after %.1f um; errors over sigma, arc %.2f, normal %.2f, tangential %.2f, "
      "width %.2f\n",
      1e6 * before.errors(evidence::kAngle).rms() * glued.finger.outer_radius_m,
      1e6 * after.errors(evidence::kAngle).rms() * glued.finger.outer_radius_m, overSigma(evidence::kAngle),
      overSigma(evidence::kNormal), overSigma(evidence::kTangential), overSigma(kWidth));
  CHECK_COMPARE(after.errors(evidence::kAngle).rms(), <, 0.15 * before.errors(evidence::kAngle).rms());
  CHECK_COMPARE(after.errors(evidence::kNormal).rms(), <, 0.25 * before.errors(evidence::kNormal).rms());
  for (const auto what : {evidence::kAngle, evidence::kNormal, evidence::kTangential, kWidth}) {
    CHECK_COMPARE(overSigma(what), >, 0.5);
    CHECK_COMPARE(overSigma(what), <, what == kWidth ? 1.5 : 1.2);
  }
  CHECK_COMPARE(calibrated.gauges.model_error, <, 3e-3);
  CHECK_COMPARE(after.flagged(), <=, 20);
}

TEST(CalibrationLoop, OnlyTablesWithoutGainsAreFlagged) {
  CHECK_TRUE(Trip(scattered(), nominal_, 1).isAllMarked(FingerFlag::kUncalibrated, true));
  CHECK_TRUE(Trip(scattered(), scattered(), 1).isAllMarked(FingerFlag::kUncalibrated, false));
}
