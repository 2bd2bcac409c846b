#pragma once
// Touches of a finger under some condition, through the firmware's pipeline, and how far off its answers are.

#include <cstdint>
#include <vector>

#include "common/table_image.hpp"
#include "host/config/finger_config.hpp"
#include "host/simulation/converter.hpp"
#include "host/simulation/gauge_strains.hpp"
#include "host/simulation/noise.hpp"

namespace strainfinger::bench {

/// Of errors, by magnitude. NaN without any.
class Spread {
 public:
  void add(double error) { magnitudes_.push_back(error < 0 ? -error : error); }
  double rms() const;
  double most95() const;  ///< 95 % are not larger
  double worst() const;

 private:
  std::vector<double> magnitudes_;
};

/// The errors are those of answers that the firmware gave as certain.
struct ErrorStatistics {
  int contacts = 0;
  int unnoticed = 0;  ///< the gate stayed closed
  int uncertain = 0;  ///< flagged so
  int wrong = 0;      ///< given as certain, and more than half a pitch off
  Spread arc_mm, normal_n_per_m, tangential_n_per_m;

  int certain() const { return contacts - unnoticed - uncertain; }
};

/// Figures of the few answers that are certain say little of a finger that mostly gives none.
inline bool isMostlyCertain(const ErrorStatistics& statistics) {
  return 2 * statistics.certain() >= statistics.contacts;
}

/// A finger as it is, and one as its tables think it is.
class Trial {
 public:
  /// Throws Failure(kUsage) where tables cannot be built or the converter alone makes more noise than
  /// noise_strain.
  Trial(const config::FingerConfig& actual, const config::FingerConfig& told, std::uint64_t seed);

  /// Touches the finger, whose last touch was long ago, `repeats` times, each with other noise.
  void touch(const simulation::Touch& touch, int repeats, ErrorStatistics& statistics);

  /// Any place, load directions within +-45 degrees.
  void touchAnywhere(double load_n_per_m, int contacts, ErrorStatistics& statistics);

 private:
  void judge(const std::vector<std::uint16_t>& codes, const simulation::Touch& touch,
             ErrorStatistics& statistics) const;

  config::FingerConfig actual_;
  TableImage tables_;
  simulation::GaugeStrains strains_;
  simulation::Converter converter_;
  double analogNoise_strain_;
  simulation::Noise noise_;
  std::uint64_t sample_ = 0;
};

}  // namespace strainfinger::bench
