#pragma once
// Rows of gauge strains, as commands read them.

#include "host/base/number_rows.hpp"

namespace strainfinger::cli {

/// Strains that were measured are far below 1.
inline NumberRowReader::Limit strainLimit() {
  return {1, "a strain is an extension over a length, not in per cent or millionths"};
}

}  // namespace strainfinger::cli
