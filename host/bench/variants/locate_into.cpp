#include "host/bench/variants/locate_into.hpp"

#include <new>

#include "firmware/core/detect.hpp"
#include "firmware/core/locate.hpp"

namespace strainfinger::bench {

void locateInto(void* fit, const void* tables, bool byThree, const std::int32_t* strains_q32) {
  const auto& image = *static_cast<const TableImage*>(tables);
  const std::span strains(strains_q32, image.constants.gauge_count);
  const auto mode = byThree ? firmware::FitMode::kThreePoint : firmware::FitMode::kRefined;
  ::new (fit)
      firmware::Fit(firmware::locate(image, mode, strains, firmware::gateEnergy(image.constants, strains)));
}

}  // namespace strainfinger::bench
