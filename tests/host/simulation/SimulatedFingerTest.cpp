#include "host/simulation/simulated_finger.hpp"

#include <algorithm>
#include <cmath>
#include <memory>
#include <numbers>

#include "host/base/failure.hpp"
#include "host/simulation/read_scenario.hpp"
#include "host/tables/table_builder.hpp"
#include "tests/doubles/fake_can_port.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::simulation;

namespace {

struct TimedFrame {
  double time_s;
  CanFrame frame;
};

/// A finger, run for a while.
class Bench {
 public:
  Bench(const config::FingerConfig& config, Scenario scenario, std::uint64_t seed = 1)
      : tables_(std::make_unique<TableImage>(tables::buildTableImage(config))),
        finger_(config, std::move(scenario), *tables_, firmware::FitMode::kRefined, seed, port_) {}

  void run(double duration_s) {
    for (int i = 0; i < std::lround(duration_s * 1e3); ++i) step();
  }
  void step(std::uint64_t periods = 1) {
    finger_.pass(periods, [this](const Moment& moment) {
      moments.push_back(moment);
      if (moment.compared) compared.push_back(*moment.compared);
    });
    for (; heard_ < port_.sent.size(); ++heard_) frames.push_back({finger_.elapsed_s(), port_.sent[heard_]});
  }

  std::vector<double> timesOf(std::uint16_t id) const {
    std::vector<double> times;
    for (const TimedFrame& each : frames)
      if (each.frame.id == id) times.push_back(each.time_s);
    return times;
  }
  RunCounts counts() const { return finger_.counts(); }
  doubles::FakeCanPort& port() { return port_; }

  std::vector<TimedFrame> frames;
  std::vector<Moment> moments;
  std::vector<ComparedTouch> compared;

 private:
  std::unique_ptr<TableImage> tables_;
  doubles::FakeCanPort port_;
  SimulatedFinger<doubles::FakeCanPort> finger_;
  std::size_t heard_ = 0;
};

std::vector<double> gaps(const std::vector<double>& times) {
  std::vector<double> result;
  for (std::size_t i = 1; i < times.size(); ++i) result.push_back(times[i] - times[i - 1]);
  return result;
}

}  // namespace

TEST_GROUP(SimulatedFinger) {
  config::FingerConfig config;

  void setup() override { config.gauges.model_error = 0; }

  /// Held still from 0.2 s on.
  static Scenario hold(double angle_deg, double normal = 20, double tangential = 5) {
    return Scenario({{0.2, 100, Course({{0, angle_deg}}), Course({{0, normal}}), Course({{0, tangential}})}});
  }
  /// Slides so fast that every sample set has news.
  static Scenario slide() {
    return Scenario({{0.2, 100, Course({{0, 0}, {100, 36'000}}), Course({{0, 30}}), Course({{0, 5}})}});
  }
  double least(const std::vector<double>& values) { return *std::min_element(values.begin(), values.end()); }
  double most(const std::vector<double>& values) { return *std::max_element(values.begin(), values.end()); }
};

TEST(SimulatedFinger, SaysWhatItIsAtStartAndOnceASecond) {
  Bench bench(config, Scenario({}));
  bench.run(2.5);
  const auto times = bench.timesOf(0x481);
  LONGS_EQUAL(3, times.size());
  DOUBLES_EQUAL(0, times[0], 0.002);
  DOUBLES_EQUAL(1, times[1] - times[0], 0.002);
  const auto frame =
      std::ranges::find(bench.frames, 0x481, [](const TimedFrame& each) { return each.frame.id; });
  LONGS_EQUAL(0x01, frame->frame.data[0]);  // power on, no crash
  LONGS_EQUAL(0, frame->frame.data[7]);     // no board
}

TEST(SimulatedFinger, CountsGoOnOverARestart) {
  Bench bench(config, Scenario({}));
  bench.run(0.5);
  bench.port().deliver(encode(restartRequest(), 1));
  bench.run(0.5);
  LONGS_EQUAL(2, bench.timesOf(0x481).size());  // it says again what it is
  LONGS_EQUAL(1000, bench.counts().finger.sampleSets);
}

// Listeners may still have the touch of before: BUS_TOUCHES.md promises its end.
TEST(SimulatedFinger, RestartedItSaysThatNothingTouchesIt) {
  Bench bench(config, Scenario({}));
  bench.run(0.5);
  LONGS_EQUAL(0, bench.timesOf(0x181).size());
  bench.port().deliver(encode(restartRequest(), 1));
  bench.run(0.5);
  LONGS_EQUAL(1, bench.timesOf(0x181).size());
}

TEST(SimulatedFinger, ReportsTheTouchThatIsThere) {
  Bench bench(config, hold(100));
  bench.run(0.5);
  CHECK_TRUE(bench.compared.size() > 5);
  const ComparedTouch& last = bench.compared.back();
  DOUBLES_EQUAL(100, last.report.angle_deg, 0.5);  // deg; ten times its error at this load
  DOUBLES_EQUAL(20, last.report.normal_n / config.finger.length_m, 0.5);
  DOUBLES_EQUAL(5, last.report.tangential_n / config.finger.length_m, 0.5);
  DOUBLES_EQUAL(100 * std::numbers::pi / 180, last.truth.at(0).angle_rad, 1e-12);
}

TEST(SimulatedFinger, EveryTouchIsMarkedAsSimulated) {
  Bench bench(config, hold(100));
  bench.run(0.5);
  for (const ComparedTouch& each : bench.compared) CHECK_TRUE(each.report.flags.has(FingerFlag::kSimulated));
}

TEST(SimulatedFinger, EverySampleSetIsVisitedOnceWithItsTruth) {
  Bench bench(config, hold(100));
  bench.run(0.3);
  LONGS_EQUAL(300, bench.moments.size());
  DOUBLES_EQUAL(0.3, bench.moments.back().time_s, 1e-9);
  LONGS_EQUAL(0, bench.moments[198].truth.size());
  LONGS_EQUAL(1, bench.moments[200].truth.size());
}

TEST(SimulatedFinger, UntouchedItSaysWhatItIsHowItAndItsGaugesAreAndNothingElse) {
  Bench bench(config, Scenario({}));
  bench.run(5);
  LONGS_EQUAL(60, bench.frames.size());
  LONGS_EQUAL(50, bench.timesOf(0x701).size());
  LONGS_EQUAL(5, bench.timesOf(0x081).size());
  LONGS_EQUAL(5, bench.timesOf(0x481).size());
  LONGS_EQUAL(50, bench.counts().heartbeats);
  LONGS_EQUAL(0, bench.counts().finger.fits);
}

TEST(SimulatedFinger, TheNodeOfTheConfigIsInEveryIdentifier) {
  config.can.node = 63;
  Bench bench(config, hold(100));
  bench.run(0.5);
  for (const TimedFrame& each : bench.frames) LONGS_EQUAL(63, each.frame.id & 0x7F);
  CHECK_FALSE(bench.compared.empty());
}

TEST(SimulatedFinger, NeverReportsFasterThanTheContactRate) {
  for (const double rate_hz : {20.0, 33.3, 100.0, 500.0, 1000.0}) {
    config.can.contact_rate_hz = rate_hz;
    Bench bench(config, slide());
    bench.run(1);
    const auto times = bench.timesOf(0x181);
    CHECK_TRUE(least(gaps(times)) > 1 / rate_hz - 1e-9);
    // 0.8 s of contact; a period is a whole number of sample sets, so at most one longer than asked for.
    CHECK_TRUE(static_cast<double>(times.size()) >= 0.8 / (1 / rate_hz + 1e-3) - 1);
  }
}

TEST(SimulatedFinger, InContactItReportsTwentyTimesASecond) {
  Bench bench(config, hold(100));
  bench.run(3);
  const auto times = bench.timesOf(0x181);
  CHECK_TRUE(most(gaps(times)) < 0.05 + 1e-9);
  CHECK_TRUE(times.back() > 2.95 - 1e-9);
  DOUBLES_EQUAL(0.2, times.front(), 2e-3);
}

TEST(SimulatedFinger, EveryContactHasItsForce) {
  Bench bench(config, builtInScenario());
  bench.run(10);
  LONGS_EQUAL(bench.timesOf(0x181).size(), bench.timesOf(0x281).size());
  LONGS_EQUAL(bench.timesOf(0x181).size(), bench.compared.size());
  LONGS_EQUAL(bench.counts().finger.touchesSent, bench.compared.size());
  LONGS_EQUAL(bench.counts().frames, bench.frames.size());
}

// On a bus it is repeated until Ctrl-C. Ten minutes without a zero, and every touch would be flagged
// stale_zero.
TEST(SimulatedFinger, TheBuiltInScenarioLetsItTakeAZeroBeforeItBeginsAgain) {
  Bench bench(config, builtInScenario());
  bench.run(12);
  std::optional<GaugesFrame> last;
  for (const TimedFrame& each : bench.frames)
    if (const auto gauges = decode<GaugesFrame>(each.frame)) last = gauges;
  CHECK_TRUE(last.has_value());
  CHECK_TRUE(last->zero_age_s < 2);
}

TEST(SimulatedFinger, TheFirstGaugesAngleIsTakenIntoAccount) {
  for (const double first_deg : {0.0, 7.5, 200.0}) {
    config.gauges.first_angle_deg = first_deg;
    Bench bench(config, hold(100));
    bench.run(0.3);
    DOUBLES_EQUAL(100, bench.compared.back().report.angle_deg, 0.5);
  }
}

TEST(SimulatedFinger, TheLengthTurnsLineLoadIntoForce) {
  config.finger.length_m = 0.03;
  Bench bench(config, hold(100));
  bench.run(0.3);
  DOUBLES_EQUAL(20 * 0.03, bench.compared.back().report.normal_n, 0.5 * 0.03);
}

TEST(SimulatedFinger, WhatTheGaugesAreLikeShowsInTheReportedErrors) {
  const auto sigma = [&] {
    Bench bench(config, hold(100));
    bench.run(0.3);
    return bench.compared.back().report.sigmaNormal_n;
  };
  config.gauges.noise_strain = 3e-5;
  const double quiet = sigma();
  config.gauges.noise_strain = 1.2e-4;
  DOUBLES_EQUAL(4, sigma() / quiet, 0.4);  // the fields' steps
}

// 9.2e-3 of strain at the gauge below the touch.
TEST(SimulatedFinger, TheConvertersRangeIsTheConfigs) {
  const auto saturated = [&](double fullScale_strain) {
    config.gauges.full_scale_strain = fullScale_strain;
    Bench bench(config, hold(90));
    bench.run(0.3);
    return bench.compared.back().report.flags.has(FingerFlag::kSaturated);
  };
  CHECK_FALSE(saturated(0.012));
  CHECK_TRUE(saturated(0.006));
}

TEST(SimulatedFinger, TheSeedDecidesEveryFrame) {
  Bench one(config, builtInScenario()), same(config, builtInScenario()), other(config, builtInScenario(), 2);
  for (Bench* bench : {&one, &same, &other}) bench->run(2);
  CHECK_TRUE(one.port().sent == same.port().sent);
  CHECK_FALSE(one.port().sent == other.port().sent);
}

TEST(SimulatedFinger, LateItCatchesUpAndCountsWhatIsLost) {
  Bench bench(config, hold(100));
  bench.step(2);
  LONGS_EQUAL(2, bench.moments.size());
  LONGS_EQUAL(0, bench.counts().overruns);
  bench.step(7);
  LONGS_EQUAL(4, bench.moments.size());
  LONGS_EQUAL(5, bench.counts().overruns);
  DOUBLES_EQUAL(0.009, bench.moments.back().time_s, 1e-9);
}

TEST(SimulatedFinger, ALateForceIsComparedWithTheTruthOfItsContact) {
  Bench bench(config, slide());
  bench.run(0.4);
  const std::size_t before = bench.compared.size();
  while (bench.timesOf(0x181).size() == bench.timesOf(0x281).size()) {
    bench.port().room = 1;
    bench.step();
  }
  bench.port().room = SIZE_MAX;
  const double contact_s = bench.timesOf(0x181).back();
  LONGS_EQUAL(before, bench.compared.size());
  bench.step();
  LONGS_EQUAL(before + 1, bench.compared.size());
  DOUBLES_EQUAL(contact_s, bench.compared.back().time_s, 1e-9);
}

TEST(SimulatedFinger, AScenarioThatTouchesDuringTheZeroIsRefused) {
  for (const double start_s : {0.0, 0.05, 0.0985}) {
    const Scenario early({{start_s, 1, Course({{0, 0}}), Course({{0, 20}}), Course({{0, 0}})}});
    try {
      requireUntouchedStart(early);
      FAIL("not refused");
    } catch (const Failure& failure) {
      CHECK_TRUE(failure.code() == ExitCode::kUsage);
      STRCMP_CONTAINS("start_s be 0.1 or later", failure.what());
    }
  }
  requireUntouchedStart(Scenario({{0.1, 1, Course({{0, 0}}), Course({{0, 20}}), Course({{0, 0}})}}));
}
