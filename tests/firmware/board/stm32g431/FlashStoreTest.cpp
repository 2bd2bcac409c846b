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
    flash.nonMaskable = [this] { CHECK_TRUE(takeEccFault(bus, faults)); };
  }
  Store& store() { return store_; }

  doubles::FakeFlash flash{kFirstPage, kPages};
  doubles::FakeBus bus{flash.registers};
  EccFaults faults;

 private:
  Store store_{bus, faults, kFirstPage, kPages};
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
    LONGS_EQUAL(0, flash.violations);
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
  LONGS_EQUAL(1, flash.cacheResets);
}

TEST(FlashStore, LocksAndRefreshesTheCacheAfterErasing) {
  CHECK_TRUE(store.erase(2) == StoreResult::kOk);
  isTidy();
  LONGS_EQUAL(1, flash.cacheResets);
}

TEST(FlashStore, UnlocksWithBothKeysInOrder) {
  CHECK_TRUE(store.erase(0) == StoreResult::kOk);
  const auto& writes = flash.registers.writes;
  CHECK_TRUE((writes[0] == doubles::FakeRegisters::Access{0x4002'2008, 0x4567'0123}));
  CHECK_TRUE((writes[1] == doubles::FakeRegisters::Access{0x4002'2008, 0xCDEF'89AB}));
}

TEST(FlashStore, FailsWhenTheKeysNoLongerUnlock) {
  flash.registers.write(Flash::KeyR::address, 0);  // someone wrote nonsense: locked until the next reset
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
  LONGS_EQUAL(0, flash.registers.writes.size());
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
  LONGS_EQUAL(61 * 2048 + 8, bench.faults.lastOffset);
  LONGS_EQUAL(0, flash.registers.field(Flash::EccR::detected));
  CHECK_TRUE(store.read(2048, std::span(bytes).first(8)) == StoreResult::kOk);
}

TEST(FlashStore, EveryByteOfADamagedUnitIsUnreadable) {
  flash.damage(16);
  for (std::size_t offset = 8; offset < 32; ++offset) {
    std::byte byte{};
    const auto expected = offset >= 16 && offset < 24 ? StoreResult::kUnreadable : StoreResult::kOk;
    CHECK_TRUE(store.read(offset, std::span(&byte, 1)) == expected);
  }
}

TEST(FlashStore, DamagedUnitsAreNotWrittenUntilErased) {
  flash.damage(8);
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kNotErased);
  CHECK_TRUE(store.erase(0) == StoreResult::kOk);
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kOk);
}

TEST(FlashStore, AUnitThatBecomesUnreadableWhileWrittenFails) {
  flash.cutAfter = 1;
  CHECK_TRUE(store.write(0, sixteen) == StoreResult::kFailed);
}

TEST(FlashStore, AnotherNmiIsNotTaken) {
  CHECK_FALSE(takeEccFault(bench.bus, bench.faults));
  LONGS_EQUAL(0, bench.faults.count);
}

TEST(FlashStore, ACorrectedErrorIsNoFault) {
  flash.registers.setField(Flash::EccR::corrected, 1);
  std::vector<std::byte> bytes(8);
  CHECK_TRUE(store.read(0, bytes) == StoreResult::kOk);
  CHECK_FALSE(takeEccFault(bench.bus, bench.faults));
}
