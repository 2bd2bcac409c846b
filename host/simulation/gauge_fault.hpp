#pragma once
// Gauges that fail.

#include <cstdint>
#include <string>
#include <vector>

namespace strainfinger::simulation {

/// One gauge that fails at one moment, for good.
struct GaugeFault {
  enum class Kind { kDead, kOpen, kShort, kStuck, kNoisy };
  static constexpr double kNoisier = 10;  ///< noise of a noisy gauge over a healthy one's

  Kind kind = Kind::kDead;
  std::uint32_t gauge = 0;
  double start_s = 0;
  bool operator==(const GaugeFault&) const = default;
};

/// "dead, open, .."
std::string gaugeFaultKinds();

/// "dead:5", "stuck:5@2.5": kind, gauge, and the second it begins (0 without).
///   dead: feels nothing; open: upper rail; short: lower rail; stuck: stays at what it read; noisy: noise
///   ten times what it should be.
/// Throws Failure(kUsage) with the text and what would be right.
GaugeFault readGaugeFault(const std::string& text);

/// Throws Failure(kUsage) where a fault is of a gauge that a ring of so many doesn't have.
void requireGauges(const std::vector<GaugeFault>& faults, int count);

}  // namespace strainfinger::simulation
