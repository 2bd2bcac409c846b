// The whole pipeline on tables that checkTableImage() accepts but no finger has: full-length columns at no
// particular angle, coefficients at the ends of their words, any scales; and on codes that no contact gives.
// Where the sanitizers watch (preset `sanitize`), an overflow ends the test.
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "firmware/core/estimate.hpp"
#include "firmware/core/pipeline.hpp"
#include "firmware/core/report.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(Extremes) {
  static constexpr int kImages = 60, kSets = 40, kSetsOfOneRing = 4;
  std::mt19937 random_{4711};
  std::unique_ptr<TableImage> image_ = std::make_unique<TableImage>();
  const TableConstants& constants_ = image_->constants;
  std::vector<std::uint16_t> codes_;

  void setup() override { std::printf("seed 4711 "); }

  int upTo(int least, int most) {
    return least + static_cast<int>(random_() % static_cast<unsigned>(most - least + 1));
  }
  template <typename Integer>
  void fillAny(Integer & number) {
    constexpr auto kMost = std::numeric_limits<Integer>::max(), kLeast = std::numeric_limits<Integer>::min();
    const int end = upTo(0, 3);
    number = end == 0 ? kMost : end == 1 ? kLeast : static_cast<Integer>(random_());
  }
  /// As long as it may be, in any direction, some of its weights 0.
  void fillColumn(FoldedWeights & column) {
    std::array<double, 8> direction;
    for (double& each : direction) each = upTo(0, 2) == 0 ? 0 : upTo(-1'000, 1'000);
    direction[1] += 1;
    double energy = direction[0] * direction[0];
    for (std::size_t i = 1; i < direction.size(); ++i) energy += 2 * direction[i] * direction[i];
    const double scale = std::sqrt(static_cast<double>(kMostWeightEnergy) / energy);
    for (std::size_t i = 0; i < direction.size(); ++i)
      column[i] = static_cast<std::int16_t>(std::clamp(std::trunc(scale * direction[i]), -32768.0, 32767.0));
  }
  void fillRow(FitRow & row) {
    for (FoldedWeights* column : {&row.basis[0], &row.basis[1], &row.gradient[0], &row.gradient[1]})
      fillColumn(*column);
    for (std::int16_t& each : row.gradient_length) fillAny(each);
    for (std::int16_t& each : row.load) fillAny(each);
    for (std::int16_t& each : row.load_slope) fillAny(each);
    fillAny(row.gradient_cosine);
    row.gradient_exponent = static_cast<std::int8_t>(upTo(kLeastGradientExponent, kMostGradientExponent));
    for (std::uint8_t& each : row.triple) each = static_cast<std::uint8_t>(upTo(0, kTriples - 1));
  }
  void fillStart(StartWeights & weights) {
    FoldedWeights column{};
    fillColumn(column);
    std::copy(column.begin() + 4, column.end(), weights.begin());
  }
  /// Half as long as a column may be.
  void fillNear(NearRow & row) {
    const auto half = [&] {
      FoldedWeights column{};
      fillColumn(column);
      for (std::int16_t& each : column) each = static_cast<std::int16_t>(each / 2);
      return column;
    };
    const FoldedWeights normal = half(), pressing = half(), pulling = half();
    row.normal = {normal[0], normal[1], normal[4], 0};
    row.normal_load = {pressing[0], pressing[4]};
    row.tangential_load = {pulling[0], pulling[4]};
  }
  void fillConstants(TableConstants & constants) {
    fillAny(constants.pitch_turn_q35);
    fillAny(constants.first_angle_q32);
    fillAny(constants.load_scale);
    fillAny(constants.force_per_load_q16);
    fillAny(constants.friction_cone_q8);
    fillAny(constants.tail_q16);
    constants.gate_shift = static_cast<std::uint8_t>(upTo(0, kMostGateShift));
    constants.reading_gain = ((1 << (15 + constants.gate_shift)) - 1) * 2 >> upTo(0, 2);
    constants.noise_variance = static_cast<std::uint32_t>(upTo(0, kMostNoiseVariance));
    constants.noise_variance_exponent = static_cast<std::int8_t>(
        upTo(0, 3) == 0 ? upTo(kLeastNoiseExponent, kMostNoiseExponent) : upTo(-8, 2 * constants.gate_shift));
    constants.load_exponent = static_cast<std::int16_t>(upTo(-70, -3 - constants.gate_shift));
    constants.gate_on = static_cast<std::uint32_t>(upTo(1, 1'000));
    constants.gate_off = constants.gate_on / 2;
    constants.adc_rail = 0xFFF0;
    constants.mirror_sign = static_cast<std::int8_t>(2 * upTo(0, 1) - 1);
    constants.anchor_sign = static_cast<std::int8_t>(2 * upTo(0, 1) - 1);
    constants.gauge_count = static_cast<std::uint8_t>(2 * upTo(kMinGauges / 2, kMaxGauges / 2));
    constants.anchor_rule = static_cast<AnchorRule>(upTo(0, 1));
    constants.near_pole_q15 = static_cast<std::uint16_t>(upTo(kLeastNearPole_q15, 0xFFFF));
    constants.firm_exponent = static_cast<std::uint8_t>(upTo(kLeastFirmExponent, kMostFirmExponent));
    constants.scan_step = static_cast<std::uint8_t>(upTo(0, 1) == 0 ? kMinScanStep : kMaxScanStep);
    for (ScanSpan& span : constants.scan_span)
      span = upTo(0, 2) == 0 ? ScanSpan::of(kFirstScanRow, 0) : ScanSpan::of(4 + 8 * upTo(0, 1), 36);
  }
  void fillImage() {
    *image_ = {};
    image_->magic = kTableMagic;
    image_->format = kTableFormat;
    image_->image_bytes = sizeof(TableImage);
    fillConstants(image_->constants);
    if (image_->constants.anchor_rule != AnchorRule::kExhaustive)
      for (StartWeights& weights : image_->start) fillStart(weights);
    for (FitRow& row : image_->rows) fillRow(row);
    for (NearRow& row : image_->near) fillNear(row);
    image_->gains.exponent = static_cast<std::uint8_t>(upTo(kLeastGainExponent, kMostGainExponent));
    for (std::int8_t& each : image_->gains.correction) each = static_cast<std::int8_t>(upTo(-64, 0));
    image_->crc32 = crc32(checkedBytes(*image_));
    CHECK(checkTableImage(*image_) == TableFault::kNone);
    codes_.resize(constants_.gauge_count);
  }
  /// Anything; all at rails; one peak as high as it may be; one gauge that stands out of noise.
  void fillCodes() {
    const int kind = upTo(0, 3), peak = upTo(0, constants_.gauge_count - 1), height = upTo(-32'000, 32'000);
    for (int gauge = 0; gauge < constants_.gauge_count; ++gauge) {
      const double apart = std::remainder(gauge - peak, int{constants_.gauge_count});
      const std::array<int, 4> code{
          upTo(0, 0xFFFF), 0xFFFF * upTo(0, 1),
          0x8000 + static_cast<int>((height < 0 ? -32'000 : 32'000) * std::exp(-apart * apart)),
          0x8000 + (gauge == peak ? height : upTo(-50, 50))};
      codes_[static_cast<std::size_t>(gauge)] =
          static_cast<std::uint16_t>(code[static_cast<std::size_t>(kind)]);
    }
  }
  void checkFit(const Fit& fit) {
    CHECK(fit.best.position >= 0 && fit.best.position < constants_.gauge_count * kOnePitch);
    const Contact contact = estimate(constants_, fit);
    CHECK(contact.quality <= 100);
    if (fit.ambiguous) CHECK(contact.uncertain);
  }
  /// Returns how many sample sets were fitted. A ring's gauges would soon be out of use, so it is a new one
  /// now and then.
  int processMany() {
    int fits = 0;
    std::optional<Pipeline> pipeline;
    TouchReporter reporter(0, {});
    for (int set = 0; set < kSets; ++set) {
      if (set % kSetsOfOneRing == 0)
        pipeline.emplace(*image_, upTo(0, 1) == 0 ? FitMode::kRefined : FitMode::kThreePoint);
      fillCodes();
      const Observation& observation = pipeline->process(codes_);
      reporter.frames(constants_, observation, static_cast<std::uint32_t>(set));
      if (!observation.fit) continue;
      checkFit(*observation.fit);
      ++fits;
    }
    return fits;
  }
  /// Interval after interval, each with other readings.
  void holdTouches() {
    constexpr int kIntervals = 3;
    ZeroTracker tracker;
    Calibration calibration = tabledCalibration(*image_);
    for (int interval = 0; interval < kIntervals; ++interval) {
      Readings readings;
      fillCodes();
      condition(nominalCalibration(constants_), codes_, readings);
      const auto strains = readings.strains(constants_.gauge_count);
      const std::uint32_t energy = gateEnergy(constants_, strains);
      if (energy < constants_.gate_on) continue;
      const std::optional<Fit> fit = locate(*image_, FitMode::kRefined, strains, energy);
      for (int set = 0; set < ZeroTracker::kInterval + ZeroTracker::kConvinced; ++set)
        tracker.take(*image_, strains, energy, fit, 0, calibration);
    }
    const GaugesFrame frame = gaugesFrame(0, tracker, static_cast<std::uint32_t>(random_()));
    CHECK(frame.out_of_use == 0);
  }
};

TEST(Extremes, NoTablesThatPassAndNoCodesOverflowAnything) {
  int fits = 0;
  for (int image = 0; image < kImages; ++image) {
    fillImage();
    fits += processMany();
  }
  CHECK(fits > kImages * kSets / 4);
}

TEST(Extremes, NorDoZerosThatFollowThem) {
  for (int image = 0; image < kImages; ++image) {
    fillImage();
    holdTouches();
  }
}
