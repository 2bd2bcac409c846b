#include "common/table_image.hpp"

#include <array>
#include <initializer_list>
#include <limits>
#include <memory>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(TableImage) {
  std::unique_ptr<TableImage> image_ = std::make_unique<TableImage>();

  /// The least an image needs to be taken, whatever its rows hold.
  void setup() override {
    image_->magic = kTableMagic;
    image_->format = kTableFormat;
    image_->image_bytes = sizeof(TableImage);
    image_->constants.gauge_count = 16;
    image_->constants.mirror_sign = image_->constants.anchor_sign = 1;
    image_->constants.scan_step = kMaxScanStep;
    image_->constants.load_exponent = -50;
    image_->constants.firm_exponent = 16;
    image_->constants.near_pole_q15 = 15'000;
    image_->constants.scan_span.fill(ScanSpan::of(kFirstScanRow, kLastScanRow));
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
  image_->rows[0].reserved = 1;
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
  for (std::size_t i = kTableHeaderBytes; i < sizeof(TableImage); i += 5) {
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
  constants.gate_shift = 13;
  checkDomain(constants.reading_gain, {0, 1, (1 << 29) - 2},
              {-1, (1 << 29) - 1, std::numeric_limits<int>::max()});
  checkDomain(constants.mirror_sign, {1, -1}, {0, 2, -128});
  checkDomain(constants.anchor_sign, {1, -1}, {0, 2, -128});
  checkDomain(constants.anchor_rule, {0, 1}, {2, 255});
  checkDomain(constants.scan_step, {4, 8}, {0, 3, 5, 9, 255});
  checkDomain(constants.scan_span[15].packed, {0x01, 0x09, 0x11, 0x73, 0x91},
              {0x00, 0x02, 0x10, 0x21, 0x37, 0xB1, 0xFF});
  checkDomain(constants.firm_exponent, {13, 31}, {0, 12, 32, 255});
  checkDomain(constants.near_pole_q15, {13312, 65535}, {0, 13311});
  checkDomain(image_->rows[39].gradient_exponent, {-3, 12}, {-4, 13, -128, 127});
  checkDomain(image_->rows[39].triple[1], {0, 34}, {35, 255});
  checkDomain(image_->parameters.component, {0, 1, 2}, {3, 255});
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
  checkDomain(gains.exponent, {6, 15, 0}, {1, 5, 16, 255});
  checkDomain(gains.correction[31], {0}, {1, -1});  // without an exponent
  gains.exponent = 7;
  checkDomain(gains.correction[31], {-128, 127, 0}, {});
  gains.exponent = 6;
  checkDomain(gains.correction[0], {-64, 63}, {-65, -128, 64, 127});
}

TEST(TableImage, FaultsKeepTheirNumbers) {
  LONGS_EQUAL(0, static_cast<int>(TableFault::kNone));
  LONGS_EQUAL(1, static_cast<int>(TableFault::kTooShort));
  LONGS_EQUAL(2, static_cast<int>(TableFault::kMagic));
  LONGS_EQUAL(3, static_cast<int>(TableFault::kFormat));
  LONGS_EQUAL(4, static_cast<int>(TableFault::kLength));
  LONGS_EQUAL(5, static_cast<int>(TableFault::kChecksum));
  LONGS_EQUAL(6, static_cast<int>(TableFault::kConstants));
}

TEST(TableImage, WeightsLongerThanOneAreRefused) {
  image_->rows[7].gradient[1][0] = 32767;
  checkDomain(image_->rows[7].gradient[1][6], {0, 300, -300}, {500, -500});
  image_->rows[7].gradient[1] = {};
  checkDomain(image_->rows[9].basis[0][2], {23170, -23170}, {23180, 32767, -32768});
}

TEST(TableImage, StartWeightsWhoseSumWouldNotFitAreRefused) {
  checkDomain(image_->start[15][0], {23170, -23170}, {23180, 32767, -32768});
  image_->start[3] = {{16384, 16384}};
  checkDomain(image_->start[3][3], {0, 300, -300}, {500, -500});
}

TEST(TableImage, NearRowsWhoseDifferencesWouldNotFitAreRefused) {
  NearRow& row = image_->near[12];
  checkDomain(row.normal[0], {16384, -16384, 0}, {16390, 32767, -32768});
  checkDomain(row.normal[2], {11585, -11585, 0}, {11600, -32768});
  checkDomain(row.normal[3], {0}, {1, -1});
  checkDomain(row.normal_load[0], {16384, -16384, 0}, {16390, -32768});
  checkDomain(row.normal_load[1], {11585, 0}, {11600, 32767});
  checkDomain(row.tangential_load[1], {-11585, 0}, {-11600, -32768});
  checkDomain(row.tangential_load[0], {16384}, {16390});
}

TEST(TableImage, WhereEveryWindowIsLookedAtNoStartIsTold) {
  image_->constants.anchor_rule = AnchorRule::kExhaustive;
  checkDomain(image_->start[7][0], {0}, {1, -1});
  image_->constants.anchor_rule = AnchorRule::kSecondDifference;
  checkDomain(image_->start[7][0], {1, -1}, {});
}
