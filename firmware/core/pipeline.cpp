#include "firmware/core/pipeline.hpp"

namespace strainfinger::firmware {

Observation Pipeline::process(Codes codes) {
  condition(constants(), calibration_, codes, readings_);
  const auto strains = readings_.strains(constants().gauge_count);
  const std::uint32_t energy = gateEnergy(constants(), strains);
  Observation observation;
  observation.saturated = readings_.saturated;
  if (gate_.update(constants(), energy)) observation.fit = locate(*tables_, mode_, strains, energy);
  return observation;
}

}  // namespace strainfinger::firmware
