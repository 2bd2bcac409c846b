#pragma once
// Flash memory of category 2 devices: RM0440 chapter 5. One bank of 64 pages of 2 KiB, 64-bit words with 8
// bits of ECC.

#include "firmware/board/stm32g431/registers/register.hpp"

namespace strainfinger::stm32g431 {

/// Where the memory is and how it is divided, RM0440 section 5.3.1.
inline constexpr std::uint32_t kFlashBegin = 0x0800'0000;
inline constexpr std::uint32_t kFlashBytes = 128 * 1024;
inline constexpr std::uint32_t kFlashPageBytes = 2048;
inline constexpr std::uint32_t kFlashPages = kFlashBytes / kFlashPageBytes;

/// RM0440 section 5.7.
struct Flash {
  static constexpr std::uint32_t base = 0x4002'2000;

  struct Acr : Register<base + 0x00> {
    static constexpr Field<Acr, 0, 4> latency{};  ///< wait states
    static constexpr Field<Acr, 8> prefetch{};
    static constexpr Field<Acr, 9> instructionCache{};
    static constexpr Field<Acr, 10> dataCache{};
    static constexpr Field<Acr, 12> resetDataCache{};
  };
  struct KeyR : Register<base + 0x08> {};
  static constexpr std::uint32_t firstKey = 0x4567'0123;
  static constexpr std::uint32_t secondKey = 0xCDEF'89AB;

  struct Sr : Register<base + 0x10> {
    static constexpr Field<Sr, 0> endOfOperation{};
    static constexpr Field<Sr, 16> busy{};
    /// OPERR, PROGERR, WRPERR, PGAERR, SIZERR, PGSERR, MISERR, FASTERR; cleared by writing 1.
    static constexpr std::uint32_t errors = 0x0000'03FA;
  };
  struct Cr : Register<base + 0x14> {
    static constexpr Field<Cr, 0> program{};
    static constexpr Field<Cr, 1> pageErase{};
    static constexpr Field<Cr, 3, 6> page{};
    static constexpr Field<Cr, 16> start{};
    static constexpr Field<Cr, 31> lock{};
  };
  struct EccR : Register<base + 0x18> {
    static constexpr Field<EccR, 0, 18> offset{};  ///< of the double word, from kFlashBegin; may be wrong
    static constexpr Field<EccR, 30> corrected{};  ///< ECCC; cleared by writing 1
    static constexpr Field<EccR, 31> detected{};   ///< ECCD: two bits wrong, raises NMI; cleared by writing 1
  };
};

}  // namespace strainfinger::stm32g431
