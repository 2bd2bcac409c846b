#pragma once
// Tables before they are used.

#include "common/table_image.hpp"

namespace strainfinger::firmware {

/// checkTableImage() finds no fault. Boards compile it for size: it is needed once, at the start.
bool areWhole(const TableImage& tables);

}  // namespace strainfinger::firmware
