#include "firmware/board/cortex_m/linked_tables.hpp"

#include <bit>

#include <default_tables.hpp>  // made by the build

namespace strainfinger::board {

[[gnu::section(".tables")]] constinit const TableImage kLinkedTables =
    std::bit_cast<TableImage>(kDefaultTableBytes);

}  // namespace strainfinger::board
