// replay_host FIRST BLOCKS [detail]: on this machine, what replay_target does on an emulated board.
#include <bit>
#include <cstdio>
#include <cstdlib>

#include "default_tables.hpp"
#include "tests/emulated/replay.hpp"

using namespace strainfinger;

int main(int count, char** arguments) {
  if (count < 3) return 2;
  static const auto tables = std::bit_cast<TableImage>(kDefaultTableBytes);
  const auto first = static_cast<std::uint32_t>(std::atoi(arguments[1]));
  const auto blocks = static_cast<std::uint32_t>(std::atoi(arguments[2]));
  for (std::uint32_t block = first; block < first + blocks; ++block) {
    const auto tell = [&](std::uint32_t sample, std::uint32_t hash) {
      if (count > 3) std::printf("%u %08x\n", sample, hash);
    };
    const std::uint32_t hash =
        emulated::replayBlock(tables, block * emulated::kBlock, emulated::kBlock, tell);
    std::printf("block %u %08x\n", block, hash);
  }
}
