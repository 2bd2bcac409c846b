#pragma once

#include <bit>
#include <cstdint>

namespace strainfinger::firmware {

/// Square root, rounded down: Newton's steps from above, five of them at most.
constexpr std::uint32_t integerRoot(std::uint32_t value) {
  if (value == 0) return 0;
  std::uint32_t root = 1u << ((33 - std::countl_zero(value)) / 2);
  while (true) {
    const std::uint32_t next = (root + value / root) / 2;
    if (next >= root) return root;
    root = next;
  }
}

}  // namespace strainfinger::firmware
