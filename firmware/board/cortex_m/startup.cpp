#include "firmware/board/cortex_m/startup.hpp"

#include <algorithm>

#include "firmware/board/cortex_m/system_control.hpp"

// From sections.ld.
extern std::uint32_t vectors_begin[], stack_bottom[], data_loaded_at[], data_begin[], data_end[], bss_begin[],
    bss_end[];

namespace strainfinger::board {

extern "C" [[noreturn]] void resetHandler() {
  maskInterrupts();  // a bootloader may have left some of its own, of which the vectors here know nothing
  useVectors(reinterpret_cast<std::uint32_t>(vectors_begin));
  forbidBelow(reinterpret_cast<std::uint32_t>(stack_bottom));
  std::copy_n(data_loaded_at, data_end - data_begin, data_begin);
  std::fill(bss_begin, bss_end, 0);
  runBoard();
}

}  // namespace strainfinger::board
