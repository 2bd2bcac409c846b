#include "host/tables/fit_table.hpp"

#include <algorithm>
#include <cmath>

#include "common/fixed_real.hpp"

namespace strainfinger::tables {
namespace {

std::int16_t q16(double value, int fracBits) {
  return saturate<std::int16_t>(std::llround(std::ldexp(value, fracBits)));
}

FoldedWeights folded(const WindowVector& weights) {
  FoldedWeights result{};
  result[0] = q16(weights[kWindowReach], 15);
  for (int distance = 1; distance <= kWindowReach; ++distance) {
    const double plus = weights[kWindowReach + distance];
    const double minus = weights[kWindowReach - distance];
    result[static_cast<std::size_t>(distance)] = q16((plus + minus) / 2, 15);
    result[static_cast<std::size_t>(distance + kWindowReach)] = q16((plus - minus) / 2, 15);
  }
  return result;
}

/// The power of two that brings a length into [1/2, 1).
int lengthExponent(const WindowVector& vector) {
  int exponent = 0;
  std::frexp(vector.norm(), &exponent);
  return exponent;
}

void fillGradient(FitRow& row, const WindowFit& fit) {
  std::array<WindowVector, 2> scaled;
  std::array<int, 2> exponent{};
  for (int i = 0; i < 2; ++i) {
    const auto index = static_cast<std::size_t>(i);
    exponent[index] = lengthExponent(fit.gradient.col(i));
    scaled[index] = fit.gradient.col(i) * std::ldexp(1.0, -exponent[index]);
    row.gradient[index] = folded(scaled[index]);
  }
  const int larger = std::max(exponent[0], exponent[1]);
  row.gradient_exponent = static_cast<std::int8_t>(larger);
  for (std::size_t i = 0; i < 2; ++i)
    row.lag[i] = static_cast<std::int8_t>(std::min(larger - exponent[i], 31));
  row.gram = {q16(scaled[0].dot(scaled[0]), 14), q16(2 * scaled[0].dot(scaled[1]), 14),
              q16(scaled[1].dot(scaled[1]), 14)};
}

FitRow fitRow(const WindowFit& fit, int amplitudeExponent) {
  FitRow row{};
  row.basis = {folded(fit.basis.col(0)), folded(fit.basis.col(1))};
  fillGradient(row, fit);
  const auto amplitude = [&](double value) { return q16(value, amplitudeExponent); };
  row.load = {amplitude(fit.amplitude(0, 0)), amplitude(fit.amplitude(0, 1)), amplitude(fit.amplitude(1, 1))};
  const Eigen::Matrix2d slope = fit.amplitude_slope / kRowsPerPitch;
  row.load_slope = {amplitude(slope(0, 0)), amplitude(slope(0, 1)), amplitude(slope(1, 0)),
                    amplitude(slope(1, 1))};
  return row;
}

}  // namespace

WindowFits windowFits(const model::ImpulseResponse& response, int gaugeCount, double unit, double cone) {
  WindowFits fits;
  for (std::size_t row = 0; row < kFitRows; ++row) {
    const auto window = windowResponse(response, gaugeCount, static_cast<double>(row) / kRowsPerPitch, unit);
    fits.refined[row] = windowFit(window, kAllGauges);
    // A triple good for one sense of the tangential load serves small loads of the other one too.
    const double overlap = cone / 8;
    fits.threePoint[kWithOffset][row] = windowFit(window, bestTriple(window, {-overlap, cone}));
    fits.threePoint[kAgainstOffset][row] = windowFit(window, bestTriple(window, {-cone, overlap}));
  }
  return fits;
}

int amplitudeExponent(const WindowFits& fits) {
  double largest = 0;
  for (const auto* table : {&fits.refined, &fits.threePoint[0], &fits.threePoint[1]}) {
    for (const WindowFit& fit : *table) {
      largest = std::max({largest, fit.amplitude.cwiseAbs().maxCoeff(),
                          fit.amplitude_slope.cwiseAbs().maxCoeff() / kRowsPerPitch});
    }
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  return 15 - exponent;
}

FitTable fitTable(const std::array<WindowFit, kFitRows>& fits, int amplitudeExponent) {
  FitTable table;
  std::transform(fits.begin(), fits.end(), table.begin(),
                 [&](const WindowFit& fit) { return fitRow(fit, amplitudeExponent); });
  return table;
}

}  // namespace strainfinger::tables
