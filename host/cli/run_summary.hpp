#pragma once
// What a run of the simulated finger came to.

#include <cstdio>

#include "host/base/table_writer.hpp"
#include "host/simulation/touch_errors.hpp"

namespace strainfinger::cli {

/// A few lines for people, or one JSON object.
void printSummary(std::FILE* stream, TableFormat format, double duration_s,
                  const simulation::RunCounts& counts, const simulation::TouchErrors& errors);

}  // namespace strainfinger::cli
