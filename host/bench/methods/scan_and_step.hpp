#pragma once
// The strongest alternatives that we could think of: the firmware's own idea with a floating-point unit.

#include <cmath>

#include "host/bench/methods/gauss_newton.hpp"
#include "host/bench/methods/global_search.hpp"
#include "host/bench/methods/starts.hpp"

namespace strainfinger::bench {

/// Gauss-Newton over seven gauges from both starts of the scan; the possible answer that leaves less
/// unexplained.
inline Minimum<float> scanAndStep(const RingResponse<float>& response, const ScanBank& bank,
                                  const Ring<float>& strain) {
  constexpr int kSteps = 6;
  const auto starts = startsOfScan(bank, strain);
  const auto one = gaussNewton<kWindow>(response, strain, starts[0], kSteps);
  const auto other = gaussNewton<kWindow>(response, strain, starts[1], kSteps);
  if (isPossible(one.place) != isPossible(other.place)) return isPossible(one.place) ? one : other;
  return other.residual < one.residual ? other : one;
}

/// Is this answer one that a scan about another gauge may better? The shares of energy are chosen for no
/// gross error without noise.
inline bool isDoubtful(const Minimum<float>& answer, const Ring<float>& strain) {
  constexpr float kFarthest_pitch = 0.53f, kUnexplained = 0.01f, kOutside = 0.125f;
  const int middle = sharpestGauge(strain);
  const Window<float> window = windowAbout(strain, middle);
  const float inside = dot(window, window);
  return !isPossible(answer.place) ||
         std::abs(answer.place.position_pitch - static_cast<float>(middle)) > kFarthest_pitch ||
         answer.residual > kUnexplained * inside || dot(strain, strain) > (1 + kOutside) * inside;
}

/// scanAndStep(), and the global search where that leaves doubts.
inline Place<float> scanOrSearch(const RingResponse<float>& response, const ScanBank& scan,
                                 const GlobalBank<float>& global, const Ring<float>& strain) {
  const auto answer = scanAndStep(response, scan, strain);
  return isDoubtful(answer, strain) ? GlobalSearch(response, global)(strain) : answer.place;
}

}  // namespace strainfinger::bench
