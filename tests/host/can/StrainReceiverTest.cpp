#include "host/can/strain_receiver.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using can::StrainReceiver;

TEST_GROUP(StrainReceiver) {
  static constexpr std::uint8_t kListened = 5;
  StrainReceiver receiver{kListened, 3, 0.03};  // one page a set; 32768 codes are 0.03

  auto take(RawKind kind, std::uint16_t code, std::uint8_t node = kListened) {
    RawFrame page{0, kind, 0};
    page.code_0 = code;
    page.code_1 = 32768;
    page.code_2 = 32768;
    return receiver.take(encode(page, node));
  }
};

TEST(StrainReceiver, StrainsAreCodesLessTheZeroOverTheRange) {
  take(RawKind::kZeros, 32768 + 100);
  const auto set = take(RawKind::kReadings, 32768 + 100 - 16384);
  CHECK_TRUE(set.has_value());
  LONGS_EQUAL(3, set->strains.size());
  DOUBLES_EQUAL(-0.015, set->strains[0], 1e-12);
  DOUBLES_EQUAL(0, set->strains[1], 0);
  CHECK_FALSE(set->zeroing);
}

TEST(StrainReceiver, BeforeTheZerosAreToldThereIsNone) {
  CHECK_FALSE(take(RawKind::kReadings, 30000).has_value());
  CHECK_FALSE(take(RawKind::kZeros, 30000).has_value());
  CHECK_TRUE(take(RawKind::kReadings, 30000).has_value());
}

TEST(StrainReceiver, SetsThatGoIntoTheZeroSaySo) {
  take(RawKind::kZeros, 30000);
  CHECK_TRUE(take(RawKind::kZeroing, 30000)->zeroing);
}

TEST(StrainReceiver, OthersAreNotListenedTo) {
  take(RawKind::kZeros, 30000);
  CHECK_FALSE(take(RawKind::kReadings, 30000, 6).has_value());
}
