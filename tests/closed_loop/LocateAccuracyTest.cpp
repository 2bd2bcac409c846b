// The bars of the default finger: touches from the elastic model, located by the firmware's code from one set
// of readings each, against the Cramer-Rao bound. A perfect finger, load directions within +-45 degrees;
// widths are those of the uniform pressure with the touch's second moment, as the bus tells them.
//
// The bars are those for any number of touches; touch_count.hpp says what chance may add to them for so many.
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <optional>
#include <span>

#include "host/base/angles.hpp"
#include "host/evidence/bound.hpp"
#include "host/evidence/touches.hpp"
#include "tests/closed_loop/stateless_locator.hpp"
#include "tests/closed_loop/touch_count.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using evidence::kAngle;
using evidence::kNormal;
using evidence::kTangential;
using firmware::FitMode;

namespace {

constexpr double kPeakPerLoad = 460.603e-6;  ///< strain per N/m at the gauge under a normal line load

/// The default finger, exactly as drawn. Noise of this part of the peak under a line load of 30 N/m; 0: the
/// default, 6 microstrain.
config::FingerConfig finger(double relativeNoise = 0) {
  config::FingerConfig config;
  config.gauges.model_error = 0;
  if (relativeNoise > 0) config.gauges.noise_strain = relativeNoise * 30 * kPeakPerLoad;
  return config;
}

config::FingerConfig lineFinger(double relativeNoise = 0) {
  config::FingerConfig config = finger(relativeNoise);
  config.contact.width_m = 0;
  return config;
}

/// Round touches of this load, between these widths of equal uniform pressure [mm].
evidence::TouchRanges touches(double load_n_per_m, double least_mm, double most_mm) {
  const double perUniform = std::sqrt(4.0 / 3);  // moments w^2 / 16 and w^2 / 12
  return {.load_n_per_m = {load_n_per_m, load_n_per_m},
          .width_m = {least_mm * 1e-3 * perUniform, most_mm * 1e-3 * perUniform}};
}
evidence::TouchRanges touches(double load_n_per_m, double width_mm) {
  return touches(load_n_per_m, width_mm, width_mm);
}

class Trial {
 public:
  explicit Trial(const config::FingerConfig& config, FitMode mode = FitMode::kRefined)
      : config_(config), model_(config), locator_(config, mode) {}

  Trial& withoutNoise() {
    isNoisy_ = false;
    return *this;
  }
  /// The shear is that of Mindlin's partial slip, not a semi-ellipse of its second moment.
  Trial& withTrueShear() {
    isTrueShear_ = true;
    return *this;
  }
  /// A gauge that reads nothing and is known not to work.
  Trial& dead(int gauge) {
    dead_ = gauge;
    return *this;
  }

  evidence::Accuracy run(const evidence::TouchRanges& ranges, std::uint64_t seed, int count) {
    const evidence::TouchDraws draws(config_.gauges, ranges, seed);
    const evidence::TouchedRing ring(config_, seed);
    evidence::Accuracy accuracy(std::numbers::pi / config_.gauges.count);
    suspects = several = 0;
    for (int i = 0; i < count; ++i) {
      const simulation::Touch touch = draws.at(static_cast<std::uint64_t>(i));
      const evidence::FittedContact truth = model_.describe(touch);
      const Eigen::VectorXd exact = isTrueShear_ ? ring.exact(touch) : model_.readings({&truth, 1});
      const auto found = locator_.locate(isNoisy_ ? ring.noisy(exact, static_cast<std::uint64_t>(i)) : exact,
                                         dead_ ? firmware::GaugeSet{1} << *dead_ : 0);
      suspects += found.suspect != 0;
      several += found.several;
      if (found.contacts.empty()) {
        accuracy.addMissed();
        continue;
      }
      accuracy.add(inWidths(truth.parameters()), boundOf(truth), found.contacts.front());
    }
    print(ranges, seed, accuracy);
    return accuracy;
  }

  int suspects = 0;  ///< touches that speak against a gauge
  int several = 0;   ///< touches that are taken for two

 private:
  evidence::Parameters inWidths(evidence::Parameters parameters) const {
    parameters[kWidth] = model_.uniformWidth_m(parameters[evidence::kMoment]);
    return parameters;
  }
  evidence::Parameters boundOf(const evidence::FittedContact& truth) const {
    const bool known = config_.contact.width_m.has_value();
    const std::span<const int> leftOut(dead_ ? &*dead_ : nullptr, dead_ ? 1 : 0);
    evidence::Parameters bound =
        evidence::cramerRaoBound(model_, truth, known ? evidence::kWidthKnown : evidence::kWidthUnknown,
                                 model_.noise_strain(), leftOut);
    bound[kWidth] = model_.uniformWidthSigma_m(truth.load.moment_rad2, bound[evidence::kMoment]);
    return bound;
  }
  void print(const evidence::TouchRanges& ranges, std::uint64_t seed,
             const evidence::Accuracy& accuracy) const {
    const auto& bound = [&](evidence::Parameter p) { return accuracy.overBound(p).rms(); };
    const auto& sigma = [&](evidence::Parameter p) { return accuracy.overSigma(p).rms(); };
    std::printf(
        "\n%d touches of %g N/m, %.2f to %.2f mm, seed %d: missed %d, flagged %d, gross %d, silent %d, "
        "beyond "
        "six sigma %d, suspects %d, several %d; arc %.2f um, worst %.2f; over bound %.3f %.3f %.3f %.3f, "
        "over "
        "sigma %.3f %.3f %.3f %.3f; width off by %+.2f um ",
        accuracy.touches(), ranges.load_n_per_m.least, ranges.width_m.least * 1e3 * std::sqrt(0.75),
        ranges.width_m.most * 1e3 * std::sqrt(0.75), static_cast<int>(seed), accuracy.missed(),
        accuracy.flagged(), accuracy.gross(), accuracy.silent(), accuracy.overconfident(), suspects, several,
        arc_um(accuracy.errors(kAngle).rms()), arc_um(accuracy.errors(kAngle).worst()), bound(kAngle),
        bound(kNormal), bound(kTangential), bound(kWidth), sigma(kAngle), sigma(kNormal), sigma(kTangential),
        sigma(kWidth), accuracy.errors(kWidth).mean() * 1e6);
    std::fflush(stdout);
  }
  double arc_um(double angle_rad) const { return angle_rad * config_.finger.outer_radius_m * 1e6; }

  config::FingerConfig config_;
  evidence::FitModel model_;
  StatelessLocator locator_;
  bool isNoisy_ = true;
  bool isTrueShear_ = false;
  std::optional<int> dead_;
};

/// Two contacts at once, both to be found.
struct Pairs {
  int count = 0;
  int located = 0;  ///< both within half a pitch
  int silent = 0;   ///< not both located, and not told: neither uncertain nor several contacts of one place
  int flagged = 0;
  evidence::Errors overBound;  ///< arcs of both, where both are located and nothing is flagged
};

/// 30 N/m, and another 1 to 4 times lighter so many pitches away; each of a width up to 3 mm.
Pairs locatePairs(double apart_pitch, std::uint64_t seed, int count) {
  const config::FingerConfig config = finger();
  const double pitch_rad = 2 * std::numbers::pi / config.gauges.count;
  const evidence::FitModel model(config);
  const evidence::TouchedRing ring(config, seed);
  const evidence::TouchDraws first(config.gauges, touches(30, 0, 3), seed);
  evidence::TouchRanges lighter = touches(30, 0, 3);
  lighter.load_n_per_m.least /= 4;
  const evidence::TouchDraws second(config.gauges, lighter, seed + 1);
  StatelessLocator locator(config);
  Pairs pairs;
  for (; pairs.count < count; ++pairs.count) {
    const auto number = static_cast<std::uint64_t>(pairs.count);
    simulation::Touch other = second.at(number);
    other.angle_rad = first.at(number).angle_rad + apart_pitch * pitch_rad;
    const std::array truth{model.describe(first.at(number)), model.describe(other)};
    const auto found = locator.locate(ring.noisy(model.readings(truth), number));
    std::array<double, 2> off_rad{pitch_rad, pitch_rad};
    bool isFlagged = found.several && found.contacts.size() < 2;
    for (const evidence::Answer& answer : found.contacts) {
      isFlagged |= answer.isFlagged;
      for (std::size_t i = 0; i < truth.size(); ++i) {
        const double each_rad = shortWay_rad(answer.values[kAngle], truth[i].angle_rad);
        if (std::abs(each_rad) < std::abs(off_rad[i])) off_rad[i] = each_rad;
      }
    }
    const bool located = found.contacts.size() == 2 && std::abs(off_rad[0]) <= pitch_rad / 2 &&
                         std::abs(off_rad[1]) <= pitch_rad / 2;
    pairs.located += located;
    pairs.silent += !located && !isFlagged;
    pairs.flagged += isFlagged;
    if (!located || isFlagged) continue;
    const auto bounds = cramerRaoBound(model, truth, evidence::kWidthUnknown, model.noise_strain());
    for (std::size_t i = 0; i < truth.size(); ++i) pairs.overBound.add(off_rad[i] / bounds[i][kAngle]);
  }
  std::printf(
      "\n%d pairs %g pitches apart, seed %d: located %d, silent %d, flagged %d; arcs over bound %.3f, median "
      "%.3f ",
      pairs.count, apart_pitch, static_cast<int>(seed), pairs.located, pairs.silent, pairs.flagged,
      pairs.overBound.rms(), pairs.overBound.quantile(0.5));
  std::fflush(stdout);
  return pairs;
}

}  // namespace

TEST_GROUP(LocateAccuracy) {
  static double arc_um(double angle_rad) { return angle_rad * 12.7e3; }

  static void checkBound(
      double bar, const evidence::Accuracy& accuracy,
      std::initializer_list<evidence::Parameter> parameters = {kAngle, kNormal, kTangential}) {
    for (const auto parameter : parameters)
      CHECK_COMPARE(accuracy.overBound(parameter).rms(), <=, allowed(bar, accuracy.touches()));
  }
  static void checkHonest(
      const evidence::Accuracy& accuracy,
      std::initializer_list<evidence::Parameter> parameters = {kAngle, kNormal, kTangential}) {
    for (const auto parameter : parameters) {
      const evidence::Errors& errors = accuracy.overSigma(parameter);
      CHECK_COMPARE(errors.rms(), <=, allowed(1.1, errors.count()));
      CHECK_COMPARE(errors.rms(), >=, 0.9 * (1 - 3 / std::sqrt(2.0 * errors.count())));
    }
  }
  static void checkNoGrossError(const evidence::Accuracy& accuracy) {
    LONGS_EQUAL(0, accuracy.gross());
    LONGS_EQUAL(0, accuracy.missed());
  }
  /// What is left of a wrong place at much noise: some are, and hardly any says nothing of it.
  static void checkRarelyWrong(double gross, const evidence::Accuracy& accuracy) {
    const int count = accuracy.touches();
    CHECK_COMPARE(accuracy.gross(), <=, allowedCount(gross, count));
    CHECK_COMPARE(accuracy.silent(), <=, allowedCount(1e-4, count));
    LONGS_EQUAL(0, accuracy.missed());
  }
};

TEST(LocateAccuracy, ATouchOfUnknownWidthIsAtTheBound) {
  Trial trial(finger());
  for (const double width_mm : {0.5, 1.0, 2.0, 3.0}) {
    const auto result = trial.run(touches(30, width_mm), 201, touchCount(2000));
    checkNoGrossError(result);
    checkBound(1.03, result);
    checkBound(1.08, result, {kWidth});
    const double bias = std::abs(result.errors(kWidth).mean());
    if (width_mm >= 1) CHECK_COMPARE(bias, <=, 0.02e-3 * width_mm);
  }
}

TEST(LocateAccuracy, AWideTouchIsNearTheBound) {
  Trial trial(finger());
  for (const double width_mm : {4.0, 5.0, 6.0}) {
    const auto result = trial.run(touches(30, width_mm), 202, touchCount(2000));
    checkNoGrossError(result);
    checkBound(1.08, result, {kAngle, kNormal, kTangential, kWidth});
    CHECK_COMPARE(std::abs(result.errors(kWidth).mean()), <=, 0.02e-3 * width_mm);
  }
}

TEST(LocateAccuracy, ReportedErrorsOfWideTouchesAreTrue) {
  Trial trial(finger());
  for (const double load : {30.0, 60.0})
    for (const double width_mm : {1.0, 2.0, 3.0, 4.0, 5.0, 6.0})
      checkHonest(trial.run(touches(load, width_mm), 203, touchCount(1000)),
                  {kAngle, kNormal, kTangential, kWidth});
}

TEST(LocateAccuracy, ReportedErrorsOfLightTouchesAreTrue) {
  Trial trial(finger());
  for (const double width_mm : {1.0, 1.5, 2.0})
    checkHonest(trial.run(touches(5, width_mm), 204, touchCount(2000)),
                {kAngle, kNormal, kTangential, kWidth});
}

TEST(LocateAccuracy, NoWidthIsGrosslyWrongAtAThousandthOfNoise) {
  Trial trial(finger(1e-3));
  checkNoGrossError(trial.run(touches(30, 0, 7), 205, touchCount(10'000)));
  LONGS_EQUAL(0, trial.suspects);
}

// Of two places that noise hardly tells apart, the likelier is not always right.
TEST(LocateAccuracy, WidthsAtAHundredthOfNoiseAreRarelyWrongAndHardlyEverSilently) {
  checkRarelyWrong(0.008, Trial(finger(1e-2)).run(touches(30, 0.5, 4), 206, touchCount(10'000)));
}

TEST(LocateAccuracy, WidthsOfTwoNewtonsAreRarelyWrongAndHardlyEverSilently) {
  checkRarelyWrong(0.008, Trial(finger()).run(touches(2, 0.5, 4), 207, touchCount(10'000)));
}

// The second moment stands for all of the shear's distribution: what else it has is not noise but a bias.
TEST(LocateAccuracy, MindlinsShearUnderAHertzContactHardlyMovesIt) {
  constexpr double kUniformPerHertz = 0.75;  // of the widths' squares with one second moment
  Trial trial(finger());
  trial.withTrueShear().withoutNoise();
  for (const auto& [width_mm, bar_um] : {std::pair{2.0, 3.0}, {3.0, 10.0}}) {
    const auto result = trial.run(touches(30, width_mm * std::sqrt(kUniformPerHertz)), 208, touchCount(2000));
    checkNoGrossError(result);
    CHECK_COMPARE(arc_um(result.errors(kAngle).rms()), <=, bar_um);
  }
}

TEST(LocateAccuracy, ALineIsAtTheBound) {
  const auto result = Trial(lineFinger(1e-3)).run(touches(30, 0), 209, touchCount(10'000));
  checkNoGrossError(result);
  checkBound(1.03, result);
  checkHonest(result);
}

TEST(LocateAccuracy, ALineWithoutNoiseIsWithinAMicrometre) {
  for (const double load : {6.0, 30.0, 60.0}) {
    const auto result = Trial(lineFinger()).withoutNoise().run(touches(load, 0), 210, touchCount(3000));
    checkNoGrossError(result);
    CHECK_COMPARE(arc_um(result.errors(kAngle).rms()), <=, 1);
    CHECK_COMPARE(arc_um(result.errors(kAngle).worst()), <=, 5);
  }
}

TEST(LocateAccuracy, ALineAtAHundredthOfNoiseIsRarelyWrongAndHardlyEverSilently) {
  checkRarelyWrong(0.005, Trial(lineFinger(1e-2)).run(touches(30, 0), 211, touchCount(10'000)));
}

TEST(LocateAccuracy, ALightLineIsHardlyEverSilentlyWrong) {
  for (const double load : {1.0, 2.0, 3.0, 5.0})
    checkRarelyWrong(0.02, Trial(lineFinger()).run(touches(load, 0), 212, touchCount(3000)));
}

TEST(LocateAccuracy, TwentyFourGaugesAtAHundredthOfNoiseAreAtTheBound) {
  config::FingerConfig config = lineFinger(1e-2);
  config.gauges.count = 24;
  const auto result = Trial(config).run(touches(30, 0), 213, touchCount(5000));
  checkNoGrossError(result);
  checkBound(1.05, result);
  checkHonest(result);
}

TEST(LocateAccuracy, ADeadGaugeThatIsKnownCostsWhatItsReadingIsWorth) {
  const auto result = Trial(lineFinger()).dead(5).run(touches(30, 0), 214, touchCount(5000));
  checkNoGrossError(result);
  checkBound(1.1, result);
}

TEST(LocateAccuracy, ThreeReadingsAreWithinTwiceTheBound) {
  const auto result =
      Trial(lineFinger(1e-3), FitMode::kThreePoint).run(touches(30, 0), 215, touchCount(5000));
  checkNoGrossError(result);
  checkBound(2, result);
  checkHonest(result);
}

TEST(LocateAccuracy, ALightLineIsHardlyEverSilentlyWrongByThreeReadings) {
  for (const double load : {2.0, 3.0, 5.0, 8.0})
    checkRarelyWrong(0.02,
                     Trial(lineFinger(), FitMode::kThreePoint).run(touches(load, 0), 216, touchCount(3000)));
}

// Of few pairs, another two of other widths and places explain the readings as well: these are flagged, and
// the bound, which knows only what is near the truth, says nothing of them.
TEST(LocateAccuracy, TwoContactsFourPitchesApartAreNearTheBound) {
  for (const double apart_pitch : {4.0, 5.5, 7.0}) {
    const Pairs pairs = locatePairs(apart_pitch, 217, touchCount(500));
    LONGS_EQUAL(pairs.count, pairs.located);
    CHECK_COMPARE(pairs.flagged, <=, allowedCount(0.02, pairs.count));
    CHECK_COMPARE(pairs.overBound.rms(), <=, allowed(1.1, pairs.overBound.count()));
  }
}

TEST(LocateAccuracy, TwoContactsTwoAndAHalfPitchesApartAreLocated) {
  const Pairs pairs = locatePairs(2.5, 218, touchCount(1000));
  CHECK_COMPARE(pairs.located, >=, 0.95 * pairs.count);
  CHECK_COMPARE(pairs.silent, <=, allowedCount(0.001, pairs.count));
}
