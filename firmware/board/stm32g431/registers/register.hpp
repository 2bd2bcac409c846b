#pragma once
// Registers and their bit fields as types: a field can only be used with the register it belongs to.
//
// Names, offsets and meanings are those of the reference manual, ST RM0440 (chapters as in revision 4).

#include <concepts>
#include <cstdint>

namespace strainfinger::stm32g431 {

/// What reads and writes registers: MemoryBus on the board, fake registers in tests. Copied freely.
// clang-format off
template <typename T>
concept RegisterBus = std::copyable<T> && requires(const T bus, std::uint32_t address, void* memory) {
  { bus.read(address) } noexcept -> std::same_as<std::uint32_t>;
  { bus.write(address, address) } noexcept -> std::same_as<void>;
  { bus.addressOf(memory) } noexcept -> std::same_as<std::uint32_t>;  // as DMA sees it
};
// clang-format on

/// A 32-bit register. Derive from it and put the fields inside.
template <std::uint32_t kAddress>
struct Register {
  static constexpr std::uint32_t address = kAddress;
};

/// Some bits of a register and the values they are to have; those of one register combine with |.
template <typename Reg>
struct Bits {
  std::uint32_t mask = 0;
  std::uint32_t value = 0;

  friend constexpr Bits operator|(Bits a, Bits b) { return {a.mask | b.mask, a.value | b.value}; }
};

/// kWidth bits of Reg from bit kLsb on. Called with a value it gives the bits to write.
template <typename Reg, unsigned kLsb, unsigned kWidth = 1>
struct Field {
  static_assert(kWidth >= 1 && kLsb + kWidth <= 32);
  using Of = Reg;
  static constexpr std::uint32_t max = 0xFFFF'FFFFU >> (32 - kWidth);
  static constexpr std::uint32_t mask = max << kLsb;

  /// `value` must not exceed max.
  constexpr Bits<Reg> operator()(std::uint32_t value) const { return {mask, (value << kLsb) & mask}; }
  constexpr std::uint32_t in(std::uint32_t word) const { return (word & mask) >> kLsb; }
};

/// Writes these bits, and 0 to all others.
template <typename Reg>
void write(const RegisterBus auto& bus, Bits<Reg> bits) noexcept {
  bus.write(Reg::address, bits.value);
}

/// Writes these bits and leaves the others.
template <typename Reg>
void modify(const RegisterBus auto& bus, Bits<Reg> bits) noexcept {
  bus.write(Reg::address, (bus.read(Reg::address) & ~bits.mask) | bits.value);
}

template <typename FieldType>
std::uint32_t get(const RegisterBus auto& bus, FieldType field) noexcept {
  return field.in(bus.read(FieldType::Of::address));
}

/// Reads until the field has the value, at most `polls` times. False: it never had it.
template <typename FieldType>
[[nodiscard]] bool waitFor(const RegisterBus auto& bus, FieldType field, std::uint32_t value,
                           std::uint32_t polls) noexcept {
  for (; polls > 0; --polls)
    if (get(bus, field) == value) return true;
  return false;
}

/// Takes at least `cycles` of the processor's clock: a read of a peripheral takes two or more.
template <typename Reg>
void waitCycles(const RegisterBus auto& bus, std::uint32_t cycles) noexcept {
  for (; cycles > 0; --cycles) static_cast<void>(bus.read(Reg::address));
}

}  // namespace strainfinger::stm32g431
