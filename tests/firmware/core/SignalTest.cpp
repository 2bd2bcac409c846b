#include "firmware/core/signal.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <vector>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

constexpr double kLowest = std::numeric_limits<std::int16_t>::min();
constexpr double kHighest = std::numeric_limits<std::int16_t>::max();
constexpr double kDomain = 23170;  // 2^14.5

double clamped(double value) { return std::clamp(value, kLowest, kHighest); }

}  // namespace

TEST_GROUP(Signal) {
  std::mt19937 random{4};

  void setup() override { std::printf("seed 4 "); }
  std::int32_t within(std::int32_t limit) {
    return std::uniform_int_distribution<std::int32_t>(-limit, limit)(random);
  }
  std::vector<std::int32_t> ringOf(std::size_t gauges, std::int32_t limit) {
    std::vector<std::int32_t> strains(gauges);
    for (std::int32_t& strain : strains) strain = within(limit);
    return strains;
  }

  /// Reading of the gauge at `index`, any number of turns round, scaled by the definition.
  double scaled(const std::vector<std::int32_t>& strains, int index, int shift) {
    const int gauges = static_cast<int>(strains.size());
    const auto gauge = static_cast<std::size_t>((index % gauges + gauges) % gauges);
    return clamped(std::floor(std::ldexp(strains[gauge], -shift) + (shift > 0 ? 0.5 : 0)));
  }
  void checkWindow(const std::vector<std::int32_t>& strains, int centre, int shift) {
    const Signal signal = windowSignal(strains, centre, shift);
    DOUBLES_EQUAL(scaled(strains, centre, shift), signal[0], 0);
    for (int distance = 1; distance <= 3; ++distance) {
      const double plus = scaled(strains, centre + distance, shift);
      const double minus = scaled(strains, centre - distance, shift);
      DOUBLES_EQUAL(clamped(plus + minus), signal[static_cast<std::size_t>(distance)], 0);
      DOUBLES_EQUAL(clamped(plus - minus), signal[static_cast<std::size_t>(distance + 3)], 0);
    }
    LONGS_EQUAL(0, signal[7]);
  }

  /// A window's seven readings with a norm of `norm`, and the signal they fold to.
  struct Window {
    std::array<double, 7> readings;
    Signal signal;
  };
  Window windowOfNorm(double norm) {
    std::vector<std::int32_t> strains = ringOf(7, 1 << 20);
    double square = 0;
    for (const std::int32_t strain : strains) square += std::ldexp(strain, 0) * strain;
    Window window{};
    for (std::size_t i = 0; i < 7; ++i) {
      strains[i] = static_cast<std::int32_t>(strains[i] * norm / std::sqrt(square));
      window.readings[i] = strains[i];
    }
    window.signal = windowSignal(strains, 3, 0);
    return window;
  }
  /// Weights over the window, unfolded from integers so that nothing is rounded.
  FoldedWeights weights() {
    FoldedWeights result{};
    for (std::size_t i = 0; i < 7; ++i) result[i] = static_cast<std::int16_t>(within(10'000));
    return result;
  }
  static double unfolded(const FoldedWeights& weights, int offset) {
    const auto distance = static_cast<std::size_t>(std::abs(offset));
    if (offset == 0) return weights[0];
    return weights[distance] + (offset > 0 ? 1 : -1) * weights[distance + 3];
  }
};

TEST(Signal, FoldsTheScaledWindowAtEveryGaugeOfEveryRing) {
  for (const std::size_t gauges : {std::size_t{12}, std::size_t{14}, std::size_t{16}, std::size_t{32}})
    for (int shift = -4; shift <= 20; ++shift) {
      const auto strains = ringOf(gauges, 1 << std::clamp(shift + 13, 10, 30));
      for (int centre = 0; centre < static_cast<int>(gauges); ++centre) checkWindow(strains, centre, shift);
    }
}

TEST(Signal, SaturatesWhatDoesNotFit) {
  const std::vector<std::int32_t> ends{std::numeric_limits<std::int32_t>::min(),
                                       std::numeric_limits<std::int32_t>::max()};
  std::vector<std::int32_t> strains;
  for (std::size_t i = 0; i < 12; ++i) strains.push_back(ends[random() % 2]);
  for (const int shift : {-14, 0, 1, 15, 16, 17, 30})
    for (int centre = 0; centre < 12; ++centre) checkWindow(strains, centre, shift);
}

TEST(Signal, WrappedGoesRoundTheRing) {
  LONGS_EQUAL(15, wrapped(-1, 16));
  LONGS_EQUAL(0, wrapped(0, 16));
  LONGS_EQUAL(15, wrapped(15, 16));
  LONGS_EQUAL(0, wrapped(16, 16));
}

TEST(Signal, MirroringTwiceIsNone) {
  for (const int sign : {1, -1})
    for (int i = 0; i < 1000; ++i) {
      const Signal signal = windowOfNorm(kDomain).signal;
      CHECK(mirrored(mirrored(signal, sign), sign) == signal);
    }
}

TEST(Signal, MirroredIsTheWindowOfTheReversedRing) {
  for (int i = 0; i < 1000; ++i) {
    auto strains = ringOf(7, 10'000);
    const Signal signal = windowSignal(strains, 3, 0);
    std::reverse(strains.begin(), strains.end());
    CHECK(mirrored(signal, 1) == windowSignal(strains, 3, 0));
    for (std::int32_t& strain : strains) strain = -strain;
    CHECK(mirrored(signal, -1) == windowSignal(strains, 3, 0));
  }
}

TEST(Signal, MirroringTheLowestNumberSaturates) {
  Signal signal{};
  signal.fill(std::numeric_limits<std::int16_t>::min());
  LONGS_EQUAL(32767, mirrored(signal, 1)[6]);
  LONGS_EQUAL(-32768, mirrored(signal, 1)[3]);
  LONGS_EQUAL(32767, mirrored(signal, -1)[3]);
  LONGS_EQUAL(-32768, mirrored(signal, -1)[6]);
}

TEST(Signal, ProjectionIsTheProductWithTheUnfoldedWeights) {
  for (int i = 0; i < 10'000; ++i) {
    const Window window = windowOfNorm(8000);
    const FoldedWeights folded = weights();
    double product = 0;
    for (int offset = -3; offset <= 3; ++offset)
      product += unfolded(folded, offset) * window.readings[static_cast<std::size_t>(offset + 3)];
    DOUBLES_EQUAL(product, project(folded, window.signal), 0);
  }
}

TEST(Signal, MirroringNegatesTheOddPartOnly) {
  for (int i = 0; i < 1000; ++i) {
    const Signal signal = windowOfNorm(kDomain).signal;
    const FoldedWeights folded = weights();
    LONGS_EQUAL(evenPart(folded, signal), evenPart(folded, mirrored(signal, 1)));
    LONGS_EQUAL(-oddPart(folded, signal), oddPart(folded, mirrored(signal, 1)));
    LONGS_EQUAL(-evenPart(folded, signal), evenPart(folded, mirrored(signal, -1)));
    LONGS_EQUAL(oddPart(folded, signal), oddPart(folded, mirrored(signal, -1)));
  }
}

TEST(Signal, EnergyIsAQuarterOfTheSumOfSquares) {
  for (int i = 0; i < 10'000; ++i) {
    const Window window = windowOfNorm(kDomain);
    double square = 0;
    for (const double reading : window.readings) square += reading * reading;
    DOUBLES_EQUAL(square / 4 - 0.5, energyOf(window.signal), 0.5);  // rounded down
  }
}

TEST(Signal, EnergyOfProjectionsIsAQuarterOfTheirSumOfSquares) {
  for (int i = 0; i < 10'000; ++i) {
    const std::int32_t p1 = within(759'250'124), p2 = within(759'250'124);  // 2^29.5
    const double square =
        std::ldexp(p1, -15) * std::ldexp(p1, -15) + std::ldexp(p2, -15) * std::ldexp(p2, -15);
    DOUBLES_EQUAL(square / 4 - 1, energyOf(p1, p2), 1);  // two products, each rounded down
  }
}

TEST(Signal, TheDomainsEdgeStaysInItsFormats) {
  // All of the norm in one reading, in a pair of the same and of opposite sign, in every reading.
  using Readings = std::vector<std::int32_t>;
  for (const Readings& readings :
       {Readings{0, 0, 0, 23'170, 0, 0, 0}, Readings{0, 16'383, 0, 0, 0, 16'383, 0},
        Readings{16'383, 0, 0, 0, 0, 0, -16'383}, Readings(7, -8757)}) {
    const Signal signal = windowSignal(readings, 3, 0);
    FoldedWeights along{};
    std::transform(signal.begin(), signal.end(), along.begin(),
                   [](std::int16_t value) { return static_cast<std::int16_t>(value * 32767 / 46340); });
    along[0] = static_cast<std::int16_t>(signal[0] * 32767 / 23'170);
    DOUBLES_EQUAL(kDomain * kDomain / 4, energyOf(signal), 2e-4 * kDomain * kDomain);
    const std::int32_t projection = project(along, signal);
    DOUBLES_EQUAL(kDomain * 32767, projection, 2e-4 * kDomain * 32767);
    DOUBLES_EQUAL(energyOf(signal), energyOf(projection, 0), 2e-4 * kDomain * kDomain);
  }
}
