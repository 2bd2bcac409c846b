#pragma once
// Which tables this board works with, and what a double ECC error then means.

#include <algorithm>
#include <cstdint>

#include "common/table_image.hpp"
#include "firmware/board/stm32g431/flash_layout.hpp"
#include "firmware/board/stm32g431/flash_store.hpp"

namespace strainfinger::stm32g431 {

/// Those that were flashed for this finger, if anything was: whole or not, for a finger that quietly goes on
/// with another's would tell wrong forces. Else the image's. To be checked before use.
inline const TableImage& tablesOf(const TableImage& flashed, const TableImage& linked) {
  const auto bytes = std::as_bytes(std::span(&flashed, 1));
  const bool erased = std::ranges::all_of(bytes, [](std::byte byte) { return byte == std::byte{0xFF}; });
  return erased ? linked : flashed;
}

/// Whether the firmware can go on after a double ECC error. In the configuration that is FlashStore's to
/// tell, in tables that are not in use yet checkTableImage()'s; anywhere else the processor works with bytes
/// that mean nothing.
constexpr bool isHandled(std::uint32_t offset, bool tablesInUse) {
  const auto isIn = [&](const PageRange& pages) {
    return offset - pages.first * kFlashPageBytes < pages.bytes();
  };
  return isIn(kConfigurationPages) || (isIn(kTablePages) && !tablesInUse);
}

}  // namespace strainfinger::stm32g431
