#include "firmware/core/estimate.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <limits>
#include <utility>

#include "common/fixed_real.hpp"
#include "firmware/core/detect.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {
constexpr double kBoundError = 0.04;
constexpr std::int8_t kUp = 2;
constexpr std::int32_t kWindow = 1 << 26;
constexpr std::int32_t kLargest = std::numeric_limits<std::int32_t>::max();
}  // namespace

TEST_GROUP(Estimate) {
  const ModelRing ring;
  TableConstants constants = ring.constants();
  Fit fit{};

  void setup() override {
    fit.readings = FitMode::kRefined;
    fit.settled = true;
    fit.row = &ring.tables().rows[20];
    fit.information = 1 << 26;
    fit.up = kUp;
    fit.windowEnergy = kWindow;
    fit.deficit = kNoRival;
  }
  /// A third, a fourth .. of the distance to `fit.alternative` and of the answer's own error beyond it.
  void checkCovers(int errors) {
    fit.best = {kOnePitch / 10, 3'000'000, 0};
    fit.alternative = {16 * kOnePitch - kOnePitch / 5, 1'500'000,
                       -600'000};  // 0.3 pitches away, round the wrap
    const std::int32_t deficit = std::exchange(fit.deficit, kNoRival);
    const Contact alone = found();
    fit.deficit = deficit;
    const Contact contact = found();
    const auto covering = [&](double own, double distance) {
      return std::max(own, (distance + own) / errors);
    };
    DOUBLES_EQUAL(covering(toReal(alone.sigmaAngle) * 16, 0.3), toReal(contact.sigmaAngle) * 16, 1e-5);
    DOUBLES_EQUAL(covering(alone.sigmaNormal.raw(), load(1'500'000)), contact.sigmaNormal.raw(), 1);
    DOUBLES_EQUAL(covering(alone.sigmaTangential.raw(), load(600'000)), contact.sigmaTangential.raw(), 1);
    CHECK(contact.sigmaAngle.raw() > alone.sigmaAngle.raw());
    DOUBLES_EQUAL(15.8 / 16, toReal(contact.alternative), 1e-6);
  }

  Contact found() { return estimate(constants, fit); }
  /// `parts`: what is left unexplained, over what noise and rounding explain.
  std::uint8_t qualityOf(double parts) {
    const double noise = constants.noise_variance * std::ldexp(1, constants.noise_variance_exponent);
    const double expected = std::floor(16 * std::ldexp(noise, 2 * (kUp - 16) - 2)) + kWindow / 4096.0;
    fit.unexplained = static_cast<std::int32_t>(std::min<double>(std::round(parts * expected), kLargest));
    return found().quality;
  }
  /// Load of an amplitude by the definition, in LineLoadQ12 steps.
  double load(std::int32_t amplitude) {
    return std::ldexp(static_cast<double>(amplitude) * constants.load_scale,
                      constants.load_exponent + 16 - fit.up);
  }
  static double turnsBetween(double a, double b) { return a - b - std::round(a - b); }

  /// How a reading at an offset (pitches from the contact) changes with position, normal, tangential.
  static Eigen::Vector3d changesAt(const ModelRing& model, const Press& press, double offset) {
    const auto v = model.response(offset);
    const double slope = press.normal * v.normalSlope + press.tangential * v.tangentialSlope;
    return {-slope * model.pitch_rad(), v.normal, v.tangential};
  }
  /// Cramer-Rao bound of readings at the offsets used, and of their outer pair's difference.
  static Eigen::Vector3d boundOf(const ModelRing& model, const Press& press,
                                 const std::vector<double>& offsets, bool outerPair) {
    Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
    const auto add = [&](const Eigen::Vector3d& changes) { information += changes * changes.transpose(); };
    for (const double offset : offsets) add(changesAt(model, press, offset));
    const double middle = (offsets.front() + offsets.back()) / 2;
    if (outerPair)
      add((changesAt(model, press, middle + 4) - changesAt(model, press, middle - 4)) / std::sqrt(2.0));
    return information.inverse().diagonal().cwiseSqrt() * model.noise_strain();
  }
  static Contact contactOf(const ModelRing& model, FitMode mode, const Press& press, Fit& fitted) {
    const auto strains = model.raw(press);
    fitted = locate(model.tables(), mode, strains, gateEnergy(model.constants(), strains));
    return estimate(model.constants(), fitted);
  }
  /// The gauges a fit rests on, as pitches from the contact.
  static std::vector<double> usedBy(const ModelRing& model, const Fit& fitted, const Press& press) {
    const double offset = model.between(fitted.centre, std::ldexp(fitted.best.position, -kPitchBits));
    const double middle = model.between(press.position_pitch, fitted.centre);
    std::vector<int> gauges{-3, -2, -1, 0, 1, 2, 3};
    if (fitted.readings == FitMode::kThreePoint) {
      const auto& triple = kTripleList[fitted.triple];
      gauges.assign(triple.begin(), triple.end());
    }
    std::vector<double> offsets;
    for (const int gauge : gauges) offsets.push_back(middle + (offset < 0 ? -gauge : gauge));
    return offsets;
  }
  static void checkAgainstBound(const ModelRing& model, FitMode mode, const Press& press, double tolerance) {
    Fit fitted;
    const Contact contact = contactOf(model, mode, press, fitted);
    const bool outerPair = fitted.readings == FitMode::kRefined && model.gauges() > 16;
    const Eigen::Vector3d bound = boundOf(model, press, usedBy(model, fitted, press), outerPair);
    DOUBLES_EQUAL(1, toReal(contact.sigmaAngle) * model.gauges() / bound[0], tolerance);
    DOUBLES_EQUAL(1, toReal(contact.sigmaNormal) / bound[1], tolerance);
    DOUBLES_EQUAL(1, toReal(contact.sigmaTangential) / bound[2], tolerance);
  }
};

TEST(Estimate, AnglesAreExactToTwoSteps) {
  // The pitch is rounded to 2^-36 of a revolution: 2 steps of 2^-32 at the 32nd gauge.
  std::printf("seed 31 ");
  std::mt19937 random(31);
  for (int gauges = 12; gauges <= 32; gauges += 2) {
    constants.gauge_count = static_cast<std::uint8_t>(gauges);
    constants.pitch_turn_q35 = static_cast<std::uint32_t>(std::llround(std::ldexp(1.0, 35) / gauges));
    for (int i = 0; i < 1000; ++i) {
      constants.first_angle_q32 = static_cast<std::uint32_t>(random());
      fit.best.position =
          static_cast<std::int32_t>(random() % (static_cast<std::uint32_t>(gauges) << kPitchBits));
      if (i == 0) fit.best.position = gauges * kOnePitch - 1;
      const double turns =
          std::ldexp(constants.first_angle_q32, -32) + std::ldexp(fit.best.position, -kPitchBits) / gauges;
      DOUBLES_EQUAL(0, std::ldexp(turnsBetween(toReal(found().angle), turns), 32), 2.5);
    }
  }
}

TEST(Estimate, AnglesCountFromTheFirstGauge) {
  config::FingerConfig config;
  config.gauges.first_angle_deg = 350;
  const ModelRing turned(config);
  Fit fitted;
  const Contact contact = contactOf(turned, FitMode::kRefined, {1, 20, 5}, fitted);
  DOUBLES_EQUAL(12.5, toReal(contact.angle) * 360, 0.02);
}

TEST(Estimate, LoadsAreExactToOneStep) {
  std::printf("seed 32 ");
  std::mt19937 random(32);
  for (int i = 0; i < 20'000; ++i) {
    fit.up = static_cast<std::int8_t>(static_cast<int>(random() % 20) - 2);
    fit.best.normal = static_cast<std::int32_t>(random());
    fit.best.tangential = -fit.best.normal / 3;
    DOUBLES_EQUAL(load(fit.best.normal), found().normal.raw(), 0.5001);
    DOUBLES_EQUAL(load(fit.best.tangential), found().tangential.raw(), 0.5001);
  }
}

TEST(Estimate, HugeLoadsSaturateWithTheirSign) {
  constants.load_exponent = -30 - (16 - fit.up);
  fit.best.normal = kLargest;
  fit.best.tangential = -kLargest;
  CHECK(found().normal == LineLoadQ12::max());
  CHECK(found().tangential == LineLoadQ12::min());
}

TEST(Estimate, TinyLoadsAreNone) {
  constants.load_exponent = -120;
  fit.best.normal = kLargest;
  LONGS_EQUAL(0, found().normal.raw());
}

TEST(Estimate, QualityIsTheExpectedPartOfTheUnexplained) {
  LONGS_EQUAL(100, qualityOf(0));
  LONGS_EQUAL(100, qualityOf(1));
  LONGS_EQUAL(99, qualityOf(1.01));
  LONGS_EQUAL(50, qualityOf(1.99));
  LONGS_EQUAL(0, qualityOf(1e9));
}

TEST(Estimate, QualityOf20AndLessIsUncertain) {
  LONGS_EQUAL(21, qualityOf(4.7));
  CHECK_FALSE(found().uncertain);
  LONGS_EQUAL(20, qualityOf(4.8));
  CHECK_TRUE(found().uncertain);
}

TEST(Estimate, AmbiguousAndUnsettledFitsAreUncertainHoweverWellTheyFit) {
  fit.ambiguous = true;
  LONGS_EQUAL(20, qualityOf(0));
  CHECK_TRUE(found().uncertain && found().ambiguous);
  fit.ambiguous = fit.settled = false;
  LONGS_EQUAL(20, qualityOf(0));
  LONGS_EQUAL(9, qualityOf(10.1));
}

TEST(Estimate, AmbiguousErrorsAreAThirdOfTheDistanceAtLeast) {
  fit.ambiguous = true;
  fit.deficit = 0;
  checkCovers(3);
}

TEST(Estimate, ErrorsReachAnAlternativeInAsManyDeviationsAsNoiseNeedsToMakeItTheBetter) {
  constants.noise_variance_exponent += 10;
  const std::int32_t variances32 = noiseEnergy(constants, kUp);
  CHECK(variances32 >= 32);
  // Below 8 variances there is no second answer: the end of a valley.
  const std::array cases{std::pair{0, 2},  std::pair{7, 2},  std::pair{9, 3}, std::pair{15, 3},
                         std::pair{17, 4}, std::pair{25, 5}, std::pair{32, 5}};
  for (const auto& [variances, errors] : cases) {
    fit.deficit = variances32 * variances / 32;
    checkCovers(errors);
  }
}

TEST(Estimate, AmbiguityDoesNotMakeErrorsSmaller) {
  const TurnQ32 alone = found().sigmaAngle;
  fit.ambiguous = true;
  fit.deficit = 0;
  fit.alternative = fit.best;
  CHECK(found().sigmaAngle == alone);
}

TEST(Estimate, NothingKnownOfTheOffsetIsAPitch) {
  fit.information = 0;
  DOUBLES_EQUAL(1.0 / 16, toReal(found().sigmaAngle), 1e-6);
}

TEST(Estimate, TheErrorOfTheAngleIsAtMostHalfARevolution) {
  static FitRow flat;
  flat = *fit.row;
  flat.gradient_exponent = kLeastGradientExponent;
  fit.row = &flat;
  fit.information = 1;
  fit.up = 30;
  UNSIGNED_LONGS_EQUAL(0x8000'0000u, found().sigmaAngle.raw());
}

TEST(Estimate, AnyFitGivesSomeEstimate) {
  // For the sanitizers: the ends of every format, together.
  static FitRow row;
  row = *fit.row;
  fit.row = &row;
  for (const std::int32_t big : {1 << 29, -(1 << 29), 0, 1})
    for (const int exponent : {kLeastGradientExponent, 0, kMostGradientExponent})
      for (const int up : {-2, 0, 18})
        for (const FitMode mode : {FitMode::kRefined, FitMode::kThreePoint}) {
          fit.best = {16 * kOnePitch - 1, big, -big};
          fit.alternative = {0, -big, big};
          fit.projection = {big, -big};
          fit.information = std::abs(big) / 8;
          row.gradient_exponent = static_cast<std::int8_t>(exponent);
          row.load.fill(static_cast<std::int16_t>(big < 0 ? -32768 : 32767));
          row.load_slope.fill(static_cast<std::int16_t>(big < 0 ? 32767 : -32768));
          fit.up = static_cast<std::int8_t>(up);
          fit.readings = mode;
          fit.ambiguous = up == 0;
          fit.deficit = up == 0 ? 0 : kNoRival;
          const Contact contact = found();
          CHECK(contact.sigmaNormal.raw() >= 0 && contact.sigmaTangential.raw() >= 0);
        }
}

TEST(Estimate, ErrorsAreTheCramerRaoBoundOfTheGaugesUsed) {
  struct Kind {
    int gauges;
    StrainComponent component;
  };
  for (const Kind& kind : {Kind{12, StrainComponent::kRadial}, Kind{16, StrainComponent::kRadial},
                           Kind{32, StrainComponent::kHoop}, Kind{20, StrainComponent::kShear}}) {
    const ModelRing model(ModelRing::configOf(kind.gauges, kind.component));
    for (int step = 0; step < 128; ++step)
      for (const double tangential : {-1.0, -0.6, -0.2, 0.0, 0.2, 0.6, 1.0})
        for (const FitMode mode : {FitMode::kRefined, FitMode::kThreePoint})
          checkAgainstBound(model, mode, {1 + (step + 0.5) / 32, 20, 20 * tangential}, kBoundError);
  }
}
