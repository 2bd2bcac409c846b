#include "host/tables/fit_table.hpp"

#include <cmath>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

#include "host/base/failure.hpp"
#include "host/tables/table_builder.hpp"
#include "tests/host/tables/DefaultResponse.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::tables;

namespace {

/// Nearest integers, and what the oracle's finite differences may be off.
constexpr double kHalfStep = 0.501;

/// The rows' numbers once more: Cholesky's factors of the model's values, slopes by finite differences.
struct Oracle {
  OracleMatrix basis, gradient;
  Eigen::Matrix2d amplitude, amplitudeSlope;

  Oracle(const model::ImpulseResponse& model, int gauges, double peak, double offset) {
    const auto values = [&](double at) -> OracleMatrix {
      return oracleResponse(model, gauges, at, kAllGauges) / peak;
    };
    const OracleMatrix here = values(offset);
    const Eigen::Matrix2d gram = here.transpose() * here;
    Eigen::Matrix2d r = Eigen::Matrix2d::Zero();
    r(0, 0) = std::sqrt(gram(0, 0));
    r(0, 1) = gram(0, 1) / r(0, 0);
    r(1, 1) = std::sqrt(gram.determinant()) / r(0, 0);
    amplitude = r.inverse();
    basis = here * amplitude;
    const OracleMatrix slope = derivative(values, offset) * amplitude;
    gradient = slope - basis * (basis.transpose() * slope);
    amplitudeSlope = -amplitude * basis.transpose() * slope / kRowsPerPitch;
  }
};

}  // namespace

TEST_GROUP(FitTable) {
  const std::unique_ptr<TableImage> image_ = std::make_unique<TableImage>(buildTableImage({}));
  const model::ImpulseResponse model_ = responseOf({});
  const double peak_ = std::abs(model_.at(0).normal);
  const WindowResponses responses_ = windowResponses(model_, 16);

  void checkNumber(double expected, int actual) { DOUBLES_EQUAL(expected, actual, kHalfStep); }

  /// Folded weights against a column of plain ones times 2^15.
  void checkWeights(const Eigen::VectorXd& column, const FoldedWeights& folded) {
    const Eigen::VectorXd q15 = column * 32768;
    checkNumber(q15[3], folded[0]);
    for (int k = 1; k <= 3; ++k) {
      checkNumber((q15[3 + k] + q15[3 - k]) / 2, folded[static_cast<std::size_t>(k)]);
      checkNumber((q15[3 + k] - q15[3 - k]) / 2, folded[static_cast<std::size_t>(k + 3)]);
    }
    checkNumber(q15[7] / std::numbers::sqrt2, folded[7]);
  }

  void checkGradient(const Oracle& oracle, const FitRow& row) {
    const double unit = std::ldexp(1.0, row.gradient_exponent - 15);
    std::vector<Eigen::VectorXd> direction;
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::VectorXd column = oracle.gradient.col(static_cast<Eigen::Index>(i));
      checkNumber(column.norm() / unit, row.gradient_length[i]);
      const bool isZero = row.gradient_length[i] == 0;
      direction.push_back(isZero ? Eigen::VectorXd::Zero(8).eval() : column.normalized());
      checkWeights(direction[i], row.gradient[i]);
    }
    CHECK(std::max(row.gradient_length[0], row.gradient_length[1]) >= 1 << 14);
    checkNumber(direction[0].dot(direction[1]) * 32768, row.gradient_cosine);
  }

  void checkRow(const TableImage& image, std::size_t j) {
    const FitRow& row = image.rows[j];
    const Oracle oracle(model_, image.constants.gauge_count, peak_, static_cast<double>(j) / 64);
    const double scale = std::ldexp(1.0, image.constants.amplitude_exponent);
    for (int i = 0; i < 2; ++i) checkWeights(oracle.basis.col(i), row.basis[static_cast<std::size_t>(i)]);
    checkGradient(oracle, row);
    LONGS_EQUAL(0, row.reserved);
    checkNumber(oracle.amplitude(0, 0) * scale, row.load[0]);
    checkNumber(oracle.amplitude(0, 1) * scale, row.load[1]);
    checkNumber(oracle.amplitude(1, 1) * scale, row.load[2]);
    for (int i = 0; i < 4; ++i)
      checkNumber(oracle.amplitudeSlope(i / 2, i % 2) * scale, row.load_slope[static_cast<std::size_t>(i)]);
  }

  void checkTriples(FitSense sense, DirectionRange directions) {
    for (std::size_t j = 0; j < kFitRows; ++j)
      LONGS_EQUAL(bestTriple(responses_[j], directions).value(), image_->rows[j].triple[sense]);
  }

  /// Every 16-bit number of the image's rows.
  std::vector<int> allNumbers() {
    std::vector<int> numbers;
    for (const FitRow& row : image_->rows) {
      for (const auto& weights : {row.basis[0], row.basis[1], row.gradient[0], row.gradient[1]})
        numbers.insert(numbers.end(), weights.begin(), weights.end());
      numbers.insert(numbers.end(), row.gradient_length.begin(), row.gradient_length.end());
      numbers.push_back(row.gradient_cosine);
      numbers.insert(numbers.end(), row.load.begin(), row.load.end());
      numbers.insert(numbers.end(), row.load_slope.begin(), row.load_slope.end());
    }
    return numbers;
  }

  static config::FingerConfig withGauges(int count) {
    config::FingerConfig config;
    config.gauges.count = count;
    return config;
  }
  static WindowFits fitsOf(const WindowFit& fit) {
    WindowFits fits{};
    fits.rows.fill(fit);
    return fits;
  }
};

TEST(FitTable, EveryNumberOfTheRowsIsTheOraclesRounded) {
  for (std::size_t j = 0; j < kFitRows; ++j) checkRow(*image_, j);
}

TEST(FitTable, AFinerRingsRowsWeighTheOuterPair) {
  const auto finer = std::make_unique<TableImage>(buildTableImage(withGauges(24)));
  for (std::size_t j = 0; j < kFitRows; ++j) checkRow(*finer, j);
  CHECK(finer->rows[20].basis[1][7] != 0);
  for (const FitRow& row : image_->rows) LONGS_EQUAL(0, row.basis[0][7] | row.basis[1][7]);
}

TEST(FitTable, EveryRowNamesItsBestTriples) {
  checkTriples(kWithOffset, {-1.25 / 8, 1.25});
  checkTriples(kAgainstOffset, {-1.25, 1.25 / 8});
}

TEST(FitTable, NothingSaturatesInTheDefaultTables) {
  for (const int number : allNumbers()) CHECK(number > -32767 && number < 32767);
}

TEST(FitTable, TheAmplitudesUseTheirSixteenBits) {
  int largest = 0;
  for (const FitRow& row : image_->rows)
    for (const int number : {row.load[0], row.load[1], row.load[2], row.load_slope[0], row.load_slope[1],
                             row.load_slope[2], row.load_slope[3]})
      largest = std::max(largest, std::abs(number));
  CHECK(largest >= 16384);
}

TEST(FitTable, ThePeakIsThatOfTheModelOverTheGauge) {
  DOUBLES_EQUAL(460.603e-6, peakPerLoad(responses_), 5e-11);
}

TEST(FitTable, AmplitudesBeyondTheirFormatSaturate) {
  WindowFit fit = windowFit(responses_[5], kAllGauges);
  fit.amplitude(0, 0) = 10;
  fit.amplitude(0, 1) = -10;
  const FitTable table = fitTable(fitsOf(fit), 12);
  LONGS_EQUAL(32767, table[0].load[0]);
  LONGS_EQUAL(-32768, table[0].load[1]);
}

TEST(FitTable, AGradientThatIsRoundingNoiseIsZero) {
  WindowFit fit = windowFit(responses_[5], kAllGauges);
  fit.gradient.col(1) *= 1e-15;
  const FitRow row = fitTable(fitsOf(fit), 12)[0];
  LONGS_EQUAL(0, row.gradient_length[1]);
  LONGS_EQUAL(0, row.gradient_cosine);
  for (const std::int16_t weight : row.gradient[1]) LONGS_EQUAL(0, weight);
}

TEST(FitTable, ResponsesWithoutAUsableTripleAreRefused) {
  WindowResponses still = responses_;
  still[7].slope.setZero();
  try {
    windowFits(still, peak_, 1.25);
    FAIL("accepted");
  } catch (const Failure& failure) {
    LONGS_EQUAL(static_cast<int>(ExitCode::kUsage), static_cast<int>(failure.code()));
    STRCMP_CONTAINS("no three neighbouring gauges", failure.what());
  }
}
