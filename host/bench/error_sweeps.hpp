#pragma once
// Error over everything that a user may meet or choose: one quantity at a time, the rest as on the default
// finger.

#include <cstdio>
#include <string>
#include <vector>

#include "host/bench/error_statistics.hpp"

namespace strainfinger::bench {

/// What is swept. The names are the `sweep` column's.
inline constexpr const char* kMapSweep = "position and direction";
inline constexpr const char* kLoadSweep = "load";
inline constexpr const char* kNoiseSweep = "noise";
inline constexpr const char* kWidthSweep = "contact width";
inline constexpr const char* kBuiltSweep = "contact width, finger as built";
inline constexpr int kBuiltFingers = 10;  ///< of that sweep, in each row the same
inline constexpr const char* kLengthSweep = "gauge length";
inline constexpr const char* kBitsSweep = "adc bits";

struct ErrorCell {
  std::string sweep;
  double setting;  ///< of what is swept; the map: offset from the nearest gauge [pitches]
  std::string unit;
  double direction_deg;  ///< atan(tangential / normal); NaN: all within +-45
  double load_n_per_m;   ///< length of (normal, tangential)
  bool told;             ///< the tables were made for what is swept; a width that they don't know is fitted
  ErrorStatistics statistics;
};

struct SweepSettings {
  int contacts = 4000;  ///< a cell
  int repeats = 100;    ///< a cell of the map
  std::uint64_t seed = 2001;
};

/// All sweeps. Half a minute at the default settings.
std::vector<ErrorCell> errorSweeps(const SweepSettings& settings);

/// CSV, one row a cell; empty where there is nothing to tell.
void writeErrorCsv(std::FILE* stream, const std::vector<ErrorCell>& cells);

/// The cells of one sweep, in order.
std::vector<ErrorCell> cellsOf(const std::vector<ErrorCell>& cells, const std::string& sweep);

}  // namespace strainfinger::bench
