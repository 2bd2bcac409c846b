#pragma once
// How finely fits step and when they stop. The benchmark compiles the locator with other rules as well
// (host/bench/variants).

namespace strainfinger::firmware {

/// A step this short [row spacings / 8] lands so near its row that another would change nothing that matters;
/// a little more than half a spacing, so that two neighbouring rows can't hand a fit to and fro. Less would
/// change nothing: the next step would be from the same row.
inline constexpr int kConverged_eighths = 5;

/// Steps of a fit that otherwise is no answer.
inline constexpr int kMostSteps = 8;

/// Steps are taken from every 2^this-th row.
inline constexpr int kRowStrideBits = 0;

}  // namespace strainfinger::firmware
