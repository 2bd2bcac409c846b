#pragma once
// Tables in flash, as far as it can be read.

#include <concepts>

#include "common/table_image.hpp"
#include "firmware/board/stm32g431/flash_ecc.hpp"

namespace strainfinger::stm32g431 {

/// The tables that `choose()` finds whole, if it finds some, and if it met no unreadable word meanwhile: a
/// checksum may be right by such a word. Behind a corrected error only the checksum finds it, because the
/// flash says nothing more until choose() is done.
template <RegisterBus Bus, std::invocable Choose>
const TableImage* readableTables(Bus bus, EccErrors& errors, Choose choose) noexcept {
  const EccWatch watch(bus, errors);
  const TableImage* const tables = choose();
  return watch.isClean() ? tables : nullptr;
}

}  // namespace strainfinger::stm32g431
