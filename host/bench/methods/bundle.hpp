#pragma once
// Everything an image needs to run the methods on the readings that this machine scored: one file that the
// images link as it is. Both sides are little-endian with the same layout.

#include <bit>
#include <type_traits>

#include "common/table_image.hpp"
#include "host/bench/methods/knowledge.hpp"
#include "host/bench/methods/sample.hpp"

namespace strainfinger::bench {

/// The firmware's tables for one level.
struct NoiseTables {
  TableImage line;      ///< contacts are known to be lines
  TableImage anyWidth;  ///< the width is fitted with each touch
};

inline constexpr int kCountedSamples = 256;  ///< the first ones of each level

struct BundledLevel {
  NoiseTables tables;
  std::array<Sample, kCountedSamples> samples;
};

inline constexpr int kLevels = 4;  ///< of noise, of lines and of touches of any width

struct Bundle {
  std::uint32_t bytes;  ///< sizeof: an image that sees another layout refuses
  std::uint32_t reserved;
  Knowledge knowledge;
  std::array<BundledLevel, kLevels> levels;
};

static_assert(std::is_trivially_copyable_v<Bundle> && std::endian::native == std::endian::little);

}  // namespace strainfinger::bench
