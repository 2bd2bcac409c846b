// What `shape` says of its own errors, against those it makes: flat contacts solved exactly, sliding by up to
// the law of friction, everywhere on a ring of 32 or 16 gauges, alpha = 0.70, noise 1 % or less of the peak
// strain. Prints the figures of the room's README; those are of STRAINFINGER_TEST_TOUCHES=4000.

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <string>
#include <vector>

#include "host/contact/contact.hpp"
#include "host/contact/contact_field.hpp"
#include "host/shape/shape.hpp"
#include "host/simulation/noise.hpp"
#include "tests/host/shape/rings.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::shape;
using namespace strainfinger::testing;

namespace {

constexpr std::uint64_t kSeed = 12345;
/// 400: 95 % +- 1.1 % (one sigma); more by the environment.
const int kTrials = [] {
  const char* touches = std::getenv("STRAINFINGER_TEST_TOUCHES");
  return touches == nullptr ? 400 : std::atoi(touches);
}();
constexpr double kLoad_n_per_m = 10;
constexpr double kSigmas95 = 1.96;

/// Errors over reported sigmas.
struct Errors {
  std::vector<double> errors, sigmas;

  void add(double error, double sigma) {
    errors.push_back(error);
    sigmas.push_back(sigma);
  }
  static double rootMeanSquare(const std::vector<double>& values) {
    double sum = 0;
    for (const double value : values) sum += value * value;
    return std::sqrt(sum / static_cast<double>(values.size()));
  }
  double rms() const { return rootMeanSquare(errors); }
  double reportedOverActual() const { return rootMeanSquare(sigmas) / rms(); }
  double covered() const {
    double covered = 0;
    for (std::size_t i = 0; i < errors.size(); ++i) covered += std::abs(errors[i]) < kSigmas95 * sigmas[i];
    return covered / static_cast<double>(errors.size());
  }
};

/// A flat contact scaled to kLoad_n_per_m.
class Truth {
 public:
  Truth(const config::FingerConfig& config, double width_m)
      : config_(config), kernel_(config_.finger.annulus()) {
    contact::ContactRequest request;
    request.size.value = width_m;
    tractions_ = contact::solveContact(kernel_, request).tractions;
    tractions_[0].smooth.coefficients *= kLoad_n_per_m / loadOf(0) / kSurface_m;
  }

  /// Moment of the pressure: 0 is its load over r_b, 2 over 0 its second.
  double loadOf(int order) const {
    constexpr int kSteps = 4000;  // x = half sin(u)
    const double half_rad = tractions_[0].patch.half_rad;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
      const double turn = std::numbers::pi * ((i + 0.5) / kSteps - 0.5), x = half_rad * std::sin(turn);
      sum += contact::tractionAt(tractions_, x).pressure_pa * std::pow(x, order) * half_rad * std::cos(turn);
    }
    return sum * std::numbers::pi / kSteps;
  }
  double equivalentWidth_m() const { return kSurface_m * 4 * std::sqrt(loadOf(2) / loadOf(0)); }
  double pressure_pa(double offset_rad) const {
    return contact::tractionAt(tractions_, offset_rad).pressure_pa;
  }

  Eigen::VectorXd strains(double angle_rad, double friction) {
    tractions_[0].friction = friction;
    std::vector<double> angles_rad;
    for (int i = 0; i < config_.gauges.count; ++i)
      angles_rad.push_back(2 * std::numbers::pi * i / config_.gauges.count - angle_rad);
    return contact::computeContactField(kernel_, tractions_, config_.gauges.radius_m, angles_rad,
                                        std::array{model::kErr});
  }

 private:
  config::FingerConfig config_;
  contact::SurfaceKernel kernel_;
  contact::Tractions tractions_;
};

struct Survey {
  /// Width, curvature and pressure of all answers that have them; the loads of those that aren't ambiguous.
  Errors angle, normal, tangential, width, curvature, pressure;
  Errors ambiguousAngle;
  double bound_m = 0;  ///< root mean square of the Cramer-Rao bounds of the width
  int told = 0, classes = 0, withinLimit = 0, ambiguous = 0, inCurvatureBand = 0;
  int far = 0;  ///< more than 5 sigmas off in angle or load, unwarned
};

config::FingerConfig noisyRing(int gauges = 32, double noise = 1e-2) {
  config::FingerConfig config = ringOf(0.7, gauges);
  config.gauges.noise_strain = noise * kLoad_n_per_m * peakStrain(config);
  return config;
}

bool isFar(const Measured& measured, double truth) {
  return std::abs(measured.value - truth) > 5 * measured.sigma;
}

/// The resolved part of the true pressure, against its estimate at a few places.
void addPressure(const ShapeEstimator& estimator, const Shape& shape, const Eigen::VectorXd& strains,
                 const Truth& truth, double angle_rad, Errors& errors) {
  constexpr int kNodes = 60;
  const double half_rad = estimator.pressedHalf_rad(shape), step_rad = 2 * half_rad / kNodes;
  const Touch& where = shape.touch;
  const ResolvedPressure resolved(estimator.model(), where, half_rad, noisyRing().gauges.noise_strain);
  const Eigen::VectorXd nodes =
      Eigen::VectorXd::LinSpaced(kNodes, -half_rad + step_rad / 2, half_rad - step_rad / 2);
  Eigen::VectorXd pressure_pa(kNodes);
  for (int i = 0; i < kNodes; ++i)
    pressure_pa[i] =
        truth.pressure_pa(std::remainder(where.angle_rad + nodes[i] - angle_rad, 2 * std::numbers::pi));
  const Eigen::VectorXd places = Eigen::VectorXd::LinSpaced(7, -0.9 * half_rad, 0.9 * half_rad);
  const Eigen::VectorXd part = resolved.directionsAt(places) * (resolved.directionsAt(nodes).transpose() *
                                                                pressure_pa * step_rad * kSurface_m);
  const PressureEstimate estimate = estimator.pressure(shape, strains, places);
  for (Eigen::Index i = 0; i < places.size(); ++i)
    errors.add(estimate.pressure_pa[i] - part[i], estimate.sigma_pa[i]);
}

/// The width's bound at the truth; TouchFit's tests hold this covariance to one by differences.
double boundOf(const ShapeEstimator& estimator, double angle_rad, double friction, double width_m) {
  const config::FingerConfig config = noisyRing();
  const Touch touch{angle_rad, kLoad_n_per_m, friction * kLoad_n_per_m, momentOfWidth(width_m / kSurface_m)};
  const TouchFit fit = refine(estimator.model(), Profile::kEllipse, ellipseStrains(config, touch),
                              config.gauges.noise_strain, touch);
  return std::sqrt(fit.covariance(3, 3)) * 2 * kSurface_m / std::sqrt(touch.moment_rad2);
}

void addLoads(const Shape& shape, const Touch& truth, Survey& survey) {
  const double off_rad = std::remainder(shape.touch.angle_rad - truth.angle_rad, 2 * std::numbers::pi);
  if (shape.rivalAngle_rad) {
    ++survey.ambiguous;
    survey.ambiguousAngle.add(off_rad, shape.angle_rad.sigma);
    return;
  }
  survey.angle.add(off_rad, shape.angle_rad.sigma);
  survey.normal.add(shape.normal_n_per_m.value - truth.normal_n_per_m, shape.normal_n_per_m.sigma);
  survey.tangential.add(shape.tangential_n_per_m.value - truth.tangential_n_per_m,
                        shape.tangential_n_per_m.sigma);
  survey.far += isFar({off_rad, shape.angle_rad.sigma}, 0) ||
                isFar(shape.normal_n_per_m, truth.normal_n_per_m) ||
                isFar(shape.tangential_n_per_m, truth.tangential_n_per_m);
}

void addWidth(const Shape& shape, double width_m, double curvature_per_m, Survey& survey) {
  survey.classes += shape.profile.has_value();
  survey.withinLimit += shape.widthLimit_m > width_m;
  if (!shape.width_m) return;
  ++survey.told;
  survey.width.add(shape.width_m->value - width_m, shape.width_m->sigma);
  survey.curvature.add(shape.curvature_per_m->value - curvature_per_m, shape.curvature_per_m->sigma);
  const Band& band = *shape.curvatureBand_per_m;
  survey.inCurvatureBand += band.low < curvature_per_m && curvature_per_m < band.high;
}

void print(const config::FingerConfig& config, double width_m, const Survey& survey) {
  std::string line = fmt::format(
      "{} gauges, {:g} mm: told {}, ambiguous {}, far {}, within limit {}, classes {}", config.gauges.count,
      width_m * 1e3, survey.told, survey.ambiguous, survey.far, survey.withinLimit, survey.classes);
  const auto add = [&](const char* name, const Errors& errors) {
    if (!errors.errors.empty())
      line += fmt::format("\n  {}: rms {:.3g}, reported over it {:.2f}, covered {:.3f}", name, errors.rms(),
                          errors.reportedOverActual(), errors.covered());
  };
  add("angle", survey.angle);
  add("ambiguous angle", survey.ambiguousAngle);
  add("normal", survey.normal);
  add("tangential", survey.tangential);
  add("width", survey.width);
  add("curvature", survey.curvature);
  add("pressure", survey.pressure);
  line += fmt::format("\n  width's bound {:.3g}, in the curvature's band {} of {}\n", survey.bound_m,
                      survey.inCurvatureBand, survey.told);
  UT_PRINT(line.c_str());
}

Survey surveyOf(double width_m, const config::FingerConfig& config, bool withPressure) {
  const ShapeEstimator estimator(config);
  const simulation::Noise noise(kSeed);
  Truth truth(config, width_m);
  const double known_m = truth.equivalentWidth_m();
  const double curvature_per_m =
      CurvatureScale(config.finger.annulus()).of(kLoad_n_per_m, known_m / kSurface_m).value_per_m;
  Survey survey;
  std::vector<double> bounds;
  for (std::uint64_t trial = 0; trial < static_cast<std::uint64_t>(kTrials); ++trial) {
    // Weyl sequences: even over the circle and over the friction.
    const double angle_rad =
        2 * std::numbers::pi * std::fmod(0.6180339887498949 * static_cast<double>(trial), 1.0);
    const double friction = 2 * std::fmod(0.7548776662466927 * static_cast<double>(trial), 1.0) - 1;
    Eigen::VectorXd strains = truth.strains(angle_rad, friction);
    for (Eigen::Index i = 0; i < strains.size(); ++i)
      strains[i] += config.gauges.noise_strain * noise.at(trial, static_cast<std::uint32_t>(i));
    const auto shape = estimator.estimate(strains);
    CHECK_TRUE(shape.has_value());
    addLoads(*shape, {angle_rad, kLoad_n_per_m, friction * kLoad_n_per_m, 0}, survey);
    addWidth(*shape, known_m, curvature_per_m, survey);
    if (withPressure && trial % 2 == 0)
      addPressure(estimator, *shape, strains, truth, angle_rad, survey.pressure);
    if (withPressure && trial % 8 == 0) bounds.push_back(boundOf(estimator, angle_rad, friction, known_m));
  }
  if (withPressure) survey.bound_m = Errors::rootMeanSquare(bounds);
  print(config, width_m, survey);
  return survey;
}

void areHonest(const Errors& errors) {
  DOUBLES_EQUAL(1, errors.reportedOverActual(), 0.2);
  DOUBLES_EQUAL(0.95, errors.covered(), 0.02);
}

/// Within three sigmas of what 300 touches tell of 95 %: for rings whose figures are known from longer
/// surveys.
void areNearlyHonest(const Errors& errors) {
  DOUBLES_EQUAL(1, errors.reportedOverActual(), 0.25);
  DOUBLES_EQUAL(0.95, errors.covered(), 0.03);
}

}  // namespace

TEST_GROUP(ShapeStatistics) {};

TEST(ShapeStatistics, FourMillimetresAreMeasuredAsWellAsTheNoiseAllows) {
  const Survey survey = surveyOf(4e-3, noisyRing(), true);
  LONGS_EQUAL(kTrials, survey.told);
  LONGS_EQUAL(0, survey.ambiguous);
  CHECK_TRUE(survey.width.rms() < 1.25 * survey.bound_m);
  CHECK_TRUE(survey.width.rms() > 0.8 * survey.bound_m);  // or the bound is none
  for (const Errors* errors :
       {&survey.angle, &survey.normal, &survey.tangential, &survey.width, &survey.curvature})
    areHonest(*errors);
  DOUBLES_EQUAL(0.95, survey.pressure.covered(), 0.02);
  LONGS_EQUAL(0, survey.classes);
}

TEST(ShapeStatistics, TwoMillimetresHaveAnHonestLimitAndNeverAClass) {
  const Survey survey = surveyOf(2e-3, noisyRing(), true);
  LONGS_EQUAL(0, survey.classes);
  for (const Errors* errors : {&survey.angle, &survey.normal, &survey.tangential}) areHonest(*errors);
  DOUBLES_EQUAL(0.95, 1.0 * survey.withinLimit / kTrials, 0.02);
  DOUBLES_EQUAL(0.95, 1.0 * survey.inCurvatureBand / survey.told, 0.02);
  DOUBLES_EQUAL(0.95, survey.pressure.covered(), 0.02);
  CHECK_TRUE(survey.told > kTrials / 2 && survey.told < kTrials);
}

TEST(ShapeStatistics, AKnifesEdgeHasNoWidth) {
  const Survey survey = surveyOf(0.05e-3, noisyRing(), false);
  CHECK_TRUE(survey.told <= 3 * kTrials / 400);  // 3 sigma, one side: 1 in 740
  for (const Errors* errors : {&survey.angle, &survey.normal, &survey.tangential}) areHonest(*errors);
}

// Between two of 16 gauges a touch may be told from a wider one farther on by so little that the noise
// decides.
TEST(ShapeStatistics, OfSixteenGaugesWhatIsWrongIsWarnedOf) {
  for (const double width_m : {1e-3, 4e-3}) {
    const Survey survey = surveyOf(width_m, noisyRing(16), false);
    CHECK_TRUE(survey.far <= kTrials / 400);  // kRival leaves 1 in 370 of those that have a rival
    LONGS_EQUAL(0, survey.classes);
    CHECK_TRUE(survey.ambiguous < kTrials / 2);
    for (const Errors* errors : {&survey.angle, &survey.normal, &survey.tangential}) areNearlyHonest(*errors);
    CHECK_TRUE(survey.ambiguousAngle.covered() > 0.93);
    CHECK_TRUE(survey.withinLimit > 0.93 * kTrials);
  }
}

TEST(ShapeStatistics, OfLittleNoiseSixteenGaugesTellAllOfThreeMillimetres) {
  const Survey survey = surveyOf(3e-3, noisyRing(16, 1e-3), false);
  LONGS_EQUAL(0, survey.far);
  CHECK_TRUE(survey.told >= kTrials - kTrials / 400);
  for (const Errors* errors :
       {&survey.angle, &survey.normal, &survey.tangential, &survey.width, &survey.curvature})
    areNearlyHonest(*errors);
}
