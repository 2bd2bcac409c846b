#include "host/tables/fit_table.hpp"

#include <algorithm>
#include <cmath>

#include "common/fixed_real.hpp"
#include "host/base/failure.hpp"

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

/// A column of the gradient so much shorter than the other is rounding noise of a zero (or adds nothing).
constexpr int kLargestLag = 31;

void fillGradient(FitRow& row, const WindowFit& fit) {
  const std::array exponent{lengthExponent(fit.gradient.col(0)), lengthExponent(fit.gradient.col(1))};
  const int larger = std::max(exponent[0], exponent[1]);
  std::array<WindowVector, 2> scaled{WindowVector::Zero(), WindowVector::Zero()};
  for (std::size_t i = 0; i < 2; ++i) {
    const int lag = std::min(larger - exponent[i], kLargestLag);
    if (lag < kLargestLag)
      scaled[i] = fit.gradient.col(static_cast<Eigen::Index>(i)) * std::ldexp(1.0, -exponent[i]);
    row.gradient[i] = folded(scaled[i]);
    row.lag[i] = static_cast<std::int8_t>(lag);
  }
  row.gradient_exponent = static_cast<std::int8_t>(larger);
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

WindowFit tripleFit(const WindowResponse& response, DirectionRange directions) {
  const GaugeMask triple = bestTriple(response, directions);
  if (triple == GaugeMask{})
    throw Failure(ExitCode::kUsage,
                  "no three neighbouring gauges can tell where a contact is, so these gauges cannot be used: "
                  "the response is too narrow or too wide for their spacing; change gauges.count or "
                  "gauges.radius_m");
  return windowFit(response, triple);
}

}  // namespace

WindowResponses windowResponses(const model::ImpulseResponse& response, int gaugeCount) {
  WindowResponses responses;
  for (std::size_t row = 0; row < kFitRows; ++row)
    responses[row] = windowResponse(response, gaugeCount, static_cast<double>(row) / kRowsPerPitch);
  return responses;
}

double peakPerLoad(const WindowResponses& responses) {
  double peak = 0;
  for (const WindowResponse& response : responses)
    peak = std::max(peak, response.value.col(0).cwiseAbs().maxCoeff());
  return peak;
}

WindowFits windowFits(const WindowResponses& responses, double peak, double cone) {
  // A triple good for one sense of the tangential load serves small loads of the other one too.
  const double overlap = cone / 8;
  WindowFits fits;
  for (std::size_t row = 0; row < kFitRows; ++row) {
    const WindowResponse response{responses[row].value / peak, responses[row].slope / peak};
    fits.refined[row] = windowFit(response, kAllGauges);
    fits.threePoint[kWithOffset][row] = tripleFit(response, {-overlap, cone});
    fits.threePoint[kAgainstOffset][row] = tripleFit(response, {-cone, overlap});
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
