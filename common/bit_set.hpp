#pragma once
// Named bits in an unsigned integer.

#include <concepts>
#include <cstdint>
#include <initializer_list>

namespace strainfinger {

/// A set of Bit, an enum whose values are bit numbers of RawBits. Costs what that integer costs.
template <typename Bit, std::unsigned_integral RawBits = std::uint8_t>
class BitSet {
 public:
  using Raw = RawBits;

  constexpr BitSet() = default;
  constexpr BitSet(std::initializer_list<Bit> bits) {
    for (const Bit bit : bits) set(bit);
  }
  static constexpr BitSet fromRaw(Raw raw) {
    BitSet result;
    result.raw_ = raw;
    return result;
  }

  constexpr Raw raw() const { return raw_; }
  constexpr bool has(Bit bit) const { return (raw_ & maskOf(bit)) != 0; }
  constexpr bool empty() const { return raw_ == 0; }
  constexpr void set(Bit bit, bool on = true) {
    raw_ = static_cast<Raw>(on ? raw_ | maskOf(bit) : raw_ & ~maskOf(bit));
  }
  constexpr bool operator==(const BitSet&) const = default;

 private:
  static constexpr unsigned maskOf(Bit bit) { return 1U << static_cast<unsigned>(bit); }
  Raw raw_ = 0;
};

}  // namespace strainfinger
