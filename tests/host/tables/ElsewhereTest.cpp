// What else could be taken for a contact, against a finer search for contacts drawn at random.
#include "host/tables/elsewhere.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "tests/host/tables/DefaultResponse.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

constexpr int kElsewhereGauges = 16;
constexpr double kElsewhereCone = 1.25;
constexpr int kElsewherePlaces = 128;  ///< a pitch

double elsewhereReading(const model::ImpulseResponse& response, int gauge, double position,
                        double tangential) {
  const auto value = response.at((gauge - position) * 2 * std::numbers::pi / kElsewhereGauges);
  return value.normal + tangential * value.tangential;
}

struct Left {
  double part;   ///< of the energy
  bool allowed;  ///< presses, and friction holds it
};

/// By Cramer's rule, for the readings of a contact around gauge 0.
Left leftAt(const model::ImpulseResponse& response, const std::vector<double>& readings, double position) {
  double nn = 0, nt = 0, tt = 0, n = 0, t = 0, energy = 0;
  for (int gauge = -3; gauge <= 3; ++gauge) {
    const auto value = response.at((gauge - position) * 2 * std::numbers::pi / kElsewhereGauges);
    const double reading = readings[static_cast<std::size_t>(gauge + 3)];
    nn += value.normal * value.normal;
    nt += value.normal * value.tangential;
    tt += value.tangential * value.tangential;
    n += value.normal * reading;
    t += value.tangential * reading;
    energy += reading * reading;
  }
  const double determinant = nn * tt - nt * nt;
  const double normal = (n * tt - t * nt) / determinant, tangential = (t * nn - n * nt) / determinant;
  return {1 - (normal * n + tangential * t) / energy,
          normal > 0 && std::abs(tangential) < 1.25 * kElsewhereCone * normal};
}

/// Of a contact whose deepest reading is gauge 0's.
double leastFor(const model::ImpulseResponse& response, double position, double tangential) {
  std::vector<double> readings;
  for (int gauge = -3; gauge <= 3; ++gauge)
    readings.push_back(elsewhereReading(response, gauge, position, tangential));
  if (std::min_element(readings.begin(), readings.end()) - readings.begin() != 3)
    return 1;  // a peak is negative
  std::vector<Left> left;
  for (int i = -kElsewherePlaces * 5 / 8; i <= kElsewherePlaces * 5 / 8; ++i)
    left.push_back(leftAt(response, readings, static_cast<double>(i) / kElsewherePlaces));
  double least = 1;
  for (std::size_t i = 1; i + 1 < left.size(); ++i) {
    const double place = static_cast<double>(i) / kElsewherePlaces - 5.0 / 8;
    const bool valley = left[i].part <= left[i + 1].part && left[i].part <= left[i - 1].part;
    if (valley && left[i].allowed && std::abs(place - position) > 2.0 / kElsewherePlaces)
      least = std::min(least, left[i].part);
  }
  return least;
}

}  // namespace

TEST_GROUP(Elsewhere) { const model::ImpulseResponse response_ = tables::responseOf({}); };

TEST(Elsewhere, NoContactAQuarterOfAPitchFromAGaugeLooksMoreLikeAnother) {
  std::printf("seed 79 ");
  std::mt19937_64 random(79);
  std::uniform_real_distribution<double> offset(0.25, 0.5), direction(-kElsewhereCone, kElsewhereCone);
  const double expected = tables::leastElsewhere(response_, kElsewhereGauges, kElsewhereCone);
  double least = 1;
  for (int i = 0; i < 2000; ++i)
    least = std::min(least, leastFor(response_, offset(random), direction(random)));
  std::printf("%.4f, %.4f of all drawn ", expected, least);
  CHECK(least > 0.97 * expected);
  CHECK(least < 1.5 * expected);
}

TEST(Elsewhere, NearerToAGaugeTheyDo) {
  CHECK(leastFor(response_, 0.12, -0.28) <
        0.5 * tables::leastElsewhere(response_, kElsewhereGauges, kElsewhereCone));
}

TEST(Elsewhere, OneHundredAndSeventyFiveVariancesAreFirm) {
  LONGS_EQUAL(16, tables::firmExponent(175.0 / 65536));
  LONGS_EQUAL(17, tables::firmExponent(174.0 / 65536));
  LONGS_EQUAL(16, tables::firmExponent(176.0 / 65536));
}

TEST(Elsewhere, NothingIsFirmWhereAnotherPlaceExplainsAll) {
  CHECK(tables::firmExponent(0) > kMostFirmExponent);
}
