#pragma once
// In place of firmware/core/step_rule.hpp: every second row of the table, and a tolerance to match.

namespace strainfinger::firmware {

inline constexpr int kConverged_eighths = 2 * 5;
inline constexpr int kMostSteps = 8;
inline constexpr int kRowStrideBits = 1;

}  // namespace strainfinger::firmware
