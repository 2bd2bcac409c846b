#include "firmware/board/stm32g431/flash_store.hpp"

#include <vector>

#include "tests/firmware/board/stm32g431/fake_flash.hpp"
#include "tests/hal/non_volatile_contract.hpp"

using namespace strainfinger;
using namespace strainfinger::stm32g431;
using hal::StoreResult;

namespace {

using Store = FlashStore<doubles::FakeBus>;
static_assert(hal::NonVolatile<Store>);

constexpr std::uint32_t kFirstPage = 60;
constexpr std::uint32_t kPages = 3;

/// The store with its NMI connected, as on the board.
class FlashBench {
 public:
  FlashBench() {
    flash.nonMaskable = [this] { survived = survivesNmi(bus, errors); };
  }
  Store& store() { return store_; }

  doubles::FakeFlash flash{kFirstPage, kPages};
  doubles::FakeBus bus{flash.registers};
  EccErrors errors;
  bool survived = true;

 private:
  Store store_{bus, errors, kFirstPage, kPages};
};

}  // namespace

NON_VOLATILE_CONTRACT(Flash, FlashBench)

TEST_GROUP(FlashStore) {
  FlashBench bench;
  Store& store = bench.store();
  doubles::FakeFlash& flash = bench.flash;
  std::vector<std::byte> sixteen = std::vector(16, std::byte{0x5A});

  void isTidy() {
    CHECK_TRUE(flash.isLocked());
    LONGS_EQUAL(0, flash.registers.field(Flash::Cr::program));
    LONGS_EQUAL(0, flash.registers.field(Flash::Cr::pageErase));
    LONGS_EQUAL(1, flash.registers.field(Flash::Acr::dataCache));
  }
};

TEST(FlashStore, IsAsLargeAsItsPages) {
  LONGS_EQUAL(2048, store.pageSize());
  LONGS_EQUAL(3 * 2048, store.size());
}

TEST(FlashStore, WritesWhereItsPagesAre) {
  CHECK_TRUE(store.write(2048, sixteen) == StoreResult::kOk);
  LONGS_EQUAL(0x5A5A'5A5A, flash.registers.at(0x0800'0000 + 61 * 2048 + 12));
}

TEST(FlashStore, LocksAndRefreshesTheCacheAfterWriting) {
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kOk);
  isTidy();
  CHECK_TRUE(flash.cacheResets > 0);
}

TEST(FlashStore, LocksAndRefreshesTheCacheAfterErasing) {
  CHECK_TRUE(store.erase(2) == StoreResult::kOk);
  isTidy();
  CHECK_TRUE(flash.cacheResets > 0);
}

TEST(FlashStore, UnlocksWithBothKeysInOrder) {
  CHECK_TRUE(store.erase(0) == StoreResult::kOk);
  auto writes = flash.registers.writes;
  std::erase_if(writes, [](const auto& write) { return write.address == st::FLASH_ACR; });
  CHECK_TRUE((writes[0] == doubles::FakeRegisters::Access{0x4002'2008, 0x4567'0123}));
  CHECK_TRUE((writes[1] == doubles::FakeRegisters::Access{0x4002'2008, 0xCDEF'89AB}));
}

TEST(FlashStore, FailsWhenTheKeysNoLongerUnlock) {
  flash.lockUntilReset();
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kFailed);
  CHECK_TRUE(store.erase(0) == StoreResult::kFailed);
  LONGS_EQUAL(0xFFFF'FFFF, flash.wordAt(0));
}

TEST(FlashStore, FailsWhenAnOperationNeverEnds) {
  flash.stuckBusy = true;
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kFailed);
  CHECK_TRUE(flash.isLocked());
  LONGS_EQUAL(0xFFFF'FFFF, flash.wordAt(8));  // it stopped at the first
}

TEST(FlashStore, FailsWhenTheMemoryStaysBusyFromBefore) {
  flash.stuckBusy = true;
  flash.registers.setField(Flash::Sr::busy, 1);
  CHECK_TRUE(store.erase(0) == StoreResult::kFailed);
  LONGS_EQUAL(0, flash.operations());
}

TEST(FlashStore, FailsOnEveryErrorFlag) {
  for (std::uint32_t bit = 1; bit < 16; ++bit) {
    if ((Flash::Sr::errors >> bit & 1) == 0) continue;
    flash.nextErrors = 1U << bit;
    CHECK_TRUE(store.erase(0) == StoreResult::kFailed);
    isTidy();
  }
  CHECK_TRUE(store.erase(0) == StoreResult::kOk);
}

TEST(FlashStore, ClearsErrorsOfBefore) {
  flash.registers.word<Flash::Sr>() = Flash::Sr::errors;
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kOk);
}

TEST(FlashStore, FailsWhenWhatWasWrittenIsNotThere) {
  flash.weak = true;
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kFailed);
  isTidy();
}

TEST(FlashStore, FailsWhenAPageIsNotEmptyAfterErasing) {
  flash.weak = true;
  CHECK_TRUE(store.erase(0) == StoreResult::kFailed);
  isTidy();
}

TEST(FlashStore, ADoubleEccErrorIsAnErrorCode) {
  flash.damage(2048 + 8);
  std::vector<std::byte> bytes(32);
  CHECK_TRUE(store.read(2048, bytes) == StoreResult::kUnreadable);
  LONGS_EQUAL(61 * 2048 + 8, bench.errors.lastOffset);
  LONGS_EQUAL(0, flash.registers.word<Flash::EccR>() & (st::FLASH_ECCR_ECCD | st::FLASH_ECCR_ECCC));
  CHECK_TRUE(store.read(2048, std::span(bytes).first(8)) == StoreResult::kOk);
  LONGS_EQUAL(1, store.errors().unreadable);
}

TEST(FlashStore, EveryByteOfADamagedUnitIsUnreadableEachTime) {
  flash.damage(16);
  for (std::size_t offset = 8; offset < 32; ++offset) {
    std::byte byte{};
    const auto expected = offset >= 16 && offset < 24 ? StoreResult::kUnreadable : StoreResult::kOk;
    CHECK_TRUE(store.read(offset, std::span(&byte, 1)) == expected);
  }
}

TEST(FlashStore, ADamagedUnitIsUnreadableWhateverItsAddressIsSaidToBe) {
  for (const auto said :
       {doubles::EccAddress::kRight, doubles::EccAddress::kWrong, doubles::EccAddress::kStale}) {
    flash.eccAddress = said;
    flash.damage(16);
    std::byte byte{};
    CHECK_TRUE(store.read(16, std::span(&byte, 1)) == StoreResult::kUnreadable);
    CHECK_TRUE(bench.survived);
  }
}

TEST(FlashStore, ACorrectedErrorIsCountedAndHidesNoDoubleError) {
  flash.weaken(0);
  flash.damage(16);
  std::vector<std::byte> bytes(8);
  CHECK_TRUE(store.read(0, bytes) == StoreResult::kOk);
  LONGS_EQUAL(1, store.errors().corrected);
  CHECK_TRUE(store.read(16, bytes) == StoreResult::kUnreadable);
  bytes.resize(24);
  CHECK_TRUE(store.read(0, bytes) == StoreResult::kUnreadable);
  LONGS_EQUAL(2, store.errors().corrected);
  LONGS_EQUAL(2, store.errors().unreadable);
}

TEST(FlashStore, ACorrectedErrorHidesNoDamagedUnitFromAWrite) {
  flash.weaken(0);
  flash.damage(8);
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kNotErased);
}

TEST(FlashStore, ACorrectedErrorHidesNoUnitThatBecomesUnreadableWhileWritten) {
  flash.weaken(0);
  flash.cutPowerAfter(1, doubles::Torn::kUnreadable);
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kFailed);
}

TEST(FlashStore, ACorrectedErrorThatStoodBeforeHidesNoDoubleError) {
  flash.registers.word<Flash::EccR>() |= st::FLASH_ECCR_ECCC;
  flash.damage(16);
  std::vector<std::byte> bytes(8);
  CHECK_TRUE(store.read(16, bytes) == StoreResult::kUnreadable);
  LONGS_EQUAL(1, store.errors().corrected);
}

TEST(FlashStore, DamagedUnitsAreNotWrittenUntilErased) {
  flash.damage(8);
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kNotErased);
  CHECK_TRUE(store.erase(0) == StoreResult::kOk);
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kOk);
}

TEST(FlashStore, AUnitThatBecomesUnreadableWhileWrittenFails) {
  flash.cutPowerAfter(1, doubles::Torn::kUnreadable);
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kFailed);
}

TEST_GROUP(EccErrors) {
  doubles::FakeFlash flash{60, 3};
  doubles::FakeBus bus{flash.registers};
  EccErrors errors;
};

TEST(EccErrors, AnNmiThatNobodyExpectsIsNotSurvivedAndItsPlaceIsTold) {
  flash.registers.word<Flash::EccR>() = st::FLASH_ECCR_ECCD | 0x1238;
  CHECK_FALSE(survivesNmi(bus, errors));
  LONGS_EQUAL(1, errors.unreadable);
  LONGS_EQUAL(0x1238, errors.lastOffset);
}

TEST(EccErrors, AnNmiWithoutAFlagCountsAsUnreadableWhereErrorsAreExpected) {
  CHECK_FALSE(survivesNmi(bus, errors));
  LONGS_EQUAL(0, errors.unreadable);
  const EccWatch watch(bus, errors);
  CHECK_TRUE(survivesNmi(bus, errors));
  CHECK_FALSE(watch.isClean());
}

TEST(EccErrors, ErrorsAreExpectedOnlyAsLongAsTheyAreWatched) {
  {
    const EccWatch watch(bus, errors);
    CHECK_TRUE(watch.isClean());
    CHECK_TRUE(errors.isExpected);
  }
  CHECK_FALSE(errors.isExpected);
}

TEST(EccErrors, AnErrorThatRaisedNothingYetIsSeenToo) {
  const EccWatch watch(bus, errors);
  flash.registers.word<Flash::EccR>() = st::FLASH_ECCR_ECCD;
  CHECK_FALSE(watch.isClean());
}

TEST(EccErrors, BothFlagsAreCleared) {
  flash.registers.word<Flash::EccR>() = st::FLASH_ECCR_ECCD | st::FLASH_ECCR_ECCC;
  noteEccErrors(bus, errors);
  LONGS_EQUAL(0, flash.registers.word<Flash::EccR>());
  LONGS_EQUAL(1, errors.corrected);
  LONGS_EQUAL(1, errors.unreadable);
}
