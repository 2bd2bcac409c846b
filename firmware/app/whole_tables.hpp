#pragma once
// Which tables a finger works with, if any.

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>

#include "common/table_image.hpp"

namespace strainfinger::firmware {

/// `tables` if checkTableImage() finds no fault, and they are of at most so many gauges, else nullptr. Boards
/// compile it for size: it is needed once, at the start.
const TableImage* ifWhole(const TableImage& tables, std::uint32_t mostGauges = kMaxGauges);

/// Those that were made for this finger, if its pages of the memory have any: whole or not, for a finger that
/// quietly goes on with another's would tell wrong forces. Else the image's. To be checked before use.
inline const TableImage& tablesOf(const TableImage& own, const TableImage& linked) {
  const auto bytes = std::as_bytes(std::span(&own, 1));
  const bool erased = std::ranges::all_of(bytes, [](std::byte byte) { return byte == std::byte{0xFF}; });
  return erased ? linked : own;
}

}  // namespace strainfinger::firmware
