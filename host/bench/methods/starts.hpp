#pragma once
// Where an iterative fit begins.

#include "host/bench/methods/peak.hpp"
#include "host/bench/methods/ring_response.hpp"
#include "host/bench/methods/subspace.hpp"
#include "host/bench/methods/templates.hpp"

namespace strainfinger::bench {

/// The textbook's start: the centroid, a normal load that gives the strongest gauge its strain.
inline Place<float> startAtCentroid(const RingResponse<float>& response, const Ring<float>& strain) {
  const Place<float> place = centroid(strain);
  const int peak = strongestGauge(strain);
  return {place.position_pitch, strain[gaugeOf(peak)] / response.points[0].normal, 0};
}

/// Offsets -5/8 .. 5/8 of a pitch from the sharpest gauge, over seven gauges: the firmware's idea, in float.
struct ScanBank {
  static constexpr int kPerPitch = 8;
  static constexpr int kFarthest = 5;
  std::array<Projection<float, kWindow>, 2 * kFarthest + 1> rows;
};

/// The best place on each side of the sharpest gauge: one of the two leads to the truth.
inline std::array<Place<float>, 2> startsOfScan(const ScanBank& bank, const Ring<float>& strain) {
  const int middle = sharpestGauge(strain);
  const Window<float> window = windowAbout(strain, middle);
  std::array<Place<float>, 2> starts;
  std::array<float, 2> most{-1, -1};
  for (std::size_t i = 0; i < bank.rows.size(); ++i) {
    const int row = static_cast<int>(i) - ScanBank::kFarthest;
    const auto shadow = bank.rows[i].of(window);
    const float energy = shadow.energy();
    const std::size_t side = row < 0 ? 0 : 1;
    if (energy <= most[side]) continue;
    most[side] = energy;
    const float position = static_cast<float>(middle) + static_cast<float>(row) / ScanBank::kPerPitch;
    starts[side] = bank.rows[i].placeOf(position, shadow);
  }
  return most[0] > most[1] ? starts : std::array{starts[1], starts[0]};
}

}  // namespace strainfinger::bench
