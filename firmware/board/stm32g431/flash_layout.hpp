#pragma once
// What the flash pages behind the image are for. The image's own part is in memory.ld.

#include "common/table_image.hpp"
#include "firmware/board/stm32g431/registers/flash.hpp"

namespace strainfinger::stm32g431 {

struct PageRange {
  std::uint32_t first, count;
  constexpr std::uint32_t address() const { return kFlashBegin + first * kFlashPageBytes; }
  constexpr std::uint32_t bytes() const { return count * kFlashPageBytes; }
};

inline constexpr PageRange kImagePages{0, 48};
inline constexpr PageRange kTablePages{48, 12};  ///< tables of a finger, used instead of the image's
inline constexpr PageRange kConfigurationPages{60, 4};

static_assert(kTablePages.first == kImagePages.first + kImagePages.count);
static_assert(kConfigurationPages.first == kTablePages.first + kTablePages.count);
static_assert(kConfigurationPages.first + kConfigurationPages.count == kFlashPages);
static_assert(sizeof(TableImage) <= kTablePages.bytes());
static_assert(kTablePages.address() == 0x0801'8000, "as README.md says");

}  // namespace strainfinger::stm32g431
