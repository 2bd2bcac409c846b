#pragma once
// Every method on every level: errors, time on this machine, instructions on the emulated ones.

#include <array>
#include <map>
#include <string>
#include <vector>

#include "host/bench/make_bundle.hpp"
#include "host/bench/score.hpp"

namespace strainfinger::bench {

struct MethodResult {
  std::string name;
  bool usesFloat = false;
  std::array<Score, kLevels> score;  ///< by kLevelSettings
  double time_ns = 0;                ///< a fit at kTimedLevel
};

inline constexpr std::size_t kTimedLevel = 1;  ///< 0.1 %: the level that tables and pictures are about
inline constexpr std::size_t kNoisyLevel = 2;
inline constexpr std::size_t kWideLevel = 3;  ///< touches of any width

/// Runs all methods on `contacts` readings of each level. The last two are global searches in double, for
/// lines and with the width: the references.
std::vector<MethodResult> locatorResults(const BenchFinger& finger, const Bundle& bundle, int contacts);

/// Instructions of a fit.
struct Count {
  double median, most95, most;
};
/// The emulated processors, as tables and pictures name them.
inline constexpr std::array<const char*, 3> kCores{"Cortex-M4", "Cortex-M4 with FPU", "Cortex-M0+"};
inline constexpr std::size_t kM4 = 0, kM4WithFpu = 1;

/// What count_instructions.py counted, by core, method and level.
class Counts {
 public:
  Counts() = default;  ///< nothing was counted
  /// Throws Failure(kFailure) for a file that cannot be read or holds something else.
  explicit Counts(const std::string& path);

  /// NaNs where nothing was counted.
  Count of(std::size_t core, const std::string& method, std::size_t level) const;
  bool empty() const { return counts_.empty(); }

 private:
  std::map<std::array<std::string, 3>, Count> counts_;
};

/// Median where it is least on a Cortex-M4: with the FPU for those that have a use for it. NaN: not counted.
double countOnM4(const MethodResult& result, const Counts& counts, std::size_t level);

}  // namespace strainfinger::bench
