#include "firmware/app/stored_settings.hpp"

#include <algorithm>
#include <array>

#include "firmware/app/finger.hpp"
#include "tests/doubles/fake_non_volatile.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::firmware;

namespace {

using Store = SettingsStore<doubles::FakeNonVolatile>;

constexpr std::size_t kPages = 10;
constexpr std::size_t kBoardPages = 4;  ///< of the finger board: firmware/board/stm32g431/flash_layout.hpp
constexpr std::uint32_t kDay_s = 24 * 60 * 60;

}  // namespace

TEST_GROUP(StoredSettings) {
  doubles::FakeNonVolatile memory{kPages, 16};
  std::uint32_t now_s = 0;
  EraseBudget budget;
  const StoredSettings first{7, 250}, second{8, 1000};

  /// By a finger that has started just now, and has all the time.
  SaveResult trySave(const StoredSettings& settings) {
    now_s += EraseBudget::kPeriod_s * kPages;
    return Store(memory).save(settings, budget, now_s);
  }
  void save(const StoredSettings& settings) { CHECK_TRUE(trySave(settings) == SaveResult::kSaved); }
  SettingsFound found() { return Store(memory).found(); }
  void checkHolds(const StoredSettings& settings) {
    const SettingsFound held = found();
    CHECK_TRUE(held.settings.has_value());
    CHECK_TRUE(*held.settings == settings);
  }
  void checkNothing(bool damaged) {
    CHECK_FALSE(found().settings.has_value());
    CHECK_EQUAL(damaged, found().damaged);
  }

  /// Of a page, on a day of two changes a second.
  int mostErasesOf(std::uint32_t day, Store & store, EraseBudget & erases) {
    std::array<int, kBoardPages> before{};
    for (std::size_t page = 0; page < kBoardPages; ++page) before[page] = memory.erases(page);
    for (std::uint32_t second_s = day * kDay_s; second_s < (day + 1) * kDay_s; ++second_s) {
      static_cast<void>(store.save(first, erases, second_s));
      static_cast<void>(store.save(second, erases, second_s));
    }
    int most = 0;
    for (std::size_t page = 0; page < kBoardPages; ++page)
      most = std::max(most, memory.erases(page) - before[page]);
    return most;
  }

  static constexpr std::size_t kNewestOfTwo = 2;  ///< the first record is on page 1, the second on the next
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

TEST(StoredSettings, EveryPageIsErasedAsOften) {
  for (int i = 0; i < 100; ++i) save(i % 2 == 0 ? first : second);
  for (std::size_t page = 0; page < kPages; ++page) LONGS_EQUAL(10, memory.erases(page));
}

TEST(StoredSettings, CountsItsErasesForLife) {
  for (int i = 0; i < 25; ++i) save(i % 2 == 0 ? first : second);
  LONGS_EQUAL(25, Store(memory).erases());
}

TEST(StoredSettings, APowerCutAtAnyStepLeavesTheOldOrTheNewAndIsNoticed) {
  using Unit = doubles::FakeNonVolatile::CutUnit;
  for (const Unit unit : {Unit::kErased, Unit::kUnreadable}) {
    for (int steps = 0; steps < 4; ++steps) {
      memory = doubles::FakeNonVolatile(2, 16);
      save(second);
      save(first);
      memory.cutPowerAfter(steps, unit);
      const bool saved = trySave(second) == SaveResult::kSaved;
      memory.restorePower();
      checkHolds(saved ? second : first);
      CHECK_EQUAL(steps >= 3, saved);  // erase, two units
      const bool everyUnitIsErased = unit == Unit::kErased && steps == 1;
      CHECK_EQUAL(!saved && !everyUnitIsErased, found().damaged);
      save(second);
      checkHolds(second);
      CHECK_FALSE(found().damaged);
    }
  }
}

TEST(StoredSettings, ARecordThatCannotBeReadIsDamageAndTheOlderOneIsUsed) {
  save(first);
  save(second);
  memory.damage(kNewestOfTwo * memory.pageSize());
  CHECK_TRUE(found().damaged);
  checkHolds(first);
}

TEST(StoredSettings, SavingWhatIsThereMendsAPageThatIsDamaged) {
  save(first);
  save(second);
  memory.damage((kNewestOfTwo - 1) * memory.pageSize());
  CHECK_TRUE(found().damaged);
  save(second);
  CHECK_FALSE(found().damaged);
  checkHolds(second);
  const int steps = memory.steps();
  save(second);
  LONGS_EQUAL(steps, memory.steps());
}

TEST(StoredSettings, AnyFlippedBitMakesARecordDamage) {
  constexpr std::size_t kRecord_bytes = 16;
  save(first);
  std::array<std::byte, kRecord_bytes> record{};
  constexpr std::size_t page = kNewestOfTwo - 1;
  CHECK_TRUE(memory.read(page * memory.pageSize(), record) == hal::StoreResult::kOk);
  for (std::size_t bit = 0; bit < 8 * kRecord_bytes; ++bit) {
    auto flipped = record;
    flipped[bit / 8] ^= std::byte{1} << (bit % 8);
    CHECK_TRUE(memory.erase(page) == hal::StoreResult::kOk);
    CHECK_TRUE(memory.write(page * memory.pageSize(), flipped) == hal::StoreResult::kOk);
    checkNothing(true);
  }
}

TEST(StoredSettings, ARecordOfAnImpossibleNodeOrRateIsDamage) {
  for (const StoredSettings& settings :
       {StoredSettings{0, 500}, StoredSettings{64, 500}, StoredSettings{1, 19}, StoredSettings{1, 1001}}) {
    memory = doubles::FakeNonVolatile(kPages, 16);
    save(settings);
    checkNothing(true);
  }
}

TEST(StoredSettings, TakeThePlaceOfTheImagesAtTheNextStart) {
  const FingerSettings image{.node = 3, .contactRate_hz = 500, .standingFlags = {FingerFlag::kSimulated}};
  save(first);
  const FingerSettings started = startedWith(image, found());
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

TEST(StoredSettings, AChangeThatWasLostIsAFault) {
  const FingerSettings started = startedWith(FingerSettings{.node = 3}, {.settings = first, .damaged = true});
  LONGS_EQUAL(first.node, started.node);
  CHECK_TRUE(started.standingFaults.has(FingerFault::kConfiguration));
}

TEST(StoredSettings, AWriteThatFailsIsTold) {
  memory = doubles::FakeNonVolatile(2, 16);
  memory.cutPowerAfter(1);
  CHECK_TRUE(trySave(first) == SaveResult::kFailed);
}

TEST(StoredSettings, AMemoryWithoutPagesTakesNothing) {
  SettingsStore<hal::NoStore> store(hal::noStore);
  CHECK_TRUE(store.save(first, budget, 0) == SaveResult::kFailed);
  CHECK_FALSE(store.found().settings.has_value());
}

TEST(StoredSettings, AWornPageIsPassedOver) {
  memory.wearOut(2);
  memory.wearOut(3);
  for (int i = 0; i < 30; ++i) {
    const StoredSettings& settings = i % 2 == 0 ? first : second;
    save(settings);
    checkHolds(settings);
  }
}

// Four erases at once, then one a minute: with eight worn pages in a row it takes some minutes to pass them.
TEST(StoredSettings, AsLongAsTwoPagesWorkItSaves) {
  save(first);
  for (std::size_t page = 2; page < kPages; ++page) memory.wearOut(page);
  Store store(memory);
  for (int i = 0; i < 6; ++i) {
    const StoredSettings& settings = i % 2 == 0 ? second : first;
    SaveResult result = SaveResult::kWait;
    for (int minutes = 0; minutes < 10 && result == SaveResult::kWait; ++minutes)
      result = store.save(settings, budget, now_s += EraseBudget::kPeriod_s);
    CHECK_TRUE(result == SaveResult::kSaved);
    checkHolds(settings);
  }
}

TEST(StoredSettings, WhenEveryOtherPageIsWornItFailsAndTheOldStay) {
  memory = doubles::FakeNonVolatile(3, 16);
  save(first);
  memory.wearOut(0);
  memory.wearOut(2);
  CHECK_TRUE(trySave(second) == SaveResult::kFailed);
  checkHolds(first);
}

TEST(StoredSettings, HoweverOftenItFailsTheNewestRecordIsNotErased) {
  memory = doubles::FakeNonVolatile(3, 16);
  save(first);
  for (std::size_t page = 0; page < 3; ++page)
    if (memory.erases(page) == 0) memory.wearOut(page);
  Store store(memory);
  for (int i = 0; i < 6; ++i) {
    CHECK_TRUE(store.save(second, budget, now_s += EraseBudget::kPeriod_s * kPages) == SaveResult::kFailed);
    checkHolds(first);
  }
}

TEST(StoredSettings, AfterAFewErasesTheNextHasToWait) {
  Store store(memory);
  for (int i = 0; i < 4; ++i)
    CHECK_TRUE(store.save(i % 2 == 0 ? first : second, budget, 100) == SaveResult::kSaved);
  CHECK_TRUE(store.save(first, budget, 100) == SaveResult::kWait);
  LONGS_EQUAL(60, budget.wait_s(100));
  CHECK_TRUE(store.save(first, budget, 159) == SaveResult::kWait);
  LONGS_EQUAL(1, budget.wait_s(159));
  CHECK_TRUE(store.save(second, budget, 159) == SaveResult::kSaved);  // it is there already
  CHECK_TRUE(store.save(first, budget, 160) == SaveResult::kSaved);
  CHECK_TRUE(store.save(second, budget, 160) == SaveResult::kWait);
  LONGS_EQUAL(5, store.erases());
}

TEST(StoredSettings, AfterSomeMinutesAFewAreAllowedAgainAndNoMore) {
  for (int i = 0; i < 4; ++i) budget.spend(0);
  LONGS_EQUAL(0, budget.wait_s(100'000));
  for (int i = 0; i < 4; ++i) {
    LONGS_EQUAL(0, budget.wait_s(100'000));
    budget.spend(100'000);
  }
  LONGS_EQUAL(60, budget.wait_s(100'000));
}

// Another setting twice a second, for a year, erases a page at most 1,500 times a day, however few pages
// still work.
TEST(StoredSettings, AYearOfRequestsWearsNoPageByMoreThan1500ErasesADay) {
  for (const std::size_t worn : {0u, 2u, 3u}) {
    memory = doubles::FakeNonVolatile(kBoardPages, 16);
    for (std::size_t page = 0; page < worn; ++page) memory.wearOut(page);
    Store store(memory);
    EraseBudget yearly;
    int most = 0;
    for (std::uint32_t day = 0; day < 365; ++day) most = std::max(most, mostErasesOf(day, store, yearly));
    UT_PRINT(
        StringFromFormat("%d of 4 pages worn: at most %d erases a page a day", static_cast<int>(worn), most)
            .asCharString());
    CHECK_TRUE(most <= (worn == 0 ? 361 : 1500));
  }
}
