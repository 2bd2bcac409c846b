#include "host/calibration/noise_found.hpp"

#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "host/calibration/findings.hpp"
#include "host/calibration/report.hpp"
#include "host/study/calibration_session.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::calibration;

TEST_GROUP(NoiseFound) {
  static constexpr std::uint64_t kSeed = 11;
  static constexpr int kTouches = 80, kUntouched = 12;
  std::mt19937_64 random{20261128};
  std::normal_distribution<double> normal;
  study::Session session = study::sessionOf(study::randomFinger(kSeed), {.touches = kTouches}, kSeed);

  void setup() override {
    session.readings.conservativeResize(kTouches + kUntouched, Eigen::NoChange);
    session.readings.bottomRows(kUntouched).setZero();
    addNoise(session.readings.bottomRows(kUntouched), 1);
    session.known.resize(kTouches + kUntouched, {std::nullopt, 0, 0});
  }
  /// Of so many times the config's.
  void addNoise(Eigen::Ref<Eigen::MatrixXd> readings, double times) {
    const double noise_strain = session.finger.gauges.noise_strain;
    readings =
        readings.unaryExpr([&](double strain) { return strain + times * noise_strain * normal(random); });
  }
  CalibrationResult result() const { return calibrate(session.finger, session.known, session.readings); }

  /// Of untouched rows alone, with these residuals.
  CalibrationResult ofResiduals(const Eigen::MatrixXd& residuals, RowUse use) const {
    const Drawing drawing(session.finger);
    std::vector<RowResult> rows(static_cast<std::size_t>(residuals.rows()));
    for (std::size_t row = 0; row < rows.size(); ++row) {
      rows[row].use = use;
      rows[row].residual_strain = residuals.row(static_cast<Eigen::Index>(row));
    }
    const Eigen::Index unknowns = drawing.unknowns();
    return {
        drawing, Eigen::VectorXd::Zero(unknowns), Eigen::MatrixXd::Identity(unknowns, unknowns), rows, {0, 0},
        true};
  }
};

TEST(NoiseFound, IsNoneOfAHealthyFinger) { STRCMP_EQUAL("", noiseText(result()).c_str()); }

// Full scale in the config is 1.5 times the amplifier's.
TEST(NoiseFound, StrainsThatAreTooSmallAreToldByTheirNoise) {
  session.readings /= 1.5;
  const auto found = result();
  CHECK_TRUE(noiseFound(found).has_value());
  DOUBLES_EQUAL(1 / 1.5, noiseFound(found)->ratio, 0.05);
  STRCMP_CONTAINS("times quieter than gauges.noise_strain = 6e-06: check gauges.full_scale_strain and",
                  textReport(found).c_str());
}

TEST(NoiseFound, StrainsThatAreTooLargeAreToldByTheirNoise) {
  session.readings *= 2;
  STRCMP_CONTAINS("Readings of untouched rows are 2", noiseText(result()).c_str());
}

TEST(NoiseFound, NoiseOfTwiceTheConfigsIsNoDriftOfZeros) {
  addNoise(session.readings, std::sqrt(3.0));
  const auto found = result();
  DOUBLES_EQUAL(2, noiseFound(found)->ratio, 0.3);
  const std::string report = textReport(found);
  STRCMP_CONTAINS("times noisier than gauges.noise_strain", report.c_str());
  STRCMP_CONTAINS("known to be untouched, and noisier than gauges.noise_strain has it", report.c_str());
  CHECK_TRUE(report.find("the zeros drifted") == std::string::npos);
}

// Else the residuals of rows that were left out in different rounds would differ by more than noise.
TEST(NoiseFound, RowsThatAreContradictedHaveTheResidualsOfTheFingerThatIsReported) {
  addNoise(session.readings, 2);
  const auto found = result();
  CHECK_COMPARE(found.count(RowUse::kContradicted), >, 5);
  for (int row = kTouches; row < kTouches + kUntouched; ++row)
    for (int gauge = 0; gauge < 16; ++gauge)
      DOUBLES_EQUAL(session.readings(row, gauge) - found.zero_strain(gauge).value,
                    found.rows()[static_cast<std::size_t>(row)].residual_strain[gauge], 1e-9);
}

// As a guided session has them.
TEST(NoiseFound, UntouchedRowsThatAreMeansAreNotTooQuiet) {
  session.readings.bottomRows(kUntouched) /= 7;
  STRCMP_EQUAL("", noiseText(result()).c_str());
}

TEST(NoiseFound, ZerosThatDriftAreNoNoise) {
  Eigen::MatrixXd residuals = Eigen::MatrixXd::Zero(40, 16);
  addNoise(residuals, 1);
  for (int row = 0; row < 40; ++row) residuals.row(row).array() += 5e-6 * row;
  CHECK_FALSE(noiseFound(ofResiduals(residuals, RowUse::kContradicted)).has_value());
  residuals *= 4;
  CHECK_TRUE(noiseFound(ofResiduals(residuals, RowUse::kContradicted)).has_value());
}

// What chance makes of six of them: told is only what is far beyond.
TEST(NoiseFound, FewRowsTellOnlyNoiseThatIsFarOff) {
  for (int draw = 0; draw < 200; ++draw) {
    Eigen::MatrixXd residuals = Eigen::MatrixXd::Zero(6, 16);
    addNoise(residuals, 1);
    CHECK_FALSE(noiseFound(ofResiduals(residuals, RowUse::kUntouched)).has_value());
    residuals *= 3;
    CHECK_TRUE(noiseFound(ofResiduals(residuals, RowUse::kUntouched)).has_value());
  }
}

// A gauge at rest between two codes of the converter reads either: half a step of noise, that nobody has.
TEST(NoiseFound, RoundingAtRestIsNoNoise) {
  session.finger.gauges.noise_strain = 1.01 * session.finger.gauges.quantisation_strain();
  const double step_strain = session.finger.gauges.step_strain();
  Eigen::MatrixXd residuals(40, 16);
  for (Eigen::Index i = 0; i < residuals.size(); ++i)
    residuals(i) = i / 40 < 10 && random() % 2 == 0 ? step_strain : 0;
  CHECK_FALSE(noiseFound(ofResiduals(residuals, RowUse::kUntouched)).has_value());
}

TEST(NoiseFound, AModulusThatAFullScaleOfThreeHalvesMakesIsTold) {
  const Drawing drawing(session.finger);
  Eigen::VectorXd deviations = Eigen::VectorXd::Zero(drawing.unknowns());
  deviations[drawing.at(kShearModulus)] = std::log(1.5) / session.finger.tolerance.shear_modulus;
  const Eigen::MatrixXd covariance = Eigen::MatrixXd::Identity(deviations.size(), deviations.size());
  const auto sentences = whatIsFarOff({drawing, deviations, covariance, {}, {0, 0}, true});
  LONGS_EQUAL(1, sentences.size());
  STRCMP_CONTAINS("2.0 tolerances off the drawing: check finger.length_m, the known loads, gauges.full_scale",
                  sentences.front().c_str());
}
