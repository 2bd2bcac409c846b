// What the three readings around a contact tell, against the model's own.
#include "host/tables/near_table.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "host/tables/table_builder.hpp"
#include "tests/host/tables/DefaultResponse.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {
constexpr int kNearAmplitudeExponent = 12;
constexpr double kNearPole_pitch = 0.45;
}  // namespace

TEST_GROUP(NearTable) {
  const model::ImpulseResponse model_ = tables::responseOf({});
  const tables::WindowResponses responses_ = tables::windowResponses(model_, 16);
  const double peak_ = std::abs(model_.at(0).normal);
  const NearTable table_ = tables::nearTable(responses_, peak_, kNearAmplitudeExponent, kNearPole_pitch);

  /// Of gauges -1, 0 and 1, to loads in units of the peak.
  Eigen::Vector3d readings(std::size_t row, double normal, double tangential) const {
    const auto all = tables::oracleResponse(model_, 16, static_cast<double>(row) / 32, tables::kAllGauges);
    return all.middleRows<3>(2) / peak_ * Eigen::Vector2d(normal, tangential);
  }
};

TEST(NearTable, NoLoadsTakeTheReadingsOutOfTheirPlane) {
  for (std::size_t row = 0; row < kNearRows; ++row)
    for (const double tangential : {-1.0, 0.0, 0.5}) {
      const Eigen::Vector3d read = readings(row, 1, tangential);
      const auto& normal = table_[row].normal;
      const double away =
          normal[0] * read[1] + normal[1] * (read[2] + read[0]) + normal[2] * (read[2] - read[0]);
      DOUBLES_EQUAL(0, away, 2);  // rounding, of weights of up to 2^14
      LONGS_EQUAL(0, normal[3]);
    }
}

TEST(NearTable, TheLongestNormalHasALengthOfOneAndTheyTurnSteadily) {
  const auto unfolded = [](const NearRow& row) -> Eigen::Vector3d {
    return Eigen::Vector3d(row.normal[1] - row.normal[2], row.normal[0], row.normal[1] + row.normal[2]) /
           16384;
  };
  double longest = 0;
  for (std::size_t row = 0; row < kNearRows; ++row) {
    const Eigen::Vector3d normal = unfolded(table_[row]);
    longest = std::max(longest, normal.norm());
    CHECK(normal.norm() > 0.1);
    if (row > 0) CHECK(normal.normalized().dot(unfolded(table_[row - 1]).normalized()) > 0.9);
  }
  DOUBLES_EQUAL(1, longest, 2e-4);
}

TEST(NearTable, MiddleReadingAndDifferenceTellTheLoads) {
  for (std::size_t row = 0; row < kNearRows; ++row)
    for (const double tangential : {-1.0, 0.0, 0.5}) {
      const Eigen::Vector3d read = readings(row, 1, tangential);
      const auto told = [&](const std::array<std::int16_t, 2>& weights) {
        return std::ldexp(weights[0] * read[1] + weights[1] * (read[2] - read[0]),
                          1 - kNearAmplitudeExponent) /
               (1 - static_cast<double>(row) / 32 / kNearPole_pitch);
      };
      DOUBLES_EQUAL(1, told(table_[row].normal_load), 1e-3);
      DOUBLES_EQUAL(tangential, told(table_[row].tangential_load), 1e-3);
    }
}

TEST(NearTable, BeforeThePoleItsLoadsTurnSlowly) {
  const double pole = tables::nearPole(model_, 16);
  const NearTable table = tables::nearTable(responses_, peak_, kNearAmplitudeExponent, pole);
  for (std::size_t row = 1; row + 1 < kNearRows; ++row) {
    const auto bend = [&](std::size_t i) {
      const auto at = [&](std::size_t j) { return static_cast<double>(table[j].normal_load[i]); };
      return at(row - 1) - 2 * at(row) + at(row + 1);
    };
    for (const std::size_t i : {0u, 1u}) CHECK(std::abs(bend(i)) < 40);  // of several thousand
  }
}

// Independent of determinants: the readings that a tangential load leaves where the middle one is as a normal
// one's.
TEST(NearTable, AtThePoleTheLoadsAreNotTold) {
  const double pole = tables::nearPole(model_, 16);
  CHECK(pole > 0.4 && pole < 0.5);
  const auto all = tables::oracleResponse(model_, 16, pole, tables::kAllGauges);
  const double alike = all(3, 1) / all(3, 0);
  const Eigen::VectorXd left = all.col(1) - alike * all.col(0);
  DOUBLES_EQUAL(0, (left[4] - left[2]) / all.col(1).cwiseAbs().maxCoeff(), 1e-3);
}

TEST(NearTable, FromTheFirstLoadsThatDoNotFitNoneAreTold) {
  const NearTable coarse = tables::nearTable(responses_, peak_, kNearAmplitudeExponent + 1, 2);
  CHECK(coarse[0].tells());
  CHECK(!coarse[12].tells());
  bool told = true;
  for (const NearRow& row : coarse) {
    CHECK(usable(row));
    CHECK(told || !row.tells());
    told = row.tells();
  }
}

TEST(NearTable, RingsOfUpToSixteenGaugesHaveAllRows) {
  for (int gauges = kMinGauges; gauges <= kMaxGauges; gauges += 2) {
    config::FingerConfig config;
    config.gauges.count = gauges;
    const TableImage image = tables::buildTableImage(config);
    const auto telling =
        std::count_if(image.near.begin(), image.near.end(), [](const NearRow& row) { return row.tells(); });
    std::printf("%d: %d ", gauges, static_cast<int>(telling));
    CHECK(gauges > 16 || telling == kNearRows);
    for (const NearRow& row : image.near) CHECK(usable(row));
  }
}
