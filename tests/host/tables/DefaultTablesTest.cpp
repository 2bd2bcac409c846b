#include <bit>
#include <cstring>

#include "common/table_image.hpp"
#include "default_tables.hpp"
#include "host/tables/table_builder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

namespace {

// As a firmware links them.
constinit const TableImage kLinked = std::bit_cast<TableImage>(kDefaultTableBytes);

}  // namespace

TEST_GROUP(DefaultTables) {};

TEST(DefaultTables, AreAWholeImage) {
  LONGS_EQUAL(static_cast<int>(TableFault::kNone), static_cast<int>(checkTableImage(kLinked)));
}

TEST(DefaultTables, AreWhatTheBuilderMakesOfTheDefaultFinger) {
  const TableImage built = tables::buildTableImage({});
  MEMCMP_EQUAL(&built, &kLinked, sizeof(TableImage));
}
