#include "host/calibration/model_error.hpp"

#include <cmath>
#include <numbers>

#include "host/base/chi_squared.hpp"
#include "host/base/quantile.hpp"

namespace strainfinger::calibration {

Estimate modelErrorOf(const std::vector<Misfit>& misfits, double noise_strain, double degreesOfFreedom) {
  const double expected = chiSquaredQuantile(degreesOfFreedom, 0);
  const auto excess = [&](double error) {
    std::vector<double> chiSquareds;
    for (const Misfit& misfit : misfits)
      chiSquareds.push_back(misfit.squares /
                            (noise_strain * noise_strain + std::pow(error * misfit.peak_strain, 2)));
    return medianOf(chiSquareds) - expected;
  };
  double low = 0, high = 1;
  constexpr int kBisections = 40;
  if (excess(0) > 0)
    for (int i = 0; i < kBisections; ++i) {
      const double middle = (low + high) / 2;
      (excess(middle) > 0 ? low : high) = middle;
    }
  std::vector<double> peaks;
  for (const Misfit& misfit : misfits) peaks.push_back(misfit.peak_strain);
  // The variance of a reading is known to sqrt(2 / all degrees of freedom) of itself; the median costs
  // pi / 2.
  const double relative =
      std::sqrt(std::numbers::pi / (degreesOfFreedom * static_cast<double>(misfits.size())));
  const double noise = noise_strain / medianOf(peaks), variance = noise * noise + low * low;
  const double squared = relative * variance;
  return {low, low > std::sqrt(squared) ? squared / (2 * low) : std::sqrt(squared)};
}

}  // namespace strainfinger::calibration
