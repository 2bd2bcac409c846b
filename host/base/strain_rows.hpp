#pragma once
// Rows of gauge strains, as commands read and write them.

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
          .columns = strainColumns(gauges)};
}

}  // namespace strainfinger
