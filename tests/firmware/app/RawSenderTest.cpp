#include "firmware/app/raw_sender.hpp"

#include "tests/doubles/fake_can_port.hpp"

#include <limits>
#include <numeric>
#include <vector>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;
using namespace strainfinger::doubles;

TEST_GROUP(RawSender) {
  static constexpr std::uint8_t kNode = 5;
  static constexpr std::uint32_t kPeriod_us = 1000;
  RawSender raw;
  FakeCanPort can;
  Calibration calibration;
  std::uint32_t sample = 0;

  void setup() override {
    for (std::size_t i = 0; i < kMaxGauges; ++i)
      calibration.zero_q15[i] = static_cast<std::int32_t>((0x8000 + i) << kCodeBits);
  }
  /// Gauge i reads 1000 sample + i.
  void pass(int samples, std::size_t gauges = 16, RawKind kind = RawKind::kReadings) {
    for (int i = 0; i < samples; ++i) {
      std::vector<std::uint16_t> codes(gauges);
      ++sample;
      std::iota(codes.begin(), codes.end(), static_cast<std::uint16_t>(1000 * sample));
      raw.take(codes, kind, sample, kPeriod_us);
      if (raw.any()) raw.send(can, kNode, calibration);
    }
  }
  std::vector<RawFrame> sent(RawKind kind) {
    std::vector<RawFrame> pages;
    for (const CanFrame& frame : can.sent)
      if (const auto page = decode<RawFrame>(frame); page && page->kind == kind) pages.push_back(*page);
    return pages;
  }
  std::vector<int> samplesSent() {
    std::vector<int> samples;
    for (const RawFrame& page : sent(RawKind::kReadings))
      if (page.page == 0) samples.push_back(page.sample);
    return samples;
  }
};

TEST(RawSender, IsSilentUnlessAsked) {
  pass(10);
  LONGS_EQUAL(0, can.sent.size());
  CHECK_FALSE(raw.any());
}

TEST(RawSender, ASetIsPagesOfThreeCodesOfOneSample) {
  raw.setRate(1000);
  pass(1);
  const std::vector<RawFrame> pages = sent(RawKind::kReadings);
  LONGS_EQUAL(6, pages.size());
  CHECK_TRUE(pages[1] == (RawFrame{1, RawKind::kReadings, 1, 1003, 1004, 1005}));
  CHECK_TRUE(pages[5] == (RawFrame{5, RawKind::kReadings, 1, 1015, 0, 0}));
  LONGS_EQUAL(0x405, can.sent[0].id);
}

TEST(RawSender, TheLargestRingHasElevenPages) {
  raw.setRate(500);
  pass(2, kMaxGauges);
  LONGS_EQUAL(11, sent(RawKind::kReadings).size());
  CHECK_TRUE(sent(RawKind::kReadings).back() == (RawFrame{10, RawKind::kReadings, 2, 2030, 2031, 0}));
}

TEST(RawSender, SetsThatGoIntoTheZeroAreMarked) {
  raw.setRate(1000);
  pass(1, 16, RawKind::kZeroing);
  LONGS_EQUAL(6, sent(RawKind::kZeroing).size());
}

TEST(RawSender, RatesAreKeptExactly) {
  for (const int rate_hz : {1, 3, 7, 100, 333, 999, 1000}) {
    can.sent.clear();
    raw.setRate(static_cast<std::uint16_t>(rate_hz));
    pass(1000);
    LONGS_EQUAL(rate_hz, samplesSent().size());
  }
}

TEST(RawSender, OfRareSetsItSendsEach) {
  raw.setRate(1000);
  for (std::uint32_t i = 1; i <= 10; ++i) {
    raw.take(std::vector<std::uint16_t>(16), RawKind::kReadings, i, 4000);
    raw.send(can, kNode, calibration);
  }
  LONGS_EQUAL(10, samplesSent().size());
}

TEST(RawSender, ZerosComeAPageASetOnceASecond) {
  raw.setRate(1000);
  pass(999);
  const std::vector<RawFrame> zeros = sent(RawKind::kZeros);
  LONGS_EQUAL(6, zeros.size());
  for (std::size_t i = 0; i < 6; ++i) {
    LONGS_EQUAL(i, zeros[i].page);
    LONGS_EQUAL(i + 1, zeros[i].sample);
    LONGS_EQUAL(0x8000 + 3 * i, zeros[i].code_0);
  }
  LONGS_EQUAL(0, zeros[5].code_1);
  pass(7);
  LONGS_EQUAL(12, sent(RawKind::kZeros).size());
}

TEST(RawSender, WhereSetsAreRareAllZerosComeAtOnce) {
  raw.setRate(100);
  pass(10);
  LONGS_EQUAL(6, sent(RawKind::kReadings).size());
  LONGS_EQUAL(6, sent(RawKind::kZeros).size());
}

TEST(RawSender, ZerosAreRoundedToACode) {
  calibration.zero_q15[0] = (0x7000 << kCodeBits) + (1 << (kCodeBits - 1));
  calibration.zero_q15[1] = (0x7000 << kCodeBits) + (1 << (kCodeBits - 1)) - 1;
  calibration.zero_q15[2] = std::numeric_limits<std::int32_t>::max();
  raw.setRate(1000);
  pass(1);
  CHECK_TRUE(sent(RawKind::kZeros).at(0) == (RawFrame{0, RawKind::kZeros, 1, 0x7001, 0x7000, 0xFFFF}));
}

TEST(RawSender, NewZerosAreSaidAtOnce) {
  raw.setRate(1000);
  pass(10);
  can.sent.clear();
  raw.sayZeros();
  pass(6);
  LONGS_EQUAL(6, sent(RawKind::kZeros).size());
}

TEST(RawSender, PagesWaitForThePortAndTheNextSetIsLeftOut) {
  raw.setRate(1000);
  can.room = 2;
  pass(1);
  CHECK_TRUE(raw.any());
  can.room = 1;
  pass(1);
  can.room = SIZE_MAX;
  pass(2);
  CHECK_TRUE(samplesSent() == (std::vector<int>{1, 4}));
  const std::vector<RawFrame> pages = sent(RawKind::kReadings);
  LONGS_EQUAL(12, pages.size());
  for (std::size_t i = 0; i < 6; ++i) CHECK_TRUE(pages[i].page == i && pages[i].sample == 1);
}

TEST(RawSender, EndsWhenItIsToldTo) {
  raw.setRate(1000);
  can.room = 2;
  pass(1);
  raw.setRate(0);
  CHECK_FALSE(raw.any());
  can.room = SIZE_MAX;
  pass(10);
  LONGS_EQUAL(2, can.sent.size());
}
