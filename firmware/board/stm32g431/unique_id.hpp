#pragma once
// The number that no other device has: RM0440 section 48.1.

#include <array>

#include "firmware/board/stm32g431/registers/system.hpp"

namespace strainfinger::stm32g431 {

using UniqueId = std::array<std::uint32_t, 3>;  ///< 96 bits, lowest first

[[nodiscard]] UniqueId uniqueId(const RegisterBus auto& bus) noexcept {
  UniqueId id{};
  for (std::uint32_t word = 0; word < id.size(); ++word) id[word] = bus.read(UniqueIdWords::base + 4 * word);
  return id;
}

}  // namespace strainfinger::stm32g431
