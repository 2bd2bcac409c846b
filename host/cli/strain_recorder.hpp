#pragma once
// What a run's gauges read and what touched them, for `calibrate`, `shape` and `locate`.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "host/simulation/simulated_finger.hpp"

namespace strainfinger::cli {

/// Keeps rows of strains, at nominal gain and less the zero, and of the touch that was there, so many a
/// second. Memory: 10 MB a minute at 1000 rows a second.
class StrainRecorder {
 public:
  /// `factors`: what the firmware multiplies the strains by, one a gauge (tables::correctionFactors()).
  StrainRecorder(std::vector<double> factors, double rate_hz)
      : factors_(std::move(factors)), period_s_(1 / rate_hz) {}

  /// A sample set, and the firmware's readings of it.
  void add(const simulation::Moment& moment, std::span<const std::int32_t> strains_q32);

  std::string strains() const;  ///< CSV: time_s, strain_0, strain_1 ..
  /// CSV: angle_deg, normal_n_per_m, tangential_n_per_m; both loads 0: untouched; empty: several touches,
  /// which a row can't say.
  std::string touches() const;

 private:
  struct Row {
    double time_s;
    std::vector<double> strains;
    std::optional<simulation::Touch> touch;  ///< empty: several
  };
  std::vector<double> factors_;
  double period_s_;
  std::uint64_t taken_ = 0;  ///< periods
  std::vector<Row> rows_;
};

}  // namespace strainfinger::cli
