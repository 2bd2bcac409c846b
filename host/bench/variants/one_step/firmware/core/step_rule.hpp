#pragma once
// In place of firmware/core/step_rule.hpp: the first step is the last, at most an eighth of a pitch as it is.

namespace strainfinger::firmware {

inline constexpr int kConverged_eighths = 8 * 8;
inline constexpr int kMostSteps = 1;
inline constexpr int kRowStrideBits = 0;

}  // namespace strainfinger::firmware
