#include "firmware/core/signal.hpp"

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

constexpr double kDomain = 23170;  // 2^14.5

/// Middle, sums, differences, padding.
std::array<int, 8> numbers(const Signal& signal) {
  return {low(signal.even[0]), high(signal.even[0]), low(signal.even[1]), high(signal.even[1]),
          low(signal.odd[0]),  high(signal.odd[0]),  low(signal.odd[1]),  high(signal.odd[1])};
}

/// Strains that are the readings already.
constexpr int kUnscaled = 16;

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

  /// Strain of the gauge at `index`, any number of turns round.
  static double strain(const std::vector<std::int32_t>& strains, int index) {
    const int gauges = static_cast<int>(strains.size());
    return strains[static_cast<std::size_t>((index % gauges + gauges) % gauges)];
  }
  /// Scaled by the definition.
  static double scaled(double value, int up) {
    return std::floor(std::ldexp(value, up - 16) + (up < 16 ? 0.5 : 0));
  }
  void checkWindow(const std::vector<std::int32_t>& strains, int centre, int up) {
    const auto signal = numbers(windowSignal(strains, centre, up));
    DOUBLES_EQUAL(scaled(strain(strains, centre), up), signal[0], 0);
    for (int distance = 1; distance <= 3; ++distance) {
      const double plus = strain(strains, centre + distance), minus = strain(strains, centre - distance);
      DOUBLES_EQUAL(scaled(plus + minus, up), signal[static_cast<std::size_t>(distance)], 0);
      DOUBLES_EQUAL(scaled(plus - minus, up), signal[static_cast<std::size_t>(distance + 3)], 0);
    }
    const double outer = strain(strains, centre + 4) - strain(strains, centre - 4);
    DOUBLES_EQUAL(strains.size() > 16 ? scaled(outer, up) : 0, signal[7], 0);
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
    window.signal = windowSignal(strains, 3, kUnscaled);
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
  for (const std::size_t gauges :
       {std::size_t{12}, std::size_t{14}, std::size_t{16}, std::size_t{18}, std::size_t{32}})
    for (int up = 0; up <= 20; ++up) {
      const auto strains = ringOf(gauges, 1 << (29 - up));
      for (int centre = 0; centre < static_cast<int>(gauges); ++centre) checkWindow(strains, centre, up);
    }
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
    const Signal signal = windowSignal(strains, 3, kUnscaled);
    std::reverse(strains.begin(), strains.end());
    CHECK(mirrored(signal, 1) == windowSignal(strains, 3, kUnscaled));
    for (std::int32_t& strain : strains) strain = -strain;
    CHECK(mirrored(signal, -1) == windowSignal(strains, 3, kUnscaled));
  }
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
    const Signal signal = windowSignal(readings, 3, kUnscaled);
    const auto values = numbers(signal);
    FoldedWeights along{};
    std::transform(values.begin(), values.end(), along.begin(),
                   [](int value) { return static_cast<std::int16_t>(value * 32767 / 46340); });
    along[0] = static_cast<std::int16_t>(values[0] * 32767 / 23'170);
    DOUBLES_EQUAL(kDomain * kDomain / 4, energyOf(signal), 2e-4 * kDomain * kDomain);
    const std::int32_t projection = project(along, signal);
    DOUBLES_EQUAL(kDomain * 32767, projection, 2e-4 * kDomain * 32767);
    DOUBLES_EQUAL(energyOf(signal), energyOf(projection, 0), 2e-4 * kDomain * kDomain);
  }
}
