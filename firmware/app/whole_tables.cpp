#include "firmware/app/whole_tables.hpp"

namespace strainfinger::firmware {

const TableImage* ifWhole(const TableImage& tables) {
  return checkTableImage(tables) == TableFault::kNone ? &tables : nullptr;
}

}  // namespace strainfinger::firmware
