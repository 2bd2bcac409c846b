// Where the pairs beside the deepest reading say that a contact is, against contacts drawn at random.
#include "host/tables/start_weights.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>
#include <vector>

#include "tests/host/tables/DefaultResponse.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

constexpr double kStartCone = 1.25;
constexpr double kStartNoise = 0.002;  ///< of a reading, relative to the deepest
constexpr int kStartContacts = 20'000;

struct Told {
  double share;
  double offset_pitch;                ///< from the deepest gauge
  std::array<double, 4> differences;  ///< of the pairs around it, over its reading
};

double toldOffset(const StartWeights& weights, const Told& contact) {
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) sum += weights[i] * contact.differences[i] / 1024;
  return sum;
}

}  // namespace

TEST_GROUP(StartWeights) {
  const model::ImpulseResponse response_ = tables::responseOf({});
  std::mt19937_64 random_{78};

  void setup() override { std::printf("seed 78 "); }
  double uniform(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  Told draw(int gauges) {
    const double position = uniform(0, gauges), direction = uniform(-kStartCone, kStartCone);
    std::vector<double> readings;
    for (int gauge = 0; gauge < gauges; ++gauge) {
      const auto value = response_.at((gauge - position) * 2 * std::numbers::pi / gauges);
      readings.push_back(-value.normal - direction * value.tangential);  // a pressing load's peak is negative
    }
    const double noise = kStartNoise * *std::max_element(readings.begin(), readings.end());
    for (double& reading : readings) reading += std::normal_distribution<>(0, noise)(random_);
    const auto deepest =
        static_cast<int>(std::max_element(readings.begin(), readings.end()) - readings.begin());
    const auto at = [&](int away) {
      return readings[static_cast<std::size_t>((deepest + away + gauges) % gauges)];
    };
    double energy = 0;
    for (const double reading : readings) energy += reading * reading;
    Told told{at(0) * at(0) / energy, std::remainder(position - deepest, gauges), {}};
    for (int i = 0; i < 4; ++i)
      told.differences[static_cast<std::size_t>(i)] = (at(i + 1) - at(-i - 1)) / at(0);
    return told;
  }
  static const StartWeights& weightsFor(const std::array<StartWeights, kShares>& weights, const Told& told) {
    return weights[static_cast<std::size_t>(told.share * kShares)];
  }
};

TEST(StartWeights, MostContactsStartWithinASixteenthOfAPitch) {
  const auto weights = tables::startWeights(response_, 16, kStartCone);
  int close = 0;
  for (int i = 0; i < kStartContacts; ++i) {
    const Told told = draw(16);
    const StartWeights& own = weightsFor(weights, told);
    close += own.tell() && std::abs(toldOffset(own, told) - told.offset_pitch) < 1.0 / 16;
  }
  std::printf("%.1f %% ", 100.0 * close / kStartContacts);
  CHECK(close > kStartContacts * 80 / 100);
}

TEST(StartWeights, OtherWeightsAreFartherOff) {
  for (const auto& [gauges, share] : {std::pair{16, 12}, {24, 8}}) {
    const StartWeights own =
        tables::startWeights(response_, gauges, kStartCone)[static_cast<unsigned>(share)];
    CHECK(own.tell());
    std::vector<Told> drawn;
    for (int i = 0; i < kStartContacts; ++i) {
      const Told told = draw(gauges);
      if (static_cast<int>(told.share * kShares) == share && std::abs(told.offset_pitch) < 0.6)
        drawn.push_back(told);
    }
    const auto squares = [&](const StartWeights& each) {
      double sum = 0;
      for (const Told& told : drawn) sum += std::pow(toldOffset(each, told) - told.offset_pitch, 2);
      return sum;
    };
    for (std::size_t i = 0; i < own.size(); ++i)
      for (const int change : {-400, 400}) {
        StartWeights other = own;
        other[i] = static_cast<std::int16_t>(other[i] + change);
        CHECK(squares(other) > squares(own));
      }
  }
}

TEST(StartWeights, OnlyRingsWithAnOuterPairWeighIt) {
  for (const int gauges : {16, 18, 24, 32}) {
    int telling = 0;
    for (const StartWeights& each : tables::startWeights(response_, gauges, kStartCone)) {
      telling += each.tell() ? 1 : 0;
      if (each.tell()) CHECK_EQUAL(hasOuterPair(gauges), each[3] != 0);
    }
    CHECK(telling > 0);
  }
}

TEST(StartWeights, AShareThatNoContactHasTellsNothing) {
  const auto weights = tables::startWeights(response_, 16, kStartCone);
  CHECK(!weights[15].tell());
}

TEST(StartWeights, AreWithinTheirFormatForEveryRing) {
  for (int gauges = kMinGauges; gauges <= kMaxGauges; gauges += 2)
    for (const StartWeights& each : tables::startWeights(response_, gauges, kStartCone)) CHECK(usable(each));
}
