#include "firmware/core/pipeline.hpp"

namespace strainfinger::firmware {

const Observation& Pipeline::process(Codes codes) {
  condition(constants(), calibration_, codes, readings_);
  const auto strains = readings_.strains(constants().gauge_count);
  const std::uint32_t energy = gateEnergy(constants(), strains);
  observation_.saturated = readings_.saturated;
  observation_.fit.reset();
  if (gate_.update(constants(), energy)) observation_.fit = locate(*tables_, mode_, strains, energy);
  return observation_;
}

}  // namespace strainfinger::firmware
