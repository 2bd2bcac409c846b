#include <cmath>
#include <numbers>
#include <string>
#include <vector>

#include "host/base/angles.hpp"
#include "host/base/failure.hpp"
#include "host/calibration/calibrate.hpp"
#include "host/calibration/complaints.hpp"
#include "host/calibration/report.hpp"
#include "host/config/read_config.hpp"
#include "host/config/write_config.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::calibration;

TEST_GROUP(CalibrationResult) {
  config::FingerConfig config;

  /// Gauges off by so much, every other one half a degree further, and one with a gain.
  CalibrationResult resultOf(double turn_deg, double gainOfGauge6 = 1) const {
    const Drawing drawing(config, ZeroOfAngle::kKnown);
    Eigen::VectorXd deviations = Eigen::VectorXd::Zero(drawing.unknowns());
    for (int gauge = 0; gauge < drawing.gauges(); ++gauge)
      deviations[Drawing::at(gauge, kAngleOffset)] =
          (turn_deg + (gauge % 2 == 0 ? -0.25 : 0.25)) / config.tolerance.angle_deg;
    deviations[Drawing::at(6, kGain)] = (gainOfGauge6 - 1) / config.tolerance.gain;
    return resultAt(drawing, deviations);
  }
  /// One whose core was found this much larger than drawn, in tolerances.
  CalibrationResult resultWithCore(double tolerances) const {
    const Drawing drawing(config, ZeroOfAngle::kKnown);
    Eigen::VectorXd deviations = Eigen::VectorXd::Zero(drawing.unknowns());
    deviations[drawing.at(kCoreRadius)] = tolerances;
    return resultAt(drawing, deviations);
  }
  static CalibrationResult resultAt(const Drawing& drawing, const Eigen::VectorXd& deviations) {
    const Eigen::MatrixXd covariance =
        1e-4 * Eigen::MatrixXd::Identity(drawing.unknowns(), drawing.unknowns());
    return {drawing, deviations, covariance, {}, {1e-3, 1e-4}, true};
  }
  /// The config is read again, with the gauges where they were found.
  config::FingerConfig readBack(const CalibrationResult& result) const {
    const auto read = config::readConfig(config::writeConfig(result.applied()), "written");
    for (int gauge = 0; gauge < config.gauges.count; ++gauge) {
      const double found_rad =
          config.gauges.angle_rad(gauge) + result.angleOffset_deg(gauge).value * kRadPerDeg;
      DOUBLES_EQUAL(0, std::remainder(read.calibrated(gauge).angle_rad - found_rad, 2 * std::numbers::pi),
                    1e-6);
    }
    return read;
  }
  std::string complaintOf(const CalibrationResult& result) const {
    try {
      requireReadable(result);
    } catch (const Failure& failure) {
      return failure.what();
    }
    return "accepted";
  }
};

TEST(CalibrationResult, ARingThatMarksTurnIsWrittenWhereItIs) {
  const auto result = resultOf(-5);
  const auto read = readBack(result);
  DOUBLES_EQUAL(355, read.gauges.first_angle_deg, 1e-5);
  DOUBLES_EQUAL(-0.25, read.calibration.angle_offset_deg[2], 1e-5);
  STRCMP_CONTAINS(
      "turn the ring by -5.00 deg (counter-clockwise positive): the config has that in "
      "gauges.first_angle_deg",
      textReport(result).c_str());
  STRCMP_EQUAL("accepted", complaintOf(result).c_str());
}

TEST(CalibrationResult, ARingWhoseAnglesAreListedIsTurnedWithItsList) {
  for (int gauge = 0; gauge < 16; ++gauge) config.gauges.angles_deg.push_back(22.5 * gauge + gauge % 3);
  const auto read = readBack(resultOf(60));
  DOUBLES_EQUAL(0, read.gauges.first_angle_deg, 0);
  DOUBLES_EQUAL(60, read.gauges.angles_deg[0], 1e-5);
  DOUBLES_EQUAL(22.5 * 15 + 60 - 360, read.gauges.angles_deg[15], 1e-5);
}

TEST(CalibrationResult, ARingThatIsTurnedByLessStaysAsDrawn) {
  const auto result = resultOf(1);
  DOUBLES_EQUAL(0, readBack(result).gauges.first_angle_deg, 0);
  CHECK_TRUE(textReport(result).find("turn the ring") == std::string::npos);
}

TEST(CalibrationResult, AGaugeThatNoConfigCanHaveIsNamedWithWhatToLookAt) {
  STRCMP_EQUAL(
      "gauge 6 (at 135 deg): gain 0.35; calibration.gain must be 0.5 to 2: look at its joint and its wires",
      complaintOf(resultOf(0, 0.35)).c_str());
}

TEST(CalibrationResult, ACoreThatNoConfigCanHaveIsToldAsSuch) {
  STRCMP_EQUAL("accepted", complaintOf(resultWithCore(1)).c_str());
  const std::string complaint = complaintOf(resultWithCore(100));
  STRCMP_CONTAINS("what was found can't be written as a config: ", complaint.c_str());
  STRCMP_CONTAINS(
      "finger.core_radius_m = 0.0189 must be less than finger.outer_radius_m = 0.0127; look at [finger], ",
      complaint.c_str());
}
