#pragma once

#include <cstdint>

namespace strainfinger::firmware {

/// Square root, rounded down. Sixteen rounds.
constexpr std::uint32_t integerRoot(std::uint32_t value) {
  std::uint32_t root = 0;
  for (std::uint32_t bit = 1u << 15; bit != 0; bit >>= 1) {
    const std::uint32_t trial = root | bit;
    if (trial * trial <= value) root = trial;
  }
  return root;
}

}  // namespace strainfinger::firmware
