#include "host/base/notice.hpp"

#include <cstdio>

namespace strainfinger {

std::string printable(std::string_view text) {
  std::string shown;
  bool wasC2 = false;
  for (const char each : text) {
    const auto c = static_cast<unsigned char>(each);
    const bool isControl = (c < 0x20 && c != '\n' && c != '\t') || c == 0x7F || (wasC2 && c < 0xA0);
    wasC2 = c == 0xC2;
    shown += isControl ? fmt::format("\\x{:02X}", c) : std::string(1, each);
  }
  return shown;
}

void tell(std::string_view text) noexcept try { std::fputs(printable(text).c_str(), stderr); } catch (...) {
  // Without memory for it nothing is said.
}

}  // namespace strainfinger
