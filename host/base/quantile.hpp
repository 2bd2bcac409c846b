#pragma once
#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace strainfinger {

/// The value that this share of them are below; the largest, for a share of 1. Domain: one value or more, no
/// NaN; a share from 0 to 1.
inline double quantileOf(std::vector<double> values, double share) {
  const auto below = static_cast<std::size_t>(share * static_cast<double>(values.size()));
  const auto place = values.begin() + static_cast<std::ptrdiff_t>(std::min(below, values.size() - 1));
  std::nth_element(values.begin(), place, values.end());
  return *place;
}

/// Of an even count the mean of the two in the middle. Domain: one value or more, no NaN.
inline double medianOf(std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : (values[half - 1] + values[half]) / 2;
}

}  // namespace strainfinger
