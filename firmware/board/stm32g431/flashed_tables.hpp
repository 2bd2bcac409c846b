#pragma once
// Which tables this board works with, if any.

#include <algorithm>
#include <concepts>
#include <cstdint>

#include "common/table_image.hpp"
#include "firmware/board/stm32g431/flash_ecc.hpp"

namespace strainfinger::stm32g431 {

/// Those that were flashed for this finger, if anything was: whole or not, for a finger that quietly goes on
/// with another's would tell wrong forces. Else the image's. To be checked before use.
inline const TableImage& tablesOf(const TableImage& flashed, const TableImage& linked) {
  const auto bytes = std::as_bytes(std::span(&flashed, 1));
  const bool erased = std::ranges::all_of(bytes, [](std::byte byte) { return byte == std::byte{0xFF}; });
  return erased ? linked : flashed;
}

/// The tables that `choose()` finds whole, if it finds some, and if every word that it read to find out was
/// readable: a checksum may be right by a word that is not.
template <RegisterBus Bus, std::invocable Choose>
const TableImage* readableTables(Bus bus, EccErrors& errors, Choose choose) noexcept {
  const EccWatch watch(bus, errors);
  const TableImage* const tables = choose();
  return watch.isClean() ? tables : nullptr;
}

}  // namespace strainfinger::stm32g431
