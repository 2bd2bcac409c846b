#pragma once
// Text for people, on UART0.

#include <string_view>

#include "firmware/board/mps2/uart.hpp"

namespace strainfinger::mps2 {

/// Waits for the line: nothing that a finger's work depends on.
class Console {
 public:
  Console& operator<<(std::string_view text) {
    for (const char character : text) put(character);
    return *this;
  }
  Console& operator<<(std::uint32_t number) {
    std::uint32_t place = 1;
    while (number / place >= 10) place *= 10;
    for (; place != 0; place /= 10) put(static_cast<char>('0' + number / place % 10));
    return *this;
  }
  void hex(std::uint32_t number) {
    for (int shift = 28; shift >= 0; shift -= 4) put("0123456789abcdef"[number >> shift & 15]);
  }

 private:
  void put(char character) {
    while (!uart_.put(static_cast<std::uint8_t>(character))) continue;
  }
  Uart uart_{kUart0};
};

}  // namespace strainfinger::mps2
