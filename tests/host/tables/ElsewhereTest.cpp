// What else could be taken for a contact, against a finer search for contacts drawn at random.
#include "host/tables/elsewhere.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

#include "host/tables/window_fit.hpp"
#include "tests/host/tables/DefaultResponse.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

constexpr double kElsewhereCone = 1.25;
constexpr int kElsewherePlaces = 128;  ///< a pitch
constexpr int kFarthestPlace = kElsewherePlaces * 5 / 8;

using ElsewhereReadings = Eigen::Matrix<double, kWindowGauges + 1, 1>;

struct Left {
  double part;   ///< of the energy
  bool allowed;  ///< presses, and friction holds it
};

/// By Cramer's rule.
Left leftOf(const ElsewhereReadings& readings, const tables::OracleMatrix& responses) {
  const auto normal = responses.col(0), tangential = responses.col(1);
  const double nn = normal.squaredNorm(), nt = normal.dot(tangential), tt = tangential.squaredNorm();
  const double n = normal.dot(readings), t = tangential.dot(readings);
  const double determinant = nn * tt - nt * nt;
  const double normalLoad = (n * tt - t * nt) / determinant, tangentialLoad = (t * nn - n * nt) / determinant;
  return {1 - (normalLoad * n + tangentialLoad * t) / readings.squaredNorm(),
          normalLoad > 0 && std::abs(tangentialLoad) < 1.25 * kElsewhereCone * normalLoad};
}

/// Contacts on a ring, seen by the window around gauge 0.
class ElsewhereRing {
 public:
  ElsewhereRing(const model::ImpulseResponse& response, int gauges)
      : response_(response), gauges_(gauges), sign_(response.at(0).normal < 0 ? -1 : 1) {
    for (int i = -kFarthestPlace; i <= kFarthestPlace; ++i)
      places_.push_back(windowAt(static_cast<double>(i) / kElsewherePlaces));
  }
  /// The least part of the ring's energy that is left at another place; 1 for a contact that isn't this
  /// window's.
  double leastFor(double position, double tangential) const {
    const ElsewhereReadings readings = windowAt(position) * Eigen::Vector2d(1, tangential);
    const double inside = readings.squaredNorm();
    const Whole whole = wholeAt(position, tangential);
    if (whole.deepest != 0 || whole.energy - inside > inside / 29) return 1;  // little is read outside
    std::vector<Left> left;
    for (const auto& place : places_) left.push_back(leftOf(readings, place));
    double least = 1;
    for (std::size_t i = 1; i + 1 < left.size(); ++i) {
      const double place = static_cast<double>(i) / kElsewherePlaces - 5.0 / 8;
      const bool valley = left[i].part <= left[i + 1].part && left[i].part <= left[i - 1].part;
      if (valley && left[i].allowed && std::abs(place - position) > 2.0 / kElsewherePlaces)
        least = std::min(least, left[i].part);
    }
    return least * inside / whole.energy;
  }

 private:
  tables::OracleMatrix windowAt(double position) const {
    return tables::oracleResponse(response_, gauges_, position, tables::kAllGauges);
  }
  struct Whole {
    double energy = 0;
    int deepest = 0;  ///< gauge
  };
  Whole wholeAt(double position, double tangential) const {
    Whole whole;
    double deepest = 0;
    for (int gauge = 0; gauge < gauges_; ++gauge) {
      const auto value = response_.at((gauge - position) * 2 * std::numbers::pi / gauges_);
      const double reading = sign_ * (value.normal + tangential * value.tangential);
      whole.energy += reading * reading;
      if (reading <= deepest) continue;
      deepest = reading;
      whole.deepest = gauge;
    }
    return whole;
  }

  const model::ImpulseResponse& response_;
  int gauges_;
  double sign_;  ///< of a pressing load's peak
  std::vector<tables::OracleMatrix> places_;
};

}  // namespace

TEST_GROUP(Elsewhere) { const model::ImpulseResponse response_ = tables::responseOf({}); };

// On either side of the gauge, and wherever its reading is still the deepest.
TEST(Elsewhere, NoContactAQuarterOfAPitchFromAGaugeLooksMoreLikeAnother) {
  std::printf("seed 79 ");
  config::FingerConfig hoop;
  hoop.gauges.component = StrainComponent::kHoop;
  const model::ImpulseResponse hoopResponse = tables::responseOf(hoop);
  std::mt19937_64 random(79);
  std::uniform_real_distribution<double> distance(0.25, 0.9), direction(-kElsewhereCone, kElsewhereCone);
  for (const auto& [response, gauges] : {std::pair{&response_, 16}, {&response_, 18}, {&hoopResponse, 16}}) {
    const double expected = tables::leastElsewhere(*response, gauges, kElsewhereCone);
    const ElsewhereRing ring(*response, gauges);
    double least = 1;
    for (int i = 0; i < 3000; ++i) {
      const double position = distance(random) * (i % 2 == 0 ? 1 : -1);
      least = std::min(least, ring.leastFor(position, direction(random)));
    }
    std::printf("%d: %.4f, %.4f of all drawn ", gauges, expected, least);
    CHECK(least > 0.97 * expected);
    CHECK(least < 1.5 * expected);
  }
}

TEST(Elsewhere, NearerToAGaugeTheyDo) {
  CHECK(ElsewhereRing(response_, 16).leastFor(0.12, -0.28) <
        0.5 * tables::leastElsewhere(response_, 16, kElsewhereCone));
}

TEST(Elsewhere, OneHundredAndSeventyFiveVariancesAreFirm) {
  LONGS_EQUAL(16, tables::firmExponent(175.0 / 65536));
  LONGS_EQUAL(17, tables::firmExponent(174.0 / 65536));
  LONGS_EQUAL(16, tables::firmExponent(176.0 / 65536));
}

TEST(Elsewhere, NothingIsFirmWhereAnotherPlaceExplainsAll) {
  CHECK(tables::firmExponent(0) > kMostFirmExponent);
}
