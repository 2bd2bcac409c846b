#pragma once
// Table images as C++ source, for linking one into a firmware.

#include <string>

#include "common/table_image.hpp"

namespace strainfinger::tables {

/// A C++ header that defines `strainfinger::kDefaultTableBytes`, the image's bytes:
/// `constinit const TableImage kTables = std::bit_cast<TableImage>(kDefaultTableBytes);` puts them into a
/// firmware's flash.
std::string imageHeader(const TableImage& image);

}  // namespace strainfinger::tables
