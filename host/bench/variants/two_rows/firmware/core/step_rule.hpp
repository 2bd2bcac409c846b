#pragma once
// In place of firmware/core/step_rule.hpp: steps of up to two rows are the last.

namespace strainfinger::firmware {

inline constexpr int kConverged_eighths = 2 * 8;
inline constexpr int kMostSteps = 8;
inline constexpr int kRowStrideBits = 0;

}  // namespace strainfinger::firmware
