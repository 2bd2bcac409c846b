#pragma once
// Rows of gauge strains and of the touches under which they were read, as commands read and write them.

#include <string>
#include <vector>

#include "host/base/number_rows.hpp"

namespace strainfinger {

/// The columns of a ring: strain_0, strain_1 ..
inline std::vector<std::string> strainColumns(int gauges) {
  std::vector<std::string> names;
  for (int gauge = 0; gauge < gauges; ++gauge) names.push_back("strain_" + std::to_string(gauge));
  return names;
}

/// What may be there: strains that were measured are far below 1; with a header, other columns beside them.
inline NumberRowReader::Limit strainLimit(int gauges) {
  return {.most = 1,
          .hint = "a strain is an extension over a length, not in per cent or millionths",
          .columns = strainColumns(gauges),
          .family = "strain_",
          .familyHint = "but gauges.count = " + std::to_string(gauges) + ": give this finger's config, -c"};
}

/// The header of rows of touches.
inline constexpr const char* kTouchHeader = "angle_deg,normal_n_per_m,tangential_n_per_m";

/// What may be there of a touch: an empty cell is what nobody knows.
inline NumberRowReader::Limit touchLimit() { return {.header = kTouchHeader, .mayBeEmpty = true}; }

}  // namespace strainfinger
