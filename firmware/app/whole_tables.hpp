#pragma once
// Tables before they are used.

#include "common/table_image.hpp"

namespace strainfinger::firmware {

/// `tables` if checkTableImage() finds no fault, else nullptr. Boards compile it for size: it is needed once,
/// at the start.
const TableImage* ifWhole(const TableImage& tables);

}  // namespace strainfinger::firmware
