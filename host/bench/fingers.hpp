#pragma once
// The fingers that benchmarks touch: the default one as drawn, and as people build it.

#include "host/config/finger_config.hpp"

namespace strainfinger::bench {

/// Exactly as drawn, and known to be: no model error.
config::FingerConfig perfectFinger();

/// Built by hand and not calibrated, with the default model error: gauges glued 0.5 degrees and 0.05 mm off,
/// gains off by 3 % (standard deviations), the core 0.1 mm thicker, Poisson's ratio 0.49. Another finger for
/// each seed.
config::FingerConfig fingerAsBuilt(int seed);

}  // namespace strainfinger::bench
