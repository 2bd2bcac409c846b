#pragma once
// Template correlation: the normal response at 65 offsets over seven gauges, the best match wins.

#include <algorithm>

#include "host/bench/methods/peak.hpp"

namespace strainfinger::bench {

inline constexpr int kWindow = 7;
inline constexpr int kReach = kWindow / 2;

template <typename Real>
using Window = std::array<Real, kWindow>;

template <typename Real>
Window<Real> windowAbout(const Ring<Real>& strain, int gauge) {
  Window<Real> window;
  for (int k = 0; k < kWindow; ++k) window[static_cast<std::size_t>(k)] = strain[gaugeOf(gauge - kReach + k)];
  return window;
}

template <typename Real, std::size_t Size>
Real dot(const std::array<Real, Size>& a, const std::array<Real, Size>& b) {
  Real sum{};
  for (std::size_t k = 0; k < Size; ++k) sum += a[k] * b[k];
  return sum;
}

struct TemplateBank {
  static constexpr int kPerPitch = 64;
  static constexpr int kTemplates = kPerPitch + 1;  ///< offsets -1/2 .. 1/2 pitch from the middle gauge

  std::array<Window<float>, kTemplates> shape;  ///< of unit norm
  std::array<float, kTemplates> load;           ///< N/m per unit of correlation
};

/// Offset of the vertex of the parabola through three equidistant values, in their spacing.
template <typename Real>
Real vertexOffset(Real before, Real middle, Real after) {
  const Real bend = 2 * middle - before - after;
  return bend > 0 ? (after - before) / (2 * bend) : Real{};
}

/// Assumes that nothing pulls sideways: tells no tangential load.
inline Place<float> correlateTemplates(const TemplateBank& bank, const Ring<float>& strain) {
  const int middle = strongestGauge(strain);
  const Window<float> window = windowAbout(strain, middle);
  std::array<float, TemplateBank::kTemplates> match;
  for (std::size_t i = 0; i < match.size(); ++i) match[i] = dot(bank.shape[i], window);
  const auto best = static_cast<std::size_t>(std::max_element(match.begin(), match.end()) - match.begin());
  float row = static_cast<float>(best) - TemplateBank::kPerPitch / 2;
  if (best > 0 && best + 1 < match.size()) row += vertexOffset(match[best - 1], match[best], match[best + 1]);
  Place<float> place = placeWithoutLoads(static_cast<float>(middle) + row / TemplateBank::kPerPitch);
  place.normal = match[best] * bank.load[best];
  return place;
}

}  // namespace strainfinger::bench
