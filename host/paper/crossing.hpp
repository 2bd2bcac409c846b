#pragma once
// Where a function changes its sign.

#include <algorithm>
#include <cmath>
#include <limits>

namespace strainfinger::paper {

/// The first place in from..to at which `f` changes its sign, to 1e-14 of `to`; NaN without one. It looks
/// every `step` first, so a pair of changes closer than that may be missed.
template <typename Function>
double firstCrossing(const Function& f, double from, double to, double step) {
  const bool sign = f(from) < 0;
  double before = from, after = from;
  while ((f(after) < 0) == sign) {
    if (after >= to) return std::numeric_limits<double>::quiet_NaN();
    before = after;
    after = std::min(after + step, to);
  }
  while (after - before > 1e-14 * to) {
    const double middle = before + (after - before) / 2;
    if (middle <= before || middle >= after) break;
    ((f(middle) < 0) == sign ? before : after) = middle;
  }
  return before + (after - before) / 2;
}

}  // namespace strainfinger::paper
