// Rows that a scan may leave out, against contacts drawn at random.
#include "host/tables/scan_spans.hpp"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <random>
#include <vector>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {
constexpr double kCone = 1.25;
constexpr double kHalfSpacing_rows = 4,
                 kSlack_rows = 2.5;  ///< what a first step covers; half a row for sampling
}  // namespace

TEST_GROUP(ScanSpans) {
  const model::ImpulseResponse response{{8.9e-3, 12.7e-3, 8.3e4, 0.5}, 9.4e-3, StrainComponent::kRadial};
  std::mt19937_64 random{77};

  struct Drawn {
    double share, fromDeepest_rows, fromNearest_rows;
  };
  Drawn draw(int gauges) {
    std::uniform_real_distribution<double> uniform(0, 1);
    const double position = uniform(random) * gauges, direction = kCone * (2 * uniform(random) - 1);
    double energy = 0, deepest = 0, gaugeOfDeepest = 0;
    for (int gauge = 0; gauge < gauges; ++gauge) {
      const auto value = response.at((gauge - position) * 2 * std::numbers::pi / gauges);
      const double reading = value.normal + direction * value.tangential;
      energy += reading * reading;
      if (reading >= deepest) continue;  // a pressing load's peak is negative
      deepest = reading;
      gaugeOfDeepest = gauge;
    }
    return {deepest * deepest / energy, 64 * std::abs(std::remainder(gaugeOfDeepest - position, gauges)),
            64 * std::abs(std::remainder(position, 1))};
  }
  /// Contacts that the span of their share leaves out.
  int leftOutOf(const std::array<ScanSpan, kShares>& spans, int gauges) {
    constexpr double kReach_rows = kHalfSpacing_rows + kSlack_rows;
    int leftOut = 0;
    for (int i = 0; i < 5000; ++i) {
      const Drawn drawn = draw(gauges);
      const ScanSpan span = spans[static_cast<std::size_t>(drawn.share * kShares)];
      const bool anywhere = span.last() == 0;
      const double distance = anywhere ? drawn.fromNearest_rows : drawn.fromDeepest_rows;
      leftOut += distance < span.first() - kReach_rows || (!anywhere && distance > span.last() + kReach_rows);
    }
    return leftOut;
  }
};

TEST(ScanSpans, LeaveNoContactOut) {
  std::printf("seed 77 ");
  for (const int gauges : {16, 24, 32})
    LONGS_EQUAL(0, leftOutOf(tables::scanSpans(response, gauges, kCone), gauges));
}

TEST(ScanSpans, OneRowLessWouldLeaveContactsOut) {
  auto spans = tables::scanSpans(response, 16, kCone);
  for (ScanSpan& span : spans)
    if (span.last() > span.first()) span = ScanSpan::of(span.first(), span.last() - kMaxScanStep);
  CHECK(leftOutOf(spans, 16) > 100);
}

TEST(ScanSpans, TheNearerTheContactTheLargerTheShare) {
  const auto spans = tables::scanSpans(response, 16, kCone);
  LONGS_EQUAL(0, spans[0].last());
  CHECK(spans[4].first() > spans[12].first());
  CHECK(spans[4].last() > spans[12].last());
}

TEST(ScanSpans, MostContactsAreLookedForAroundOneReading) {
  const auto spans = tables::scanSpans(response, 16, kCone);
  constexpr int kContacts = 20'000;
  int aroundOne = 0;
  for (int i = 0; i < kContacts; ++i)
    aroundOne += spans[static_cast<std::size_t>(draw(16).share * kShares)].last() != 0;
  std::printf("%.1f %% ", 100.0 * aroundOne / kContacts);
  CHECK(aroundOne > kContacts * 85 / 100);
}
