#include "host/bench/fingers.hpp"

namespace strainfinger::bench {

config::FingerConfig perfectFinger() {
  config::FingerConfig config;
  config.gauges.model_error = 0;
  return config;
}

config::FingerConfig fingerAsBuilt(int seed) {
  config::FingerConfig config;
  config.as_built = {.seed = seed,
                     .angle_deg = 0.5,
                     .depth_m = 0.05e-3,
                     .gain = 0.03,
                     .core_radius_m = 0.1e-3,
                     .poisson_ratio = -0.01};
  return config;
}

}  // namespace strainfinger::bench
