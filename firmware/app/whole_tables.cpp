#include "firmware/app/whole_tables.hpp"

namespace strainfinger::firmware {

bool areWhole(const TableImage& tables) { return checkTableImage(tables) == TableFault::kNone; }

}  // namespace strainfinger::firmware
