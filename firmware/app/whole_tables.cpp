#include "firmware/app/whole_tables.hpp"

namespace strainfinger::firmware {

const TableImage* ifWhole(const TableImage& tables, std::uint32_t mostGauges) {
  const bool isGood =
      checkTableImage(tables) == TableFault::kNone && tables.constants.gauge_count <= mostGauges;
  return isGood ? &tables : nullptr;
}

}  // namespace strainfinger::firmware
