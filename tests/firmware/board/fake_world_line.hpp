#pragma once
// The line from the world to a board of QEMU's, and what is told on it.

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

#include "firmware/board/mps2/world_record.hpp"

namespace strainfinger::mps2 {

/// What was told waits here; what the board says is lost.
struct FakeWorldLine {
  std::deque<std::uint8_t> bytes;
  bool put(std::uint8_t) noexcept { return true; }
  std::optional<std::uint8_t> get() noexcept {
    if (bytes.empty()) return std::nullopt;
    const std::uint8_t byte = bytes.front();
    bytes.pop_front();
    return byte;
  }
  void tell(const std::vector<std::uint8_t>& told) { bytes.insert(bytes.end(), told.begin(), told.end()); }
};

/// A record as it goes over the line.
inline std::vector<std::uint8_t> bytesOf(const WorldRecord& record) {
  std::vector<std::uint8_t> bytes{static_cast<std::uint8_t>(record.kind), record.size};
  bytes.insert(bytes.end(), record.payload.begin(), record.payload.begin() + record.size);
  return bytes;
}

}  // namespace strainfinger::mps2
