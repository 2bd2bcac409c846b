#include "common/crc32.hpp"

#include <array>
#include <random>
#include <string_view>
#include <vector>

#include <CppUTest/TestHarness.h>

using namespace strainfinger;

TEST_GROUP(Crc32) {
  static std::uint32_t of(std::string_view text) { return crc32(std::as_bytes(std::span(text))); }

  /// Bit by bit, as the standard's long division has it.
  static std::uint32_t byDivision(std::span<const std::byte> bytes) {
    std::uint32_t remainder = 0xFFFFFFFF;
    for (const std::byte byte : bytes) {
      for (int bit = 0; bit < 8; ++bit) {
        const std::uint32_t in = (static_cast<std::uint32_t>(byte) >> bit) & 1;
        const bool divides = ((remainder ^ in) & 1) != 0;
        remainder = (remainder >> 1) ^ (divides ? 0xEDB88320u : 0);
      }
    }
    return ~remainder;
  }

  std::mt19937 random_{20240613};
  std::vector<std::byte> anyBytes(std::size_t count) {
    std::vector<std::byte> bytes(count);
    for (std::byte& byte : bytes) byte = static_cast<std::byte>(random_());
    return bytes;
  }
};

// The catalogue's check value, and values of zlib's crc32().
TEST(Crc32, KnownTextsHaveTheirKnownValues) {
  UNSIGNED_LONGS_EQUAL(0xCBF43926, of("123456789"));
  UNSIGNED_LONGS_EQUAL(0x00000000, of(""));
  UNSIGNED_LONGS_EQUAL(0xE8B7BE43, of("a"));
  UNSIGNED_LONGS_EQUAL(0x414FA339, of("The quick brown fox jumps over the lazy dog"));
  UNSIGNED_LONGS_EQUAL(0x190A55AD, of(std::string_view("\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0"
                                                       "\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0\0",
                                                       32)));
}

TEST(Crc32, EveryByteValueIsDividedRightly) {
  for (int value = 0; value < 256; ++value) {
    const std::array bytes{static_cast<std::byte>(value)};
    UNSIGNED_LONGS_EQUAL(byDivision(bytes), crc32(bytes));
  }
}

TEST(Crc32, RandomBytesAgreeWithLongDivision) {
  UT_PRINT("seed 20240613");
  for (std::size_t count = 0; count < 200; ++count) {
    const auto bytes = anyBytes(count);
    UNSIGNED_LONGS_EQUAL(byDivision(bytes), crc32(bytes));
  }
}

TEST(Crc32, PartsGoOnWhereTheOneBeforeEnded) {
  UT_PRINT("seed 20240613");
  const auto bytes = anyBytes(100);
  const std::span<const std::byte> all(bytes);
  for (std::size_t cut = 0; cut <= all.size(); ++cut)
    UNSIGNED_LONGS_EQUAL(crc32(all), crc32(all.subspan(cut), crc32(all.first(cut))));
}

TEST(Crc32, IsThereAtCompileTime) {
  constexpr std::array bytes{std::byte{'a'}};
  static_assert(crc32(bytes) == 0xE8B7BE43);
}
