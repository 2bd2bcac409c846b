#pragma once
// Every offset of a window, for contacts that may be anywhere: rare, and made small.

#include "firmware/core/scan.hpp"

namespace strainfinger::firmware {

/// Three peaks of a window that is scanned completely: the two offsets beside the middle gauge, and what lies
/// beyond them on the - and + sides.
struct Scan {
  Peak middle, minus, plus;
};

/// Scans a window at rows step / 2, 3/2 step .. up to kScanReach.
Scan scanned(const FitTable& rows, const Signal& signal, int step);

}  // namespace strainfinger::firmware
