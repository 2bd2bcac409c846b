#pragma once
// Where a contact is, told at once by the pairs beside the deepest reading.

#include "firmware/core/fit_step.hpp"

namespace strainfinger::firmware {

/// From the window's middle gauge [pitches * 2^kStartWeightBits], at most a pitch either way.
inline Number toldOffset(const StartWeights& weights, const Signal& signal) {
  const auto& [even, odd] = signal;
  const Number sum = dot(pairAt(&weights[2]), odd[1], dot(pairAt(&weights[0]), odd[0]));
  return signedQuotient<kStartWeightBits + 1>(sum, nonZero(low(even[0])));
}

}  // namespace strainfinger::firmware
