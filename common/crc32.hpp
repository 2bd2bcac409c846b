#pragma once
// CRC-32/ISO-HDLC (IEEE 802.3, zip, PNG): polynomial 0x04C11DB7 reflected, initial and final XOR all ones.
// Check value of "123456789": 0xCBF43926.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace strainfinger {

namespace detail {

/// Remainders of the 16 nibbles: 64 bytes of flash, 4 times faster than bit by bit.
constexpr std::array<std::uint32_t, 16> crc32Nibbles() {
  std::array<std::uint32_t, 16> table{};
  for (std::uint32_t nibble = 0; nibble < 16; ++nibble) {
    std::uint32_t remainder = nibble;
    for (int bit = 0; bit < 4; ++bit) remainder = (remainder >> 1) ^ ((remainder & 1) ? 0xEDB88320u : 0u);
    table[nibble] = remainder;
  }
  return table;
}

inline constexpr auto kCrc32Nibbles = crc32Nibbles();

}  // namespace detail

/// CRC-32 of `bytes`; pass the CRC of what came before to go on with it.
constexpr std::uint32_t crc32(std::span<const std::byte> bytes, std::uint32_t before = 0) {
  std::uint32_t crc = ~before;
  for (const std::byte byte : bytes) {
    crc ^= static_cast<std::uint32_t>(byte);
    crc = (crc >> 4) ^ detail::kCrc32Nibbles[crc & 15];
    crc = (crc >> 4) ^ detail::kCrc32Nibbles[crc & 15];
  }
  return ~crc;
}

}  // namespace strainfinger
