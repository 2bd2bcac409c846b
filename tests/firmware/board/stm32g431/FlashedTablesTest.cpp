#include "firmware/board/stm32g431/flashed_tables.hpp"

#include "firmware/app/whole_tables.hpp"

#include <cstring>
#include <memory>

#include "host/config/finger_config.hpp"
#include "host/tables/table_builder.hpp"
#include "tests/firmware/board/stm32g431/fake_flash.hpp"

using namespace strainfinger;
using namespace strainfinger::stm32g431;

TEST_GROUP(FlashedTables) {
  std::unique_ptr<TableImage> linked = std::make_unique<TableImage>();
  std::unique_ptr<TableImage> flashed = std::make_unique<TableImage>();

  void setup() override { std::memset(flashed.get(), 0xFF, sizeof(TableImage)); }
  unsigned char& flashedByte(std::size_t at) { return reinterpret_cast<unsigned char*>(flashed.get())[at]; }
  const TableImage* chosen() { return &firmware::tablesOf(*flashed, *linked); }
};

TEST(FlashedTables, ErasedPagesLeaveTheImagesTables) { POINTERS_EQUAL(linked.get(), chosen()); }

TEST(FlashedTables, WholeOnesTakeTheImagesPlace) {
  *flashed = tables::buildTableImage(config::FingerConfig{});
  POINTERS_EQUAL(flashed.get(), chosen());
  CHECK_TRUE(checkTableImage(*chosen()) == TableFault::kNone);
}

TEST(FlashedTables, DamagedOnesAreRefusedAndNotReplacedByAnotherFingers) {
  *flashed = tables::buildTableImage(config::FingerConfig{});
  for (std::size_t at = 0; at < sizeof(TableImage); at += 97) {
    flashedByte(at) ^= 1;
    POINTERS_EQUAL(flashed.get(), chosen());
    CHECK_TRUE(checkTableImage(*chosen()) != TableFault::kNone);
    flashedByte(at) ^= 1;
  }
}

TEST(FlashedTables, HalfWrittenOnesAreRefused) {
  flashedByte(0) = 'S';
  POINTERS_EQUAL(flashed.get(), chosen());
  CHECK_TRUE(checkTableImage(*chosen()) != TableFault::kNone);
}

TEST_GROUP(ReadableTables) {
  doubles::FakeFlash flash{48, 6};
  doubles::FakeBus bus{flash.registers};
  EccErrors errors;
  TableImage whole{};

  void setup() override {
    flash.nonMaskable = [this] { CHECK_TRUE(survivesNmi(bus, errors)); };
  }
  const TableImage* read() {
    return readableTables(bus, errors, [this] {
      bus.read(st::FLASH_BASE + 48 * st::FLASH_PAGE_SIZE);
      return &whole;
    });
  }
};

TEST(ReadableTables, TablesWithoutAnErrorAreUsed) { POINTERS_EQUAL(&whole, read()); }

TEST(ReadableTables, TablesWithACorrectedBitAreUsed) {
  flash.weaken(0);
  POINTERS_EQUAL(&whole, read());
  LONGS_EQUAL(1, errors.corrected);
}

TEST(ReadableTables, TablesWithAnUnreadableWordAreRefusedThoughTheirChecksumIsRight) {
  flash.damage(0);
  POINTERS_EQUAL(nullptr, read());
}

TEST(ReadableTables, AnErrorOfBeforeIsNotTheTables) {
  errors.unreadable = 3;
  POINTERS_EQUAL(&whole, read());
}

TEST(ReadableTables, NoneAreNone) {
  POINTERS_EQUAL(nullptr, readableTables(bus, errors, []() -> const TableImage* { return nullptr; }));
}
