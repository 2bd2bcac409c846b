#pragma once
// What the test images share: their command line, and how they print.

#include <array>
#include <cstdint>

#include "firmware/board/mps2/console.hpp"
#include "firmware/board/mps2/semihosting.hpp"

namespace strainfinger::emulated {

/// The words behind the image's name on the emulator's command line.
class Words {
 public:
  Words() : size_(mps2::commandLine(text_)) { skipWord(); }

  bool more() const { return position_ < size_; }
  /// The next one as a number; 0 if there is none.
  std::uint32_t number() {
    std::uint32_t value = 0;
    for (; more() && text_[position_] != ' '; ++position_)
      value = value * 10 + static_cast<std::uint32_t>(text_[position_] - '0');
    ++position_;
    return value;
  }

 private:
  void skipWord() {
    while (more() && text_[position_++] != ' ') continue;
  }

  std::array<char, 80> text_{};
  std::size_t size_;
  std::size_t position_ = 0;
};

inline void print(mps2::Console& console, std::uint32_t number, std::uint32_t hash) {
  console << number << " ";
  console.hex(hash);
  console << "\n";
}

}  // namespace strainfinger::emulated
