#pragma once
// The tables that are linked into an image: the default finger's.

#include "common/table_image.hpp"

namespace strainfinger::board {

/// In flash, in a section of their own. What was linked there may have been replaced since: use them only
/// after checkTableImage().
extern const TableImage kLinkedTables;

}  // namespace strainfinger::board
