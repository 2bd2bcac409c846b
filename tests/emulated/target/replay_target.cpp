// The firmware's logic over generated sample sets on an emulated board. Command line (semihosting): FIRST
// BLOCKS [detail]. Writes a line a block, or a sample set, to UART0.
#include "firmware/board/cortex_m/linked_tables.hpp"
#include "firmware/board/mps2/console.hpp"
#include "firmware/board/mps2/semihosting.hpp"
#include "tests/emulated/replay.hpp"
#include "tests/emulated/target/test_image.hpp"

namespace strainfinger::board {

using namespace emulated;

void runBoard() {
  mps2::Console console;
  Words words;
  const std::uint32_t first = words.number(), blocks = words.number();
  const bool detail = words.more();
  for (std::uint32_t block = first; block < first + blocks; ++block) {
    const auto tell = [&](std::uint32_t sample, std::uint32_t hash) {
      if (detail) print(console, sample, hash);
    };
    const std::uint32_t hash = replayBlock(kLinkedTables, block * kBlock, kBlock, tell);
    console << "block ";
    print(console, block, hash);
  }
  mps2::endEmulator(0);
}

}  // namespace strainfinger::board
