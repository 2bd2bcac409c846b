// Held touches while the gauges drift, from the converter's codes on.
#include <cmath>
#include <cstdlib>
#include <optional>

#include "common/fixed_real.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/pipeline.hpp"
#include "host/simulation/converter.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

constexpr int kSetsPerSecond = 1000;
constexpr int kTenMinutes_s = 600;

/// Strain each gauge drifts by in ten minutes: all alike, one side warmer than the other, each as it likes.
struct Drift {
  double common = 0;
  double gradient = 0;
  double spread = 0;
};

/// An eighth of what 5 N/m give a gauge under them.
constexpr Drift kThermal{.common = 3e-4, .gradient = 1e-4};

/// What each gauge drifts on its own as well can be tried: it isn't told from the touch.
Drift thermalAndOwn() {
  const char* const own_microstrain = std::getenv("STRAINFINGER_TEST_OWN_DRIFT_MICROSTRAIN");
  Drift drift = kThermal;
  if (own_microstrain) drift.spread = std::atof(own_microstrain) * 1e-6;
  return drift;
}

template <int Gauges>
struct Drifting : Utest {
  const config::FingerConfig config = ModelRing::configOf(Gauges);
  const ModelRing ring{config};
  const simulation::Converter converter{config.gauges};
  const double analogNoise = simulation::analogNoise_strain(config.gauges);
  Presses random{Gauges, 1, 501};
  std::vector<double> rates;
  Pipeline pipeline{ring.tables(), FitMode::kRefined};
  double drifted_s = 0;
  std::optional<std::size_t> open;  ///< a gauge that reads the end of its range

  void drift(const Drift& drift) {
    for (int gauge = 0; gauge < Gauges; ++gauge)
      rates.push_back(
          (drift.common + drift.gradient * std::cos(gauge * ring.pitch_rad()) + random.noise(drift.spread)) /
          kTenMinutes_s);
  }

  void step(const std::vector<double>& strains) {
    std::array<std::uint16_t, kMaxGauges> codes{};
    for (std::size_t i = 0; i < strains.size(); ++i)
      codes[i] = converter.codeOf(strains[i] + rates[i] * drifted_s + random.noise(analogNoise));
    if (open) codes[*open] = 0;
    drifted_s += 1.0 / kSetsPerSecond;
    pipeline.process(Codes(codes).first(Gauges));
  }

  /// Mean normal and tangential load over the last second of so many.
  std::pair<double, double> hold(const Press& press, double seconds) {
    const auto strains = ring.strains(press);
    const int sets = static_cast<int>(seconds * kSetsPerSecond);
    double normal = 0, tangential = 0;
    for (int i = 0; i < sets; ++i) {
      step(strains);
      if (i < sets - kSetsPerSecond) continue;
      CHECK_TRUE(pipeline.observation().fit.has_value());
      const Contact contact = estimate(ring.constants(), *pipeline.observation().fit);
      normal += toReal(contact.normal) / kSetsPerSecond;
      tangential += toReal(contact.tangential) / kSetsPerSecond;
    }
    return {normal, tangential};
  }
  void rest(double seconds) {
    for (int i = 0; i < static_cast<int>(seconds * kSetsPerSecond); ++i)
      step(std::vector<double>(Gauges, 0.0));
  }

  /// Ten minutes of a held touch: what it gains in per cent of its load.
  std::pair<double, double> heldFor10Minutes(const Press& press) {
    rest(1);
    const auto first = hold(press, 5);
    const auto last = hold(press, kTenMinutes_s);
    const double normal = 100 * (last.first - first.first) / press.normal;
    const double tangential = 100 * (last.second - first.second) / press.normal;
    std::printf("at %.2f pitches: after ten minutes normal %+.2f %%, tangential %+.2f %% of the load\n",
                press.position_pitch, normal, tangential);
    return {normal, tangential};
  }
  void checkSlowTangential() {
    drift({});
    rest(1);
    double last = 0;
    for (double load = -6; load < 6; load += 0.04) last = hold({7.3, 8, load}, 1).second;
    std::printf("tangential load found %.2f N/m ", last);
    DOUBLES_EQUAL(6, last, 0.5);
  }
};

}  // namespace

TEST_GROUP_BASE(ZeroDrift, Drifting<16>){};
TEST_GROUP_BASE(ZeroDriftOfAFineRing, Drifting<24>){};

TEST(ZeroDrift, AHeldTouchKeepsItsLoadOverTenMinutesOfThermalDrift) {
  drift(thermalAndOwn());
  for (const double position : {3.0, 7.3, 12.5}) {
    const auto [normal, tangential] = heldFor10Minutes({position, 5, 0});
    CHECK(std::abs(normal) < 2);
    CHECK(std::abs(tangential) < 2);
    rest(60);
    CHECK_FALSE(pipeline.observation().fit.has_value());
  }
}

TEST(ZeroDrift, AHeldTouchIsNotEatenWithoutDriftEither) {
  drift({});
  const auto [normal, tangential] = heldFor10Minutes({5.4, 5, 2});
  CHECK(std::abs(normal) < 0.5);
  CHECK(std::abs(tangential) < 0.5);
}

TEST(ZeroDrift, ATouchThatGrowsSlowlyIsFollowed) {
  drift({});
  rest(1);
  double last = 0;
  for (double load = 2; load < 8; load += 0.02) last = hold({5.4, load, 0}, 1).first;
  DOUBLES_EQUAL(8, last, 0.1);
}

TEST(ZeroDrift, UntouchedZerosFollow) {
  drift({.common = 3e-4, .gradient = 1e-4, .spread = 1e-4});
  rest(kTenMinutes_s);
  CHECK_FALSE(pipeline.observation().fit.has_value());
  CHECK(pipeline.zeroTracker().age_sets() <= ZeroTracker::kInterval);
  CHECK(pipeline.zeroTracker().lastChange_q32() > 0);
}

TEST(ZeroDrift, TenMinutesOfTouchMakeTheZeroStale) {
  drift({});
  rest(1);
  hold({5.4, 5, 0}, kTenMinutes_s - 2);
  CHECK_FALSE(pipeline.observation().staleZero);
  hold({5.4, 5, 0}, 3);
  CHECK_TRUE(pipeline.observation().staleZero);
  rest(5);
  CHECK_FALSE(pipeline.observation().staleZero);
}

// What it read before the touch came to rest was the others' prediction: the touch has not changed by what it
// differs.
TEST(ZeroDrift, AGaugeThatComesBackWhileATouchRestsKeepsItsZero) {
  drift({});
  rest(1);
  const std::int32_t before = pipeline.calibration().zero_q15[8];
  open = 8;
  hold({7.3, 5, 0}, 6);
  CHECK_TRUE(contains(pipeline.observation().outOfUse, 8));
  open.reset();
  auto strains = ring.strains({7.3, 5, 0});
  strains[8] *= 1.01;
  for (int i = 0; i < 12 * kSetsPerSecond; ++i) step(strains);
  CHECK_FALSE(contains(pipeline.observation().outOfUse, 8));
  const double moved_codes = std::ldexp(pipeline.calibration().zero_q15[8] - before, -15);
  std::printf("zero moved by %.2f codes ", moved_codes);
  DOUBLES_EQUAL(0, moved_codes, 0.25);
}

TEST(ZeroDriftOfAFineRing, AHeldTouchKeepsItsLoadOverTenMinutesOfThermalDrift) {
  drift(kThermal);
  const auto [normal, tangential] = heldFor10Minutes({7.3, 5, 3});
  CHECK(std::abs(normal) < 2);
  CHECK(std::abs(tangential) < 2);
}

// Zeros would follow a part of the load if only the seven gauges' part of it were taken for the contact's.
TEST(ZeroDriftOfAFineRing, ATangentialLoadThatGrowsSlowlyIsFollowed) { checkSlowTangential(); }
