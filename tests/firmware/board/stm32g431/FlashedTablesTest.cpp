#include "firmware/board/stm32g431/flashed_tables.hpp"

#include <cstring>
#include <memory>

#include <CppUTest/TestHarness.h>

#include "host/config/finger_config.hpp"
#include "host/tables/table_builder.hpp"

using namespace strainfinger;
using namespace strainfinger::stm32g431;

TEST_GROUP(FlashedTables) {
  std::unique_ptr<TableImage> linked = std::make_unique<TableImage>();
  std::unique_ptr<TableImage> flashed = std::make_unique<TableImage>();

  void setup() override { std::memset(flashed.get(), 0xFF, sizeof(TableImage)); }
  unsigned char& flashedByte(std::size_t at) { return reinterpret_cast<unsigned char*>(flashed.get())[at]; }
  const TableImage* chosen() { return &tablesOf(*flashed, *linked); }
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

// Pages of 2 KiB: the image's 0 to 47, tables 48 to 53, configuration 54 to 63.
TEST(FlashedTables, DoubleErrorsAreHandledWhereSomebodyLooksForThem) {
  for (const bool inUse : {false, true}) {
    CHECK_FALSE(isHandled(0, inUse));
    CHECK_FALSE(isHandled(48 * 2048 - 8, inUse));
    CHECK_TRUE(isHandled(54 * 2048, inUse));
    CHECK_TRUE(isHandled(64 * 2048 - 8, inUse));
    CHECK_FALSE(isHandled(64 * 2048, inUse));
  }
  for (const std::uint32_t offset : {48u * 2048, 54u * 2048 - 8}) {
    CHECK_TRUE(isHandled(offset, false));
    CHECK_FALSE(isHandled(offset, true));
  }
}
