#include "host/session/assessment.hpp"

#include <algorithm>
#include <cmath>

#include "host/calibration/expected_error.hpp"
#include "host/study/calibration_session.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::session;

namespace {

constexpr std::uint64_t kAssessedSeed = 4;
constexpr int kAssessedTouches = 80;

struct Assessed {
  study::Session touches =
      study::sessionOf(study::randomFinger(kAssessedSeed), {.touches = kAssessedTouches}, kAssessedSeed);
  calibration::CalibrationResult result =
      calibration::calibrate(touches.finger, touches.known, touches.readings);
  Assessment assessment = assess(result, {});
};

const Assessed& assessed() {
  static const Assessed once;
  return once;
}

}  // namespace

TEST_GROUP(Assessment) {};

TEST(Assessment, SigmasAreTheCalibrations) {
  const auto& [touches, result, assessment] = assessed();
  LONGS_EQUAL(16, assessment.gauges.size());
  DOUBLES_EQUAL(result.gain(3).sigma, assessment.gauges[3].gain, 0);
  DOUBLES_EQUAL(result.depthOffset_m(3).sigma, assessment.gauges[3].depth_m, 0);
}

// Gains that are all larger and a modulus that is, by as much, read the same of the same loads.
TEST(Assessment, TheUnitOfForceIsTheErrorThatLoadsShare) {
  const calibration::Drawing drawing{config::FingerConfig{}};
  const config::Tolerance& tolerance = drawing.config().tolerance;
  const auto unitOf = [&](double gain, double modulus) {
    Eigen::VectorXd off = Eigen::VectorXd::Zero(drawing.unknowns());
    for (int gauge = 0; gauge < drawing.gauges(); ++gauge)
      off[calibration::Drawing::at(gauge, calibration::kGain)] = gain / tolerance.gain;
    off[drawing.at(calibration::kShearModulus)] = modulus / tolerance.shear_modulus;
    const Eigen::MatrixXd known = 1e-10 * Eigen::MatrixXd::Identity(drawing.unknowns(), drawing.unknowns());
    const calibration::CalibrationResult result(drawing, Eigen::VectorXd::Zero(drawing.unknowns()),
                                                known + off * off.transpose(), {}, {0, 0}, true);
    return assess(result, {}).unitOfForce;
  };
  DOUBLES_EQUAL(0.01, unitOf(0, 0.01), 1e-4);
  DOUBLES_EQUAL(0.01, unitOf(0.01, 0), 1e-4);
  DOUBLES_EQUAL(0, unitOf(0.01, 0.01), 1e-4);
}

// With the zero of the angle and the unit of force the errors are those of the report, which are larger.
TEST(Assessment, ErrorsToComeAreThoseOfTheReportButForTheConventions) {
  const auto& [touches, result, assessment] = assessed();
  const auto errors = calibration::expectedErrors(result);
  for (int i = 0; i < 3; ++i) {
    DOUBLES_EQUAL(errors.bound[i], assessment.errors.bound[i], 1e-9 * errors.bound[i]);
    DOUBLES_EQUAL(errors.before[i], assessment.errors.drawn[i], 1e-9 * errors.before[i]);
    CHECK_COMPARE(assessment.errors.known[i], <=, 1.0001 * errors.after[i]);
    CHECK_COMPARE(assessment.errors.known[i], >=, errors.bound[i]);
  }
}

// The gain that is promised of a hundred touches all around is about that of a session with a hundred more.
TEST(Assessment, AHundredTouchesMoreGainWhatItSays) {
  const auto& [touches, result, assessment] = assessed();
  const auto more = study::sessionOf(touches.finger, {.touches = kAssessedTouches + 100}, kAssessedSeed);
  const auto later = assess(calibration::calibrate(more.finger, more.known, more.readings), {});
  const auto total = [](const TouchesToCome& errors) {
    return std::sqrt(errors.known.cwiseQuotient(errors.bound).cwiseAbs2().mean());
  };
  const double gained = 1 - total(later.errors) / total(assessment.errors);
  CHECK_COMPARE(assessment.gainAllAround, >, 0.1);
  DOUBLES_EQUAL(gained, assessment.gainAllAround, 0.15);
}

TEST(Assessment, AKnownLoadMoreTellsMoreOfTheUnitOfForce) {
  const auto& assessment = assessed().assessment;
  for (const double sigma : assessment.unitAfterPress) {
    CHECK_COMPARE(sigma, <, assessment.unitOfForce);
    CHECK_COMPARE(sigma, >, 0.5 * assessment.unitOfForce);
  }
}

// Touches on one half of the ring alone: the other half has more to gain.
TEST(Assessment, ArcsThatWereNotTouchedHaveMostToGain) {
  const config::FingerConfig finger = study::randomFinger(kAssessedSeed);
  auto session = study::sessionOf(finger, {.touches = 260}, kAssessedSeed);
  const auto all = calibration::calibrate(finger, session.known, session.readings);
  std::vector<calibration::KnownTouch> known;
  Eigen::MatrixXd readings(session.readings.rows(), 16);
  Eigen::Index kept = 0;
  for (std::size_t i = 0; i < session.known.size(); ++i) {
    const double place = std::remainder(all.rows()[i].touch[calibration::kPlace], 2 * 3.14159265358979);
    if (place > 2.0 && known.size() > 6 && i % 6 != 0) continue;  // 115 to 180 deg: every sixth alone
    readings.row(kept++) = session.readings.row(static_cast<Eigen::Index>(i));
    known.push_back(session.known[i]);
  }
  readings.conservativeResize(kept, Eigen::NoChange);
  const auto assessment = assess(calibration::calibrate(finger, known, readings), {});
  const auto best = std::max_element(assessment.arcGains.begin(), assessment.arcGains.end());
  const double best_deg = 11.25 * static_cast<double>(best - assessment.arcGains.begin());
  CHECK_COMPARE(best_deg, >, 105);
  CHECK_COMPARE(best_deg, <, 190);
}
