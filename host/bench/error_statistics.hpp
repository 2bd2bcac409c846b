#pragma once
// Touches of a finger under some condition, through the firmware's pipeline, and how far off its answers are.

#include <cstdint>
#include <vector>

#include "common/table_image.hpp"
#include "host/config/finger_config.hpp"
#include "host/evidence/accuracy.hpp"
#include "host/evidence/touched_ring.hpp"
#include "host/simulation/scenario.hpp"

namespace strainfinger::bench {

/// The errors are those of answers that the firmware gave as certain.
struct ErrorStatistics {
  int contacts = 0;
  int unnoticed = 0;  ///< the gate stayed closed
  int uncertain = 0;  ///< flagged so
  int wrong = 0;      ///< given as certain, and more than half a pitch off
  evidence::Errors arc_mm, normal_n_per_m, tangential_n_per_m;

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

  /// Any place, load directions within +-45 degrees, as wide as the actual finger's config has contacts.
  void touchAnywhere(double load_n_per_m, int contacts, ErrorStatistics& statistics);

 private:
  void judge(const Eigen::VectorXd& exact, const simulation::Touch& touch, ErrorStatistics& statistics) const;

  config::FingerConfig actual_;
  TableImage tables_;
  evidence::TouchedRing ring_;
  std::uint64_t seed_;
  std::uint64_t touch_ = 0;
};

}  // namespace strainfinger::bench
