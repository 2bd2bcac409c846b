#pragma once
// The rows of the disturbance matrix.

#include <vector>

#include "host/bench/matrix/disturbance.hpp"

namespace strainfinger::bench {

/// Every disturbance, by kind. Unless a row says otherwise: line contacts of 2 to 40 N/m anywhere on a finger
/// exactly as drawn, tables without model error and with the width unknown.
std::vector<Disturbance> matrixRows();

}  // namespace strainfinger::bench
