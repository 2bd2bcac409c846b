#include "host/contact/slope_map.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/base/failure.hpp"
#include "tests/host/contact/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::contact;
using namespace strainfinger::testing;

// Relative values, 2 mm, n_c = 300. The continuum's first twelve were computed for this project with 64 Gauss
// rows in numpy; all of both with the whole matrix, as printed: 604 even points (200 Gauss rows) by 602
// unknowns, no parity, the window's coefficients by quadrature.
constexpr std::array kContinuum{1.0,          0.9445057420, 0.7432374611, 0.6166368226, 0.4030095585,
                                0.2756086803, 0.1393748108, 0.1060109217, 0.0653231929, 0.0286584519,
                                0.0108112000, 0.0036092327, 0.0010799368, 0.0003017493};
constexpr std::array kPrinted{1.0,          0.9444687060, 0.7432907985, 0.6166252180, 0.4030878154,
                              0.2756177965, 0.1394527403, 0.1060444108, 0.0654099376, 0.0287070622,
                              0.0108410951, 0.0036250079, 0.0010866499, 0.0003046009};

TEST_GROUP(SlopeMap) {
  static SlopeMapRequest request(double width_mm) {
    SlopeMapRequest request;
    request.width_rad = width_mm * 1e-3 / kSurface_m;
    return request;
  }

  static std::vector<SingularPair> pairs(const SlopeMapRequest& request) {
    return singularPairs(SlopeMap(kDefaultFinger, request));
  }

  static long above(const std::vector<SingularPair>& pairs, double relative) {
    return std::count_if(pairs.begin(), pairs.end(),
                         [&](const SingularPair& pair) { return pair.value > relative * pairs[0].value; });
  }

  static double worstDeparture(const std::vector<SingularPair>& pairs, const std::array<double, 14>& known) {
    double worst = 0;
    for (std::size_t i = 0; i < known.size(); ++i)
      worst = std::max(worst, std::abs(pairs[i].value / pairs[0].value - known[i]));
    return worst;
  }
};

TEST(SlopeMap, GaussRowsHaveTheContinuumsValues) {
  CHECK_TRUE(worstDeparture(pairs(request(2)), kContinuum) < 1e-10);
}

TEST(SlopeMap, ThePrintedSamplingDiffersByUpToATenThousandth) {
  SlopeMapRequest printed = request(2);
  printed.rows = SlopeRows::kPrinted;
  const auto values = pairs(printed);
  LONGS_EQUAL(604, values.size());  // the others are noise
  CHECK_TRUE(worstDeparture(values, kPrinted) < 1e-10);
  CHECK_TRUE(worstDeparture(values, kContinuum) < 1e-4);
  CHECK_TRUE(worstDeparture(values, kContinuum) > 1e-5);
  DOUBLES_EQUAL(1, values[0].value / pairs(request(2))[0].value, 1e-3);  // the same scale
}

// The paper's 8 and 11, and figure 9: widths 1, 1.5 .. 6 mm.
TEST(SlopeMap, AsManyValuesMatterAsThePaperCounts) {
  constexpr std::array kTenth{4, 6, 8, 9, 11, 12, 14, 15, 17, 18, 20};
  constexpr std::array kHundredth{7, 9, 11, 12, 14, 16, 18, 19, 21, 23, 25};
  for (const WindowCut cut : {WindowCut::kHalf, WindowCut::kFull})
    for (std::size_t i = 0; i < kTenth.size(); ++i) {
      SlopeMapRequest wide = request(1 + 0.5 * static_cast<double>(i));
      wide.window = cut;
      LONGS_EQUAL(kTenth[i], above(pairs(wide), 0.1));
      LONGS_EQUAL(kHundredth[i], above(pairs(wide), 0.01));
    }
}

TEST(SlopeMap, WithoutShearFewerMatter) {
  SlopeMapRequest frictionless = request(2);
  frictionless.withShear = false;
  LONGS_EQUAL(7, above(pairs(frictionless), 0.1));
  LONGS_EQUAL(10, above(pairs(frictionless), 0.01));
}

// Values 1 to 4: odd, even, odd, even slope, made by pressures of the other parity.
TEST(SlopeMap, TheFirstPairsAlternateInParity) {
  const SlopeMap map(kDefaultFinger, request(2));
  const auto found = singularPairs(map);
  for (std::size_t i = 0; i < 4; ++i) {
    LONGS_EQUAL(i % 2, found[i].isEvenSlope);
    const FourierTractions tractions = map.tractions(found[i].isEvenSlope, found[i].unknowns);
    const double sign = found[i].isEvenSlope ? 1 : -1;
    const double slope = surfaceAt(kDefaultFinger, tractions, 0.03).urSlope_m;
    DOUBLES_EQUAL(slope, sign * surfaceAt(kDefaultFinger, tractions, -0.03).urSlope_m,
                  1e-12 * std::abs(slope));
    const double pressure = tractionAt(tractions, 0.03).pressure_pa;
    DOUBLES_EQUAL(pressure, -sign * tractionAt(tractions, -0.03).pressure_pa, 1e-12);
  }
}

// T C v = sigma u, recomputed harmonic by harmonic.
TEST(SlopeMap, TractionsMakeTheSlopesOfTheirPair) {
  const SlopeMap map(kDefaultFinger, request(2));
  for (const SingularPair& pair : singularPairs(map)) {
    if (pair.value < 1e-12) continue;
    const FourierTractions tractions = map.tractions(pair.isEvenSlope, pair.unknowns);
    for (const Eigen::Index i : {0, 5, 20}) {
      const double slope = surfaceAt(kDefaultFinger, tractions, map.angles_rad()[i]).urSlope_m;
      DOUBLES_EQUAL(pair.value * pair.slopes[i], map.weights()[i] * slope, 1e-18);  // of 1e-6
    }
  }
}

// Of a constant pressure: the Hanning window itself, 1/2 (1 + cos(2 pi theta / width)), to 2 % when cut at
// 150.
TEST(SlopeMap, TheWindowConfinesTractions) {
  const SlopeMap map(kDefaultFinger, request(2));
  Eigen::VectorXd unknowns = Eigen::VectorXd::Zero(map.block(false).cols());
  unknowns[0] = 1;
  const FourierTractions tractions = map.tractions(false, unknowns);
  DOUBLES_EQUAL(1, tractionAt(tractions, 0).pressure_pa, 0.02);
  DOUBLES_EQUAL(0.5, tractionAt(tractions, 0.5e-3 / kSurface_m).pressure_pa, 0.02);
  DOUBLES_EQUAL(0, tractionAt(tractions, 2e-3 / kSurface_m).pressure_pa, 0.02);
}

TEST(SlopeMap, RefusesWhatIsOutsideItsDomain) {
  for (const double width_mm : {0.0, -1.0, 40.0, std::nan("")})
    CHECK_THROWS(Failure, pairs(request(width_mm)));
  for (const int harmonics : {1, 20'001}) {
    SlopeMapRequest other = request(2);
    other.harmonics = harmonics;
    CHECK_THROWS(Failure, pairs(other));
  }
}
