#include "common/table_image.hpp"

#include <array>
#include <initializer_list>
#include <limits>
#include <memory>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(TableImage) {
  std::unique_ptr<TableImage> image_ = std::make_unique<TableImage>();

  /// The least an image needs to be taken, whatever its patches hold.
  void setup() override {
    image_->magic = kTableMagic;
    image_->format = kTableFormat;
    image_->image_bytes = sizeof(TableImage);
    TableConstants& constants = image_->constants;
    constants.gauge_count = 16;
    constants.mirror_sign = constants.peak_sign = 1;
    constants.load_exponent = -50;
    constants.cone_q8 = 320;
    constants.node_count = 96;
    constants.cell_count = 8;
    for (std::uint16_t k = 0; k <= 8; ++k) constants.cell_edge_q15[k] = static_cast<std::uint16_t>(k << 12);
    constants.cell_rate_q8.fill(8 << 8);
    for (std::uint32_t i = 0; i < kMaxGauges; ++i) image_->gauge_angle_q32[i] = i << 27;
    sign();
  }
  void sign() { image_->crc32 = crc32(checkedBytes(*image_)); }
  void flip(std::size_t byte, std::size_t bit) {
    auto* bytes = reinterpret_cast<std::byte*>(image_.get());
    bytes[byte] ^= std::byte(1 << bit);
  }
  void checkFault(TableFault expected) {
    LONGS_EQUAL(static_cast<int>(expected), static_cast<int>(checkTableImage(*image_)));
  }
  /// Sets a constant to values it may and may not have, under a right checksum.
  template <typename Constant>
  void checkDomain(Constant & constant, std::initializer_list<int> good, std::initializer_list<int> bad) {
    const auto set = [&](int value, TableFault expected) {
      constant = static_cast<Constant>(value);
      sign();
      checkFault(expected);
    };
    for (const int value : bad) set(value, TableFault::kConstants);
    for (const int value : good) set(value, TableFault::kNone);
  }
};

TEST(TableImage, AWholeImageIsTaken) { checkFault(TableFault::kNone); }

TEST(TableImage, TheChecksumIsOfEverythingBehindTheHeader) {
  LONGS_EQUAL(16, kTableHeaderBytes);
  LONGS_EQUAL(sizeof(TableImage) - 16, checkedBytes(*image_).size());
  POINTERS_EQUAL(&image_->parameters, checkedBytes(*image_).data());
}

TEST(TableImage, WhatIsWrongFirstIsNamed) {
  image_->constants.spacing = RingSpacing::kSparse;
  checkFault(TableFault::kChecksum);
  image_->image_bytes -= 1;
  checkFault(TableFault::kLength);
  image_->format += 1;
  checkFault(TableFault::kFormat);
  image_->magic += 1;
  checkFault(TableFault::kMagic);
}

TEST(TableImage, AReservedBitIsAnotherFormat) {
  image_->reserved = 0x8000;
  checkFault(TableFault::kFormat);
}

TEST(TableImage, AFlippedBitBehindTheHeaderIsFound) {
  for (std::size_t i = kTableHeaderBytes; i < sizeof(TableImage); i += 23) {
    flip(i, i % 8);
    checkFault(TableFault::kChecksum);
    flip(i, i % 8);
  }
}

// All of them. What follows a flipped byte need not be gone through: a step of the division maps different
// remainders to different ones, whatever the byte.
TEST(TableImage, NoFlippedBitLeavesTheChecksumAsItWas) {
  std::uint32_t before = 0;
  for (const std::byte byte : checkedBytes(*image_)) {
    const std::uint32_t after = crc32(std::array{byte}, before);
    for (int bit = 0; bit < 8; ++bit) CHECK(crc32(std::array{byte ^ std::byte(1 << bit)}, before) != after);
    before = after;
  }
}

TEST(TableImage, ConstantsThatLoopsAndShiftsRelyOnStayInTheirDomain) {
  TableConstants& constants = image_->constants;
  checkDomain(constants.gauge_count, {12, 14, 32, 16}, {0, 10, 13, 33, 34, 255});
  checkDomain(constants.gate_shift, {0, 14}, {15, 32, 255});
  checkDomain(constants.spacing, {0, 1, 2}, {3, 255});
  constants.gate_shift = 13;
  checkDomain(constants.reading_gain, {0, 1, (1 << 29) - 2},
              {-1, (1 << 29) - 1, std::numeric_limits<int>::max()});
  checkDomain(constants.mirror_sign, {1, -1}, {0, 2, -128});
  checkDomain(constants.peak_sign, {1, -1}, {0, 2, -128});
  checkDomain(constants.width_is_known, {1, 0}, {2, 255});
  checkDomain(constants.known_moment_q20, {1 << 20, 0}, {(1 << 20) + 1, -1});
  checkDomain(constants.place_error_q32, {1 << 30, 0}, {(1 << 30) + 1, -1});
  checkDomain(constants.cone_q8, {1, 65535}, {0});
  checkDomain(constants.reach_q32, {0, std::numeric_limits<int>::max()},
              {-1, std::numeric_limits<int>::min()});
  checkDomain(image_->parameters.component, {0, 1, 2}, {3, 255});
}

TEST(TableImage, NodesAndCellsArePatchesThatAreThere) {
  TableConstants& constants = image_->constants;
  checkDomain(constants.node_count, {8, 125}, {0, 7, 126, 65535});
  checkDomain(constants.cell_count, {8}, {0, 7, 9, 255});  // the last edge is not where seven cells end
}

TEST(TableImage, CellsAscendFromNoWidthToTheLargest) {
  auto& edge_q15 = image_->constants.cell_edge_q15;
  checkDomain(edge_q15[0], {0}, {1, 65535});
  checkDomain(edge_q15[8], {32768}, {32767, 32769, 0});
  checkDomain(edge_q15[4], {12289, 20479}, {12288, 20480, 0, 65535});
}

// 2 over 1/8 is 16; a step more is what rounding up makes of it.
TEST(TableImage, ACellsRateIsNoLargerThanItsWidthHas) {
  checkDomain(image_->constants.cell_rate_q8[7], {0, 4096, 4097}, {4098, 65535});
}

TEST(TableImage, GaugesAscendRoundTheRingFromAnyAngle) {
  auto& angle_q32 = image_->gauge_angle_q32;
  checkDomain(angle_q32[1], {1, (1 << 28) - 1}, {0, 1 << 28, -1});
  angle_q32[1] = 1 << 27;
  for (std::uint32_t& angle : angle_q32) angle -= 1 << 27;  // the second is at 0, the 16th at 14 << 27
  checkDomain(angle_q32[0], {-1 << 27, -1, (14 << 27) + 1}, {0, 1, 14 << 27});
}

TEST(TableImage, TheNoiseThatStandardErrorsAreMadeOfStaysInItsDomain) {
  TableConstants& constants = image_->constants;
  checkDomain(constants.noise_variance, {0, 1, 1 << 24}, {(1 << 24) + 1, 1 << 25, -1});
  checkDomain(constants.noise_variance_exponent, {-62, 0, 36}, {-63, -128, 37, 127});
}

TEST(TableImage, LoadsAreShiftedRightHoweverLargeTheReadingsAre) {
  TableConstants& constants = image_->constants;
  checkDomain(constants.load_exponent, {-32768, -50, -3}, {-2, 0, 32767});
  constants.gate_shift = 14;
  checkDomain(constants.load_exponent, {-17}, {-16, -3});
}

TEST(TableImage, GainsThatConditioningReliesOnStayInTheirDomain) {
  image_->constants.gate_shift = 13;
  image_->constants.reading_gain = 1 << 28;  // 2^29 - 2 at most
  GaugeGains& gains = image_->gains;
  checkDomain(gains.are_known, {1, 0}, {2, 255});
  checkDomain(gains.correction_q14[31], {0}, {1, -1});  // without a calibration
  gains.are_known = 1;
  checkDomain(gains.correction_q14[31], {-8192, 8191, 0}, {});
  checkDomain(gains.correction_q14[0], {-16384, 16383}, {-16385, -32768, 16384, 32767});
}

TEST(TableImage, NoGaugeIsDeeperWithoutAStepAndShapesFitTheirWords) {
  GaugeDepths& depths = image_->depths;
  checkDomain(depths.steps[31], {0}, {1, -1});  // without a step
  depths.step_nm = 1;
  checkDomain(depths.steps[31], {-128, 127, 0}, {});
  checkDomain(depths.shape_shift, {0, 8}, {9, 255});
}

TEST(TableImage, PatchesWhoseSumsWouldNotFitAreRefused) {
  PatchPair& pair = image_->patches[kMostPatches - 1];
  checkDomain(pair.normal[0], {32767, -32767, 0}, {-32768});
  pair.normal = {32767 - 5000, 1000, -1000, 1000, -1000, 1000};
  checkDomain(pair.normal[4], {1000, -1000, 0}, {1001, -1001, 32767, -32768});
  checkDomain(pair.tangential[5], {32767, -32767, 0}, {-32768});
}
