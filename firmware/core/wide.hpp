#pragma once
// Numbers of 64 bits, of which the proof that nothing overflows knows bounds (tests/firmware/ranges).

#include <algorithm>
#include <bit>
#include <cstdint>

#include "common/fixed.hpp"
#include "firmware/core/packed.hpp"

namespace strainfinger::firmware {

using Wide = std::int64_t;
using Natural = std::uint64_t;

constexpr int leadingZeros(Natural value) { return std::countl_zero(value); }
/// Of 32 bits; value is positive.
constexpr int leadingZeros(Number value) { return std::countl_zero(static_cast<std::uint32_t>(value)); }

/// Of 16 bits.
constexpr Natural shortSquare(Number value) { return static_cast<std::uint32_t>(value * value); }
constexpr Natural squared(Wide value) { return static_cast<Natural>(value * value); }
/// |value|; value is not the least of all.
constexpr Natural sizeOf(Wide value) { return static_cast<Natural>(value < 0 ? -value : value); }
constexpr Natural larger(Natural a, Natural b) { return std::max(a, b); }
constexpr Natural positivePart(Wide value) { return static_cast<Natural>(std::max<Wide>(value, 0)); }

/// A value that the caller knows to be no larger than that; the proof then knows it, too.
constexpr Wide noLarger(Wide value, Natural) { return value; }
/// .. whose square the caller knows to be no larger than that.
constexpr Number noLonger(Number value, Natural) { return value; }
/// The lower 32 bits of a value that has no others.
constexpr std::uint32_t lowWord(Natural value) { return static_cast<std::uint32_t>(value); }

constexpr Wide lesser(Wide a, Wide b) { return std::min(a, b); }
/// To the nearest of least .. most.
constexpr Wide clamped(Wide value, Wide least, Wide most) { return std::clamp(value, least, most); }
/// To the nearest within +-most.
constexpr Wide limited(Wide value, Wide most) { return clamped(value, -most, most); }
/// To the nearest of 32 bits.
constexpr Number saturated(Wide value) { return saturate<std::int32_t>(value); }
/// The same, where room counts for more than time.
[[gnu::noinline]] constexpr Number narrowed(Wide value) { return saturated(value); }
/// To the nearest of 16 bits.
constexpr Short shortened(Wide value) { return saturate<Short>(value); }

}  // namespace strainfinger::firmware
