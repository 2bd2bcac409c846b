#pragma once
#include <algorithm>
#include <cstddef>
#include <vector>

namespace strainfinger {

/// The value that half of them are below; of an even count the upper one of the two in the middle. Domain:
/// one value or more, no NaN.
inline double medianOf(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace strainfinger
