#pragma once
// The number that no other device has: RM0440 section 48.1.

#include <array>
#include <span>

#include "common/crc32.hpp"
#include "firmware/board/stm32g431/registers/system.hpp"

namespace strainfinger::stm32g431 {

using UniqueId = std::array<std::uint32_t, 3>;  ///< 96 bits, lowest first

[[nodiscard]] UniqueId uniqueId(const RegisterBus auto& bus) noexcept {
  UniqueId id{};
  for (std::uint32_t word = 0; word < id.size(); ++word) id[word] = bus.read(UniqueIdWords::base + 4 * word);
  return id;
}

/// For INFO: tells boards apart, nearly always; never 0.
inline std::uint8_t shortNumber(const UniqueId& id) noexcept {
  return static_cast<std::uint8_t>(1 + crc32(std::as_bytes(std::span(id))) % 255);
}

}  // namespace strainfinger::stm32g431
