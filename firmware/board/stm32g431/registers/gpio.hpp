#pragma once
// Pins: RM0440 chapter 9.

#include "firmware/board/stm32g431/registers/register.hpp"

namespace strainfinger::stm32g431 {

enum class Port : std::uint8_t { kA = 0, kB = 1, kC = 2 };

struct Pin {
  Port port;
  std::uint8_t number;  ///< 0 .. 15
  bool operator==(const Pin&) const = default;
};

/// RM0440 section 9.4. One register of a port holds the same field for each pin, so it is an address and a
/// shift.
struct Gpio {
  static constexpr std::uint32_t base = 0x4800'0000;
  static constexpr std::uint32_t portStride = 0x400;
  static constexpr std::uint32_t mode = 0x00;       ///< MODER, 2 bits a pin: Mode
  static constexpr std::uint32_t speed = 0x08;      ///< OSPEEDR, 2 bits a pin: Speed
  static constexpr std::uint32_t pull = 0x0C;       ///< PUPDR, 2 bits a pin: Pull
  static constexpr std::uint32_t alternate = 0x20;  ///< AFRL and AFRH, 4 bits a pin

  enum Mode : std::uint32_t { kAlternate = 2, kAnalog = 3 };
  enum Pull : std::uint32_t { kNone = 0, kUp = 1 };
  enum Speed : std::uint32_t { kHighSpeed = 2 };
};

/// Sets the field of `width` bits that belongs to `pin`, in the register at `offset` or those after it.
void setPinField(const RegisterBus auto& bus, Pin pin, std::uint32_t offset, unsigned width,
                 std::uint32_t value) noexcept {
  const unsigned pinsPerRegister = 32 / width;
  const std::uint32_t address = Gpio::base + static_cast<std::uint32_t>(pin.port) * Gpio::portStride +
                                offset + 4 * (pin.number / pinsPerRegister);
  const unsigned shift = width * (pin.number % pinsPerRegister);
  const std::uint32_t mask = ((1U << width) - 1) << shift;
  bus.write(address, (bus.read(address) & ~mask) | (value << shift));
}

/// Disconnects the pin's digital side, as the converter needs it (RM0440 section 9.3.12).
void makeAnalog(const RegisterBus auto& bus, Pin pin) noexcept {
  setPinField(bus, pin, Gpio::pull, 2, Gpio::kNone);
  setPinField(bus, pin, Gpio::mode, 2, Gpio::kAnalog);
}

/// Gives the pin to a peripheral; the function comes before the mode, so that no other function shows
/// meanwhile.
void makeAlternate(const RegisterBus auto& bus, Pin pin, std::uint32_t function, Gpio::Pull pull) noexcept {
  setPinField(bus, pin, Gpio::alternate, 4, function);
  setPinField(bus, pin, Gpio::speed, 2, Gpio::kHighSpeed);
  setPinField(bus, pin, Gpio::pull, 2, pull);
  setPinField(bus, pin, Gpio::mode, 2, Gpio::kAlternate);
}

}  // namespace strainfinger::stm32g431
