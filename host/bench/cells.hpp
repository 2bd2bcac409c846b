#pragma once
// Figures as the benchmarks' tables show them.

#include <fmt/format.h>

#include <cmath>
#include <string>

namespace strainfinger::bench {

inline std::string number(double value, int decimals) {
  return std::isnan(value) ? "-" : fmt::format("{:.{}f}", value, decimals);
}

/// A part of a whole; two digits of a small one.
inline std::string share(int part, int whole) {
  const double percent = 100.0 * part / whole;
  return part == 0 ? "0" : fmt::format(fmt::runtime(percent < 10 ? "{:.2g} %" : "{:.0f} %"), percent);
}

}  // namespace strainfinger::bench
