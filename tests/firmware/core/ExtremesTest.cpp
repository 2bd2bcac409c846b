// The whole pipeline on tables that checkTableImage() accepts but no finger has: patches at random, constants
// at the ends of their words, any scales; and on codes that no contact gives. Where the sanitizers watch
// (preset `sanitize`), an overflow ends the test.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <limits>
#include <memory>
#include <optional>
#include <random>
#include <vector>

#include "firmware/core/estimate.hpp"
#include "firmware/core/pipeline.hpp"
#include "firmware/core/report.hpp"
#include "host/tables/table_builder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(Extremes) {
  static constexpr int kImages = 40, kTouches = 8, kSetsOfATouch = 15;
  std::mt19937 random_{4711};
  std::unique_ptr<TableImage> image_ = std::make_unique<TableImage>();
  const TableConstants& constants_ = image_->constants;
  std::vector<std::uint16_t> codes_;
  std::uint32_t now_us_ = 0;

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
  /// Weights whose sizes add up to as much as they may.
  void fillPatch(ResponsePatch & patch) {
    std::array<double, 6> part;
    double sum = 0;
    for (double& each : part) sum += std::abs(each = upTo(0, 2) == 0 ? 0 : upTo(-1000, 1000));
    const double scale = (upTo(0, 1) == 0 ? 32'767 : upTo(0, 32'767)) / std::max(sum, 1.0);
    for (std::size_t i = 0; i < part.size(); ++i)
      patch[i] = static_cast<std::int16_t>(std::trunc(scale * part[i]));
  }
  void fillCells(TableConstants & constants) {
    constants.cell_count = static_cast<std::uint8_t>(upTo(1, kMostCells));
    constants.node_count = static_cast<std::uint16_t>(upTo(kLeastNodes, kMostPatches / constants.cell_count));
    for (std::size_t k = 0; k < constants.cell_count; ++k) {
      const int left = (1 << 15) - constants.cell_edge_q15[k],
                cells = constants.cell_count - static_cast<int>(k);
      const int width = cells == 1 ? left : upTo(1, left - cells + 1);
      constants.cell_edge_q15[k + 1] = static_cast<std::uint16_t>(constants.cell_edge_q15[k] + width);
      constants.cell_rate_q8[k] = static_cast<std::uint16_t>(std::min((2 << 23) / width, 0xFFFF));
    }
  }
  void fillNoise(TableConstants & constants) {
    constants.noise_variance = static_cast<std::uint32_t>(upTo(0, kMostNoiseVariance));
    constants.noise_variance_exponent = static_cast<std::int8_t>(
        upTo(0, 3) == 0 ? upTo(kLeastNoiseExponent, kMostNoiseExponent) : upTo(-8, 2 * constants.gate_shift));
    fillAny(constants.model_error_q16);
    if (upTo(0, 1) == 0) constants.model_error_q16 = 0;
    if (upTo(0, 1) == 0) return;
    constants.place_error_q32 = static_cast<std::uint32_t>(upTo(0, kMostPlaceError_q32));
    fillAny(constants.load_scale_error_q16);
    fillAny(constants.load_error_q16);
    fillAny(constants.moment_error_q16);
  }
  void fillConstants(TableConstants & constants) {
    fillAny(constants.load_scale);
    fillAny(constants.force_per_load_q16);
    fillAny(constants.largest_moment_um2);
    fillAny(constants.friction_q8);
    constants.cone_q8 = static_cast<std::uint16_t>(upTo(1, 0xFFFF));
    constants.known_moment_q20 = static_cast<std::uint32_t>(upTo(0, 1 << kMomentBits));
    constants.width_is_known = static_cast<std::uint8_t>(upTo(0, 1));
    constants.reach_q32 = static_cast<std::uint32_t>(random_() >> 1);
    constants.gate_shift = static_cast<std::uint8_t>(upTo(0, kMostGateShift));
    constants.reading_gain = ((1 << (15 + constants.gate_shift)) - 1) * 2 >> upTo(0, 2);
    constants.load_exponent = static_cast<std::int16_t>(upTo(-70, -3 - constants.gate_shift));
    constants.gate_on = static_cast<std::uint32_t>(upTo(1, 1'000));
    constants.gate_off = constants.gate_on / 2;
    constants.adc_rail = 0xFFF0;
    constants.mirror_sign = static_cast<std::int8_t>(2 * upTo(0, 1) - 1);
    constants.peak_sign = static_cast<std::int8_t>(2 * upTo(0, 1) - 1);
    constants.gauge_count = static_cast<std::uint8_t>(2 * upTo(kMinGauges / 2, kMaxGauges / 2));
    fillNoise(constants);
    fillCells(constants);
  }
  /// Ascending from anywhere, in steps of any size.
  void fillAngles() {
    std::vector<std::uint32_t> steps(constants_.gauge_count);
    for (std::uint32_t& step : steps) step = static_cast<std::uint32_t>(random_() | 1);
    std::sort(steps.begin() + 1, steps.end());
    steps.erase(std::unique(steps.begin() + 1, steps.end()), steps.end());
    for (std::size_t i = 0; i < steps.size(); ++i)
      image_->gauge_angle_q32[i] = steps[0] + (i == 0 ? 0 : steps[i]);
  }
  void fillDepths(GaugeDepths & depths) {
    fillAny(depths.step_nm);
    for (std::int16_t* slope : {&depths.normal_turn_q11, &depths.tangential_turn_q11, &depths.tangential_q15})
      fillAny(*slope);
    depths.shape_shift = static_cast<std::uint8_t>(upTo(0, kMostDepthShapeShift));
    for (GaugeDepths::Shape* shape : {&depths.normal_shape, &depths.tangential_shape})
      for (std::int8_t& each : *shape) fillAny(each);
    if (!depths.areKnown()) return;
    for (std::int8_t& each : depths.steps) fillAny(each);
  }
  void fillImage() {
    *image_ = {};
    image_->magic = kTableMagic;
    image_->format = kTableFormat;
    image_->image_bytes = sizeof(TableImage);
    fillConstants(image_->constants);
    fillAngles();
    for (PatchPair& pair : image_->patches) {
      fillPatch(pair.normal);
      fillPatch(pair.tangential);
    }
    image_->gains.are_known = 1;
    for (std::int16_t& each : image_->gains.correction_q14) each = static_cast<std::int16_t>(upTo(-16384, 0));
    fillDepths(image_->depths);
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
  void checkContacts(const TableConstants& constants, const Answer& answer, const Linearisation& fit) {
    for (int k = 0; k < answer.solution.hypothesis.contacts; ++k) {
      const Contact contact = estimate(constants, answer, unitErrors(fit), k);
      CHECK(contact.quality <= 100);
      if (contact.ambiguous) CHECK(contact.uncertain);
    }
  }
  /// Returns how many sample sets were touched.
  int process(const TableImage& tables, Pipeline& pipeline, TouchReporter& reporter, int sets) {
    int touched = 0;
    for (int set = 0; set < sets; ++set, now_us_ += 1000) {
      const Observation& observation = pipeline.process(codes_);
      reporter.frames(tables.constants, observation, pipeline.answer(), pipeline.linearisation(), now_us_);
      if (!observation.touched) continue;
      checkContacts(tables.constants, pipeline.answer(), pipeline.linearisation());
      ++touched;
    }
    return touched;
  }
  FitMode anyMode() { return upTo(0, 1) == 0 ? FitMode::kRefined : FitMode::kThreePoint; }
};

TEST(Extremes, NoTablesThatPassAndNoCodesOverflowAnything) {
  int touched = 0;
  for (int image = 0; image < kImages; ++image) {
    fillImage();
    Pipeline pipeline(*image_, anyMode());
    TouchReporter reporter(0, {});
    for (int touch = 0; touch < kTouches; ++touch) {
      fillCodes();
      touched += process(*image_, pipeline, reporter, kSetsOfATouch);
    }
  }
  CHECK(touched > kImages * kTouches * kSetsOfATouch / 8);
}

TEST(Extremes, NorDoZerosThatFollowThem) {
  for (int image = 0; image < kImages / 4; ++image) {
    fillImage();
    Pipeline pipeline(*image_, FitMode::kRefined);
    TouchReporter reporter(0, {});
    for (int interval = 0; interval < 3; ++interval) {
      fillCodes();
      if (interval == 1) std::fill(codes_.begin(), codes_.end(), std::uint16_t{0x8001});
      process(*image_, pipeline, reporter, ZeroTracker::kUntilFollowed + 1);
    }
    const GaugesFrame frame = gaugesFrame(0, pipeline.zeroTracker(), static_cast<std::uint32_t>(random_()));
    UNSIGNED_LONGS_EQUAL(0, frame.out_of_use);
  }
}

// Of any sign and size that conditioning can give: usableGain().
TEST(Extremes, NorDoAnyStrains) {
  for (int image = 0; image < kImages; ++image) {
    fillImage();
    Locator locator(anyMode());
    std::vector<std::int32_t> strains(constants_.gauge_count);
    for (int touch = 0; touch < kTouches; ++touch) {
      for (std::int32_t& strain : strains) {
        fillAny(strain);
        strain >>= 16 - constants_.gate_shift;
      }
      const GaugeSet gauges =
          allGauges(constants_.gauge_count) & static_cast<GaugeSet>(random_() | random_());
      const auto noise_q4 =
          std::max<std::uint32_t>(static_cast<std::uint32_t>(random_() >> upTo(0, 31)), kConfiguredNoise_q4);
      for (int set = 0; set < kSetsOfATouch; ++set) locator.update(*image_, strains, gauges, noise_q4);
      checkContacts(constants_, locator.answer(), locator.linearisation());
    }
  }
}

// A fuzzer found the first: an earlier locator negated the least number there is.
TEST(Extremes, CodesThatNoContactGivesAreNoHarmToTheDefaultFinger) {
  const TableImage tables = tables::buildTableImage({});
  const std::array<std::array<std::uint16_t, 16>, 3> all{
      {{0x4530, 0x6D21, 0xFBFA, 0xC577, 0xFFFF, 0xFFFF, 0xFFFF, 0x0000, 0x0000, 0xFFFF, 0x0000, 0xFFFF,
        0xFFFF, 0x0000, 0xD537, 0x0E7D},
       {0xFFFF, 0, 0xFFFF, 0, 0xFFFF, 0, 0xFFFF, 0, 0xFFFF, 0, 0xFFFF, 0, 0xFFFF, 0, 0xFFFF, 0},
       {1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1, 1}}};
  for (const FitMode mode : {FitMode::kRefined, FitMode::kThreePoint})
    for (const auto& codes : all) {
      Pipeline pipeline(tables, mode);
      TouchReporter reporter(0, {});
      codes_.assign(codes.begin(), codes.end());
      process(tables, pipeline, reporter, 300);
    }
}
