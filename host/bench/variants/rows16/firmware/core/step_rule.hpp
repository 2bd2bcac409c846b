#pragma once
// In place of firmware/core/step_rule.hpp: every fourth row of the table, and a tolerance to match.

namespace strainfinger::firmware {

inline constexpr int kConverged_eighths = 4 * 5;
inline constexpr int kMostSteps = 8;
inline constexpr int kRowStrideBits = 2;

}  // namespace strainfinger::firmware
