// Model -> gauges -> converter -> firmware -> frame -> decoder, and how far what comes out is from the truth.
//
// The budgets are multiples of the Cramer-Rao bound: what no unbiased estimate from all gauges can beat, at
// the config's noise (quantisation by the converter included), plus the quantisation of the frames' fields
// (step^2/12). It comes from the model alone and knows nothing of the firmware.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <numbers>
#include <random>

#include "host/can/loopback_port.hpp"
#include "host/evidence/bound.hpp"
#include "host/simulation/read_scenario.hpp"
#include "host/simulation/simulated_finger.hpp"
#include "host/simulation/touch_errors.hpp"
#include "host/tables/table_builder.hpp"
#include "tests/under_sanitizers.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::simulation;
using firmware::FitMode;

namespace {

constexpr double kDeg = std::numbers::pi / 180;

// Steps of the frames' fields: common/BUS_TOUCHES.md.
constexpr double kAngleStep_rad = 0.01 * kDeg;
constexpr double kForceStep_n = 1e-3;
constexpr double kForceSigmaStep_n = 0.5e-3;

double quantisationVariance(double step) { return step * step / 12; }

/// Angle, normal and tangential load, or their errors.
using Triple = Eigen::Array3d;

class Bound {
 public:
  explicit Bound(const config::FingerConfig& config) : config_(config), model_(config) {}

  /// Least standard deviation of arc [m] and loads [N/m].
  Triple at(const Touch& touch) const {
    const bool isWidthKnown = config_.contact.width_m.has_value();
    const evidence::Parameters sigmas =
        cramerRaoBound(model_, model_.describe(touch),
                       isWidthKnown ? evidence::kWidthKnown : evidence::kWidthUnknown, model_.noise_strain());
    const Triple variance = sigmas.head<3>().array().square();
    return (variance + frameVariance()).sqrt() * unit();
  }

  /// What was reported as the errors, with what the frames' steps do to value and sigma.
  Triple reported(const TouchError& error) const {
    const double length_m = config_.finger.length_m;
    const Triple sigma(error.sigmaArc_m, error.sigmaNormal_n_per_m, error.sigmaTangential_n_per_m);
    const double loadVariance = quantisationVariance(kForceSigmaStep_n / length_m);
    const Triple steps(quantisationVariance(kAngleStep_rad), loadVariance, loadVariance);
    return ((sigma / unit()).square() + frameVariance() + steps).sqrt() * unit();
  }

 private:
  Triple unit() const { return {config_.finger.outer_radius_m, 1, 1}; }
  Triple frameVariance() const {
    const double loadVariance = quantisationVariance(kForceStep_n / config_.finger.length_m);
    return {quantisationVariance(kAngleStep_rad), loadVariance, loadVariance};
  }

  config::FingerConfig config_;
  evidence::FitModel model_;
};

/// Statistics of one run.
struct Result {
  TouchErrors errors;
  std::array<Deviation, 3> overBound;  ///< error / bound
  std::array<Deviation, 3> pull;       ///< error / reported sigma
  int gross = 0;                       ///< certain, and off by more than half a pitch
};

}  // namespace

TEST_GROUP(ClosedLoop) {
  /// Exactly as drawn; every contact is known to be a line.
  const config::FingerConfig config = [] {
    config::FingerConfig perfect;
    perfect.gauges.model_error = 0;
    perfect.contact.width_m = 0;
    return perfect;
  }();
  const Bound bound{config};
  const std::unique_ptr<TableImage> tables = std::make_unique<TableImage>(tables::buildTableImage(config));

  static std::uint64_t seed() {
    const char* given = std::getenv("STRAINFINGER_TEST_SEED");
    const std::uint64_t seed = given != nullptr ? std::strtoull(given, nullptr, 10) : 1;
    UT_PRINT(StringFromFormat("seed %llu (STRAINFINGER_TEST_SEED)", static_cast<unsigned long long>(seed))
                 .asCharString());
    return seed;
  }

  void judge(const ComparedTouch& compared, Result& result) const {
    result.errors.add(compared, config.finger);
    const can::TouchReport& report = compared.report;
    const bool certain = report.flags.has(FingerFlag::kContact) && !report.flags.has(FingerFlag::kUncertain);
    if (!certain || report.quality_percent <= 20 || compared.truth.size() != 1) return;
    const TouchError error = errorOf(report, compared.truth[0], config.finger);
    const double halfPitch_m = std::numbers::pi / config.gauges.count * config.finger.outer_radius_m;
    if (std::fabs(error.arc_m) > halfPitch_m) ++result.gross;
    const Triple errors(error.arc_m, error.normal_n_per_m, error.tangential_n_per_m);
    const Triple overBound = errors / bound.at(compared.truth[0]), pull = errors / bound.reported(error);
    for (int i = 0; i < 3; ++i) {
      result.overBound[static_cast<std::size_t>(i)].add(overBound[i]);
      result.pull[static_cast<std::size_t>(i)].add(pull[i]);
    }
  }

  /// Runs the whole scenario; `isWanted(compared)` chooses the reports that count.
  template <typename Wanted>
  Result run(const Scenario& scenario, FitMode mode, std::uint64_t noiseSeed, Wanted isWanted) const {
    can::LoopbackBus bus;
    can::LoopbackPort port(bus);
    SimulatedFinger finger(config, scenario, *tables, mode, noiseSeed, port);
    Result result;
    while (finger.elapsed_s() < scenario.duration_s())
      finger.pass(1, [&](const Moment& moment) {
        if (moment.compared && isWanted(*moment.compared)) judge(*moment.compared, result);
      });
    print(result);
    return result;
  }
  Result run(const Scenario& scenario, FitMode mode, std::uint64_t noiseSeed) const {
    return run(scenario, mode, noiseSeed, [](const ComparedTouch&) { return true; });
  }

  static void print(const Result& result) {
    const TouchErrors& errors = result.errors;
    const auto& [arc, normal, tangential] = result.overBound;
    UT_PRINT(StringFromFormat(
                 "%d reports, %d uncertain: arc %.4f mm RMS, %.3f worst; normal %.3f N/m RMS, %.2f worst; "
                 "tangential %.3f N/m RMS, %.2f worst",
                 static_cast<int>(errors.arc_m.count()), static_cast<int>(errors.uncertain),
                 errors.arc_m.rms() * 1e3, errors.arc_m.worst() * 1e3, errors.normal_n_per_m.rms(),
                 errors.normal_n_per_m.worst(), errors.tangential_n_per_m.rms(),
                 errors.tangential_n_per_m.worst())
                 .asCharString());
    UT_PRINT(StringFromFormat("over the bound RMS %.3f %.3f %.3f, worst %.1f %.1f %.1f; pull %.3f %.3f %.3f",
                              arc.rms(), normal.rms(), tangential.rms(), arc.worst(), normal.worst(),
                              tangential.worst(), result.pull[0].rms(), result.pull[1].rms(),
                              result.pull[2].rms())
                 .asCharString());
  }

  static void checkWithin(const Result& result, double rmsBudget, double worstBudget) {
    for (const Deviation& each : result.overBound) {
      CHECK_TRUE(each.rms() < rmsBudget);
      CHECK_TRUE(each.worst() < worstBudget);
    }
  }
  static void checkHonest(const Result& result) {
    LONGS_EQUAL(0, result.gross);
    LONGS_EQUAL(0, result.errors.phantom);
    for (const Deviation& pull : result.pull) CHECK_TRUE(pull.rms() > 0.8 && pull.rms() < 1.25);
  }
};

namespace {

constexpr int kTouches = kSanitized ? 500 : 1000;
constexpr double kContact_s = 0.2;  ///< from one touch to the next; half of it untouched

/// Loads from 2 to 50 N/m, every order of magnitude alike, directions within +-45 deg, angles all around.
Scenario randomContacts(std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto between = [&random](double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random);
  };
  std::vector<TouchCourse> touches;
  for (int i = 0; i < kTouches; ++i) {
    const double normal = std::exp(between(std::log(2), std::log(50)));
    const double tangential = normal * std::tan(between(-45 * kDeg, 45 * kDeg));
    const double start_s = 0.2 + i * kContact_s;
    touches.push_back({start_s, start_s + kContact_s / 2, Course({{0, between(0, 360)}}),
                       Course({{0, normal}}), Course({{0, tangential}})});
  }
  return Scenario(std::move(touches));
}

/// The first report of each contact that is certain: one noise each. It is sent because a flag changed. Later
/// ones are sent because they differ from the last, which chooses noise that is large.
class FirstOfEach {
 public:
  bool operator()(const ComparedTouch& compared) {
    if (compared.report.flags.has(FingerFlag::kUncertain)) return false;
    const long contact = std::lround(std::floor((compared.time_s - 0.2) / kContact_s + 1e-6));
    return std::exchange(last_, contact) != contact;
  }

 private:
  long last_ = -1;
};

/// Lighter ones are told with sigmas that are only a guide.
bool isFirm(const ComparedTouch& compared) {
  constexpr double kFirm_n_per_m = 2;
  return std::all_of(compared.truth.begin(), compared.truth.end(),
                     [](const Touch& touch) { return touch.normal_n_per_m >= kFirm_n_per_m; });
}

}  // namespace

// Budgets: RMS 1.15 times the bound. Worst 12 times: over a gauge the strains hardly depend on the angle, and
// the errors there have heavier tails than the bound, which takes them for linear.
TEST(ClosedLoop, RandomContactsAreAtTheBoundAndHonest) {
  const std::uint64_t random = seed();
  const Result result = run(randomContacts(random), FitMode::kRefined, random, FirstOfEach());
  const auto certain = static_cast<int>(result.errors.arc_m.count());
  CHECK(certain <= kTouches &&
        certain > kTouches - kTouches / 100);  // a few are ambiguous as long as they last
  checkWithin(result, 1.15, 12);
  checkHonest(result);
}

// Three readings see less than sixteen: RMS 1.4 times the bound.
TEST(ClosedLoop, ThreeReadingsAreNearTheBoundAndHonest) {
  const std::uint64_t random = seed();
  const Result result = run(randomContacts(random), FitMode::kThreePoint, random, FirstOfEach());
  const auto certain = static_cast<int>(result.errors.arc_m.count());
  CHECK(certain <= kTouches && certain >= kTouches - kTouches / 500);  // one is weak as long as it lasts
  checkWithin(result, 1.4, 15);
  checkHonest(result);
}

TEST(ClosedLoop, TheBuiltInScenarioIsFollowed) {
  const Result result = run(builtInScenario(), FitMode::kRefined, seed(), isFirm);
  CHECK_TRUE(result.errors.arc_m.count() > 3000);
  CHECK_TRUE(result.errors.uncertain < 100);
  checkWithin(result, 1.25, 20);
  checkHonest(result);
}

// In millimetres and newtons per metre, for people: a contact of 20 to 40 N/m.
TEST(ClosedLoop, AFirmTouchIsKnownToHundredthsOfAMillimetre) {
  const Scenario turn(
      {{0.2, 5, Course({{0, 0}, {4.8, 720}}), Course({{0, 20}, {4.8, 40}}), Course({{0, 10}})}});
  const Result result = run(turn, FitMode::kRefined, seed());
  CHECK_TRUE(result.errors.arc_m.count() > 2000);
  CHECK_TRUE(result.errors.uncertain <= 20);  // while the touch begins
  CHECK_TRUE(result.errors.arc_m.rms() < 0.01e-3);
  CHECK_TRUE(result.errors.normal_n_per_m.rms() < 0.1);
  CHECK_TRUE(result.errors.tangential_n_per_m.rms() < 0.1);
}
