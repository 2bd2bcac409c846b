#include "firmware/app/stored_settings.hpp"

#include <array>

#include <CppUTest/TestHarness.h>

#include "firmware/app/finger.hpp"
#include "tests/doubles/fake_non_volatile.hpp"

using namespace strainfinger;
using namespace strainfinger::firmware;

TEST_GROUP(StoredSettings) {
  doubles::FakeNonVolatile memory;
  SettingsStore<doubles::FakeNonVolatile> store{memory};
  const StoredSettings first{7, 250}, second{8, 1000};

  void save(const StoredSettings& settings) { CHECK_TRUE(store.save(settings) == hal::StoreResult::kOk); }
  void checkHolds(const StoredSettings& settings) {
    const auto found = store.load();
    CHECK_TRUE(found.settings.has_value());
    CHECK_TRUE(*found.settings == settings);
  }
  void checkNothing(bool damaged) {
    const auto found = store.load();
    CHECK_FALSE(found.settings.has_value());
    CHECK_EQUAL(damaged, found.damaged);
  }
};

TEST(StoredSettings, ErasedMemoryHoldsNothingAndIsNotDamaged) { checkNothing(false); }

TEST(StoredSettings, GivesBackWhatWasSavedLast) {
  for (const StoredSettings& settings : {first, second, first, second, second}) {
    save(settings);
    checkHolds(settings);
  }
}

TEST(StoredSettings, KeepsEveryNodeAndRate) {
  for (int node = kFirstNode; node <= kLastNode; ++node) {
    const StoredSettings settings{static_cast<std::uint8_t>(node),
                                  static_cast<std::uint16_t>(20 + node * 15)};
    save(settings);
    checkHolds(settings);
  }
}

TEST(StoredSettings, WritesNothingThatIsThereAlready) {
  save(first);
  const int steps = memory.steps();
  save(first);
  LONGS_EQUAL(steps, memory.steps());
}

TEST(StoredSettings, APowerCutAtAnyStepLeavesTheOldOrTheNew) {
  using Unit = doubles::FakeNonVolatile::CutUnit;
  for (const Unit unit : {Unit::kErased, Unit::kUnreadable}) {
    for (int steps = 0; steps < 4; ++steps) {
      memory = doubles::FakeNonVolatile();
      save(second);
      save(first);
      memory.cutPowerAfter(steps, unit);
      const bool saved = store.save(second) == hal::StoreResult::kOk;
      memory.restorePower();
      checkHolds(saved ? second : first);
      CHECK_EQUAL(steps >= 3, saved);  // erase, two units
      save(second);
      checkHolds(second);
    }
  }
}

TEST(StoredSettings, ARecordThatCannotBeReadIsDamageAndTheOlderOneIsUsed) {
  save(first);
  save(second);
  memory.damage(memory.pageSize());  // the second record's page
  CHECK_TRUE(store.load().damaged);
  checkHolds(first);
}

TEST(StoredSettings, AnyFlippedBitMakesARecordDamage) {
  constexpr std::size_t kRecord_bytes = 16;
  save(first);
  std::array<std::byte, kRecord_bytes> record{};
  CHECK_TRUE(memory.read(0, record) == hal::StoreResult::kOk);
  for (std::size_t bit = 0; bit < 8 * kRecord_bytes; ++bit) {
    auto flipped = record;
    flipped[bit / 8] ^= std::byte{1} << (bit % 8);
    CHECK_TRUE(memory.erase(0) == hal::StoreResult::kOk);
    CHECK_TRUE(memory.write(0, flipped) == hal::StoreResult::kOk);
    checkNothing(true);
  }
}

TEST(StoredSettings, ARecordOfAnImpossibleNodeOrRateIsDamage) {
  for (const StoredSettings& settings :
       {StoredSettings{0, 500}, StoredSettings{64, 500}, StoredSettings{1, 19}, StoredSettings{1, 1001}}) {
    memory = doubles::FakeNonVolatile();
    save(settings);
    checkNothing(true);
  }
}

TEST(StoredSettings, TakeThePlaceOfTheImagesAtTheNextStart) {
  const FingerSettings image{.node = 3, .contactRate_hz = 500, .standingFlags = {FingerFlag::kSimulated}};
  save(first);
  const FingerSettings started = startedWith(image, store.load());
  LONGS_EQUAL(first.node, started.node);
  LONGS_EQUAL(first.contactRate_hz, started.contactRate_hz);
  CHECK_TRUE(started.standingFlags.has(FingerFlag::kSimulated));
  CHECK_FALSE(started.standingFaults.has(FingerFault::kConfiguration));
}

TEST(StoredSettings, DamagedOnesLeaveTheImagesAndAreAFault) {
  const FingerSettings started = startedWith(FingerSettings{.node = 3}, {.settings = {}, .damaged = true});
  LONGS_EQUAL(3, started.node);
  CHECK_TRUE(started.standingFaults.has(FingerFault::kConfiguration));
}

TEST(StoredSettings, AWriteThatFailsIsTold) {
  memory.cutPowerAfter(1);
  CHECK_TRUE(store.save(first) == hal::StoreResult::kFailed);
}
