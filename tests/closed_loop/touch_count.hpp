#pragma once
// How much the tests of statistics try, and what chance may add to their bars.

#include <cmath>
#include <cstdlib>

namespace strainfinger {

/// Touches, or trials, of a figure; STRAINFINGER_TEST_CONTACTS asks for another number.
inline int touchCount(int usual) {
  const char* const asked = std::getenv("STRAINFINGER_TEST_CONTACTS");
  return asked ? std::atoi(asked) : usual;
}

/// A bar for an RMS, of so many touches: three standard errors, each 1 / sqrt(2 n) of it.
inline double allowed(double bar, int count) { return bar * (1 + 3 / std::sqrt(2.0 * count)); }

/// A bar for a share, as a number of so many trials: three standard errors, of a rare event's number the
/// root; at least one event where the bar is not 0.
inline double allowedCount(double share, int count) {
  return std::ceil(share * count + 3 * std::sqrt(share * count));
}

}  // namespace strainfinger
