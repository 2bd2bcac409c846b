#include "tests/doubles/fake_non_volatile.hpp"

#include <array>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using doubles::FakeNonVolatile;
using hal::StoreResult;

TEST_GROUP(FakeNonVolatile) {
  FakeNonVolatile store{2, 64};
  std::array<std::byte, 24> zeros{};

  StoreResult readUnit(std::size_t offset) {
    std::array<std::byte, 8> unit{};
    return store.read(offset, unit);
  }

  std::byte firstOf(std::size_t offset) {
    std::array<std::byte, 1> byte{};
    CHECK_TRUE(store.read(offset, byte) == StoreResult::kOk);
    return byte[0];
  }
};

TEST(FakeNonVolatile, APowerCutTearsAWriteBetweenUnits) {
  store.cutPowerAfter(1, FakeNonVolatile::CutUnit::kErased);
  CHECK_TRUE(store.write(0, zeros) == StoreResult::kFailed);
  store.restorePower();
  CHECK_TRUE(firstOf(0) == std::byte{0});
  CHECK_TRUE(firstOf(8) == std::byte{0xFF});
  CHECK_TRUE(firstOf(16) == std::byte{0xFF});
  LONGS_EQUAL(1, store.steps());
}

TEST(FakeNonVolatile, APowerCutCanLeaveItsUnitUnreadable) {
  store.cutPowerAfter(1);
  CHECK_TRUE(store.write(0, zeros) == StoreResult::kFailed);
  store.restorePower();
  CHECK_TRUE(readUnit(0) == StoreResult::kOk);
  CHECK_TRUE(readUnit(8) == StoreResult::kUnreadable);
  CHECK_TRUE(readUnit(16) == StoreResult::kOk);
}

TEST(FakeNonVolatile, WithoutPowerNothingWorks) {
  store.cutPowerAfter(0);
  CHECK_TRUE(store.hasPower());
  CHECK_TRUE(store.write(0, zeros) == StoreResult::kFailed);
  CHECK_FALSE(store.hasPower());
  CHECK_TRUE(readUnit(64) == StoreResult::kFailed);
  CHECK_TRUE(store.write(64, zeros) == StoreResult::kFailed);
  CHECK_TRUE(store.erase(1) == StoreResult::kFailed);
  LONGS_EQUAL(0, store.steps());
}

TEST(FakeNonVolatile, APowerCutLeavesAPageBeingErasedUnreadable) {
  store.cutPowerAfter(0);
  CHECK_TRUE(store.erase(1) == StoreResult::kFailed);
  store.restorePower();
  CHECK_TRUE(readUnit(56) == StoreResult::kOk);
  CHECK_TRUE(readUnit(64) == StoreResult::kUnreadable);
  CHECK_TRUE(readUnit(120) == StoreResult::kUnreadable);
  CHECK_TRUE(store.erase(1) == StoreResult::kOk);
  CHECK_TRUE(firstOf(64) == std::byte{0xFF});
}

TEST(FakeNonVolatile, ADamagedUnitSpoilsEveryReadThatTouchesIt) {
  store.damage(13);
  std::array<std::byte, 2> two{};
  CHECK_TRUE(store.read(7, two) == StoreResult::kUnreadable);
  CHECK_TRUE(store.read(15, two) == StoreResult::kUnreadable);
  CHECK_TRUE(store.read(6, two) == StoreResult::kOk);
  CHECK_TRUE(store.read(16, two) == StoreResult::kOk);
  CHECK_TRUE(store.write(8, zeros) == StoreResult::kNotErased);
}

TEST(FakeNonVolatile, EveryUnitAndEveryEraseIsAStep) {
  CHECK_TRUE(store.write(0, zeros) == StoreResult::kOk);
  CHECK_TRUE(store.erase(0) == StoreResult::kOk);
  LONGS_EQUAL(4, store.steps());
}

TEST(FakeNonVolatile, AWornPageTakesNoEraseAndTheOthersDo) {
  FakeNonVolatile three(3);
  three.wearOut(1);
  CHECK_TRUE(three.erase(0) == hal::StoreResult::kOk);
  CHECK_TRUE(three.erase(1) == hal::StoreResult::kFailed);
}

TEST(FakeNonVolatile, CountsTheErasesOfEachPage) {
  FakeNonVolatile three(3);
  CHECK_TRUE(three.erase(2) == hal::StoreResult::kOk);
  CHECK_TRUE(three.erase(2) == hal::StoreResult::kOk);
  LONGS_EQUAL(2, three.erases(2));
  LONGS_EQUAL(0, three.erases(0));
}

TEST(FakeNonVolatile, CountsTheReadsThatFoundDamage) {
  std::array<std::byte, 8> bytes{};
  store.damage(8);
  CHECK_TRUE(store.read(0, bytes) == hal::StoreResult::kOk);
  CHECK_TRUE(store.read(8, bytes) == hal::StoreResult::kUnreadable);
  LONGS_EQUAL(1, store.errors().unreadable);
}
