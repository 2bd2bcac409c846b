#pragma once
// What a run of the simulated finger came to.

#include <string>

#include "host/base/table_writer.hpp"
#include "host/simulation/touch_errors.hpp"

namespace strainfinger::cli {

/// A few lines for people, or one JSON object.
std::string summaryText(TableFormat format, double duration_s, const simulation::RunCounts& counts,
                        const simulation::TouchErrors& errors);

}  // namespace strainfinger::cli
