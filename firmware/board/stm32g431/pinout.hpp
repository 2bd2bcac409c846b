#pragma once
// Which pin does what. README.md has it as a table and a picture.

#include <array>

#include "firmware/board/stm32g431/registers/clocks.hpp"
#include "firmware/board/stm32g431/registers/gpio.hpp"
#include "firmware/board/stm32g431/sampling.hpp"

namespace strainfinger::stm32g431 {

/// An analog input: its pin and its channel of the converter (DS12589, pin definitions).
struct Input {
  Pin pin;
  std::uint8_t channel;
};

/// Gauges 2k and 2k + 1 are sampled at the same instant: 2k by ADC1, 2k + 1 by ADC2. The pins that the Nucleo
/// board uses itself are left alone: PA2, PA3 (serial line to the debugger), PA5 (LED), PA13, PA14
/// (debugger), PC13 (button).
inline constexpr std::array<Input, kPairs> kEvenGauges{{{{Port::kA, 0}, 1},
                                                        {{Port::kA, 1}, 2},
                                                        {{Port::kB, 0}, 15},
                                                        {{Port::kB, 1}, 12},
                                                        {{Port::kB, 12}, 11},
                                                        {{Port::kB, 14}, 5},
                                                        {{Port::kC, 0}, 6},
                                                        {{Port::kC, 1}, 7}}};
inline constexpr std::array<Input, kPairs> kOddGauges{{{{Port::kA, 4}, 17},
                                                       {{Port::kA, 6}, 3},
                                                       {{Port::kA, 7}, 4},
                                                       {{Port::kB, 2}, 12},
                                                       {{Port::kB, 15}, 15},
                                                       {{Port::kC, 2}, 8},
                                                       {{Port::kC, 3}, 9},
                                                       {{Port::kC, 4}, 5}}};

/// Not PB8, the other choice: it decides at reset whether the bootloader starts, and an idle bus holds it
/// high.
inline constexpr Pin kCanRx{Port::kA, 11};
inline constexpr Pin kCanTx{Port::kA, 12};
inline constexpr std::uint32_t kCanFunction = 9;  ///< alternate function of both, GPIO_AF9_FDCAN1

/// The receiver is pulled up, so that an unconnected bus is a silent one.
void connectCan(const RegisterBus auto& bus) noexcept {
  enableClock(bus, Rcc::Ahb2Enr::gpioA(1));
  makeAlternate(bus, kCanRx, kCanFunction, Gpio::kUp);
  makeAlternate(bus, kCanTx, kCanFunction, Gpio::kNone);
}

}  // namespace strainfinger::stm32g431
