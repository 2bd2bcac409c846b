#include "host/tables/pressed_ring.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace strainfinger::tables {

double PressedRing::offset_pitch() const { return std::remainder(position_pitch - deepest, gauges()); }

RingResponse::RingResponse(const model::ImpulseResponse& response, int gaugeCount, double position_pitch)
    : position_pitch_(position_pitch), sign_(peakSign(response)) {
  for (int gauge = 0; gauge < gaugeCount; ++gauge)
    values_.push_back(response.at((gauge - position_pitch) * 2 * std::numbers::pi / gaugeCount));
}

PressedRing RingResponse::pressed(double tangential) const {
  PressedRing ring{position_pitch_, {}, 0, 0};
  ring.readings.reserve(values_.size());
  for (const auto& value : values_)
    ring.readings.push_back(sign_ * (value.normal + tangential * value.tangential));
  const auto deepest = std::max_element(ring.readings.begin(), ring.readings.end());
  ring.deepest = static_cast<int>(deepest - ring.readings.begin());
  ring.energy = std::inner_product(ring.readings.begin(), ring.readings.end(), ring.readings.begin(), 0.0);
  return ring;
}

}  // namespace strainfinger::tables
