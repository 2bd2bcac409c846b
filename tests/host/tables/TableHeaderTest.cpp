#include "host/tables/table_header.hpp"

#include <fmt/format.h>

#include <string>

#include "host/tables/table_builder.hpp"

#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::tables;

TEST_GROUP(TableHeader) {};

TEST(TableHeader, SaysWhatItIsOf) {
  const TableImage image = buildTableImage({});
  const std::string header = imageHeader(image);
  STRCMP_CONTAINS("//   gauges.radius_m = 0.0094\n", header.c_str());
  STRCMP_CONTAINS("//   gauges.component = radial\n", header.c_str());
  STRCMP_CONTAINS("//   contact.width_m = unknown\n", header.c_str());
  STRCMP_CONTAINS("//   gauges.angle_deg = [0, 22.5, ", header.c_str());
  STRCMP_CONTAINS(fmt::format("// CRC-32 0x{:08X}\n", image.crc32).c_str(), header.c_str());
  STRCMP_CONTAINS("kDefaultTableBytes[24568] = {\n    83, 70, 84, 66, 10, 0,", header.c_str());
}
