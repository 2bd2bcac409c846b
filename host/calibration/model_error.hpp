#pragma once
// How much more than noise is left of readings that were fitted.

#include <vector>

#include "host/calibration/calibrate.hpp"

namespace strainfinger::calibration {

/// Of one touch: the sum of its squared residuals, and its largest reading [strain].
struct Misfit {
  double squares;
  double peak_strain;
};

/// The model error e for which residuals have the variance noise^2 + (e peak)^2: that makes the median of the
/// touches' reduced chi-squared what it should be, so that a tenth of them may be junk. 0 where noise alone
/// explains them; its sigma is what e could be and not be noticed. Domain: at least one touch.
Estimate modelErrorOf(const std::vector<Misfit>& misfits, double noise_strain, double degreesOfFreedom);

/// Standard deviations of chi-squared that no touch leaves by chance: one in 300,000 is beyond its quantile.
inline constexpr double kBeyondChance = 4.5;

}  // namespace strainfinger::calibration
