#include "firmware/core/problem.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <vector>

#include "firmware/core/signal.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

constexpr double kLargestSignal = 23170.475;  // 2^14.5, what the proof of ranges starts from
constexpr double kRounding = 1;               // of seven readings, half a step each once they are folded

}  // namespace

TEST_GROUP(Problem) {
  const std::unique_ptr<TableImage> image = std::make_unique<TableImage>();
  const std::vector<std::int32_t> strains = std::vector<std::int32_t>(16);

  void setup() override { image->constants.gauge_count = 16; }
  Problem of(std::uint32_t energy, int gateShift) {
    image->constants.gate_shift = static_cast<std::uint8_t>(gateShift);
    return problemOf(*image, strains, energy);
  }

  /// The longest that so many gauges' readings [as scaled] of a ring of that energy are: each is within
  /// +-2^(15 + gate_shift), which is where an energy saturates.
  double longest(int gauges, std::uint32_t energy, int gateShift) {
    const bool saturated = energy == std::numeric_limits<std::uint32_t>::max();
    const double ring = saturated ? std::exp2(17.5) : std::sqrt(energy + 1.0);
    const double readings = std::min(ring, std::sqrt(gauges) * std::exp2(15));
    return std::ldexp(readings, gateShift - 16 + of(energy, gateShift).up);
  }
  double longestWindow(std::uint32_t energy, int gateShift) {
    return longest(kWindowGauges, energy, gateShift);
  }

  /// Visits both ends of every range of energies that are scaled alike.
  template <typename Visit>
  static void forEachEnergy(Visit visit) {
    const auto scaleOf = [](std::uint32_t energy) { return (energy >> 1) + (energy >> 12) + 1; };
    for (int bit = 0; bit < 32; ++bit) {
      // The last energy below a power of two, and the first beyond.
      std::uint64_t low = 0, high = std::uint64_t{1} << 32;
      while (high - low > 1) {
        const std::uint64_t middle = (low + high) / 2;
        (scaleOf(static_cast<std::uint32_t>(middle)) >> bit != 0 ? high : low) = middle;
      }
      visit(static_cast<std::uint32_t>(low));
      visit(static_cast<std::uint32_t>(std::min<std::uint64_t>(high, ~std::uint32_t{0})));
    }
  }
};

TEST(Problem, NoWindowOfAnyRingIsLongerThanASignalMayBe) {
  for (int gateShift = 0; gateShift <= kMostGateShift; ++gateShift)
    forEachEnergy(
        [&](std::uint32_t energy) { CHECK(longestWindow(energy, gateShift) + kRounding < kLargestSignal); });
}

TEST(Problem, NoReadingsOfAnyRingAreLongerThanTheProofOfRangesTakesThem) {
  constexpr double kEachRounded = 0.5, kOuterRounded = 1.5;
  const double rounding = std::hypot(std::sqrt(kWindowGauges) * kEachRounded, kOuterRounded);
  for (int gateShift = 0; gateShift <= kMostGateShift; ++gateShift)
    forEachEnergy([&](std::uint32_t energy) {
      // The outer pair's difference over sqrt(2) is no longer than the pair.
      CHECK(longest(kWindowGauges + 2, energy, gateShift) + rounding < std::exp2(14.6));
      CHECK(longest(kMaxGauges, energy, gateShift) + std::sqrt(kMaxGauges) * kEachRounded <
            std::exp2(15.5) + 3);
    });
}

TEST(Problem, SignalsUseAllButTwoOfTheirBits) {
  forEachEnergy([&](std::uint32_t energy) {
    if (energy > 1000 && energy < 1u << 31) CHECK(longestWindow(energy, 13) > kLargestSignal / 2.1);
  });
}

TEST(Problem, EnergiesOfRingAndNoiseFitTheirWords) {
  for (int gateShift = 0; gateShift <= kMostGateShift; ++gateShift)
    forEachEnergy([&](std::uint32_t energy) {
      const Problem problem = of(energy, gateShift);
      CHECK(problem.ringEnergy >= 0 && problem.ringEnergy <= 1 << 28);
      CHECK(problem.up >= 0 && problem.up <= 30);
      for (const int exponent : {-24, 0, 10, 35}) {
        image->constants.noise_variance = 1 << 24;
        image->constants.noise_variance_exponent = static_cast<std::int8_t>(exponent);
        const std::int32_t noise = noiseEnergy(image->constants, problem.up);
        CHECK(noise >= 1 && noise <= 1 << 27);
      }
    });
}
