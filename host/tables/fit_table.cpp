#include "host/tables/fit_table.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

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
  result[kWindowGauges] = q16(weights[kWindowGauges] / std::numbers::sqrt2, 15);
  return result;
}

/// A column of the gradient so much shorter than the other is rounding noise of a zero (or adds nothing).
constexpr double kNoLength = 0x1p-16;

void fillGradient(FitRow& row, const WindowFit& fit) {
  const std::array length{fit.gradient.col(0).norm(), fit.gradient.col(1).norm()};
  const double longer = std::max(length[0], length[1]);
  int exponent = 0;
  std::frexp(longer, &exponent);
  std::array<WindowVector, 2> unit{WindowVector::Zero(), WindowVector::Zero()};
  for (std::size_t i = 0; i < 2; ++i) {
    if (length[i] > longer * kNoLength) {
      unit[i] = fit.gradient.col(static_cast<Eigen::Index>(i)) / length[i];
      row.gradient_length[i] = q16(length[i], 15 - exponent);
    }
    row.gradient[i] = folded(unit[i]);
  }
  row.gradient_cosine = q16(unit[0].dot(unit[1]), 15);
  row.gradient_exponent =
      static_cast<std::int8_t>(std::clamp(exponent, kLeastGradientExponent, kMostGradientExponent));
}

FitRow fitRow(const WindowFit& fit, const std::array<std::uint8_t, 2>& triples, int amplitudeExponent) {
  FitRow row{};
  row.basis = {folded(fit.basis.col(0)), folded(fit.basis.col(1))};
  fillGradient(row, fit);
  const auto amplitude = [&](double value) { return q16(value, amplitudeExponent); };
  row.load = {amplitude(fit.amplitude(0, 0)), amplitude(fit.amplitude(0, 1)), amplitude(fit.amplitude(1, 1))};
  row.triple = triples;
  const Eigen::Matrix2d slope = fit.amplitude_slope / kRowsPerPitch;
  row.load_slope = {amplitude(slope(0, 0)), amplitude(slope(0, 1)), amplitude(slope(1, 0)),
                    amplitude(slope(1, 1))};
  return row;
}

std::uint8_t tripleFor(const WindowResponse& response, DirectionRange directions) {
  const auto triple = bestTriple(response, directions);
  if (!triple)
    throw Failure(ExitCode::kUsage,
                  "no three neighbouring gauges can tell where a contact is, so these gauges cannot be used: "
                  "the response is too narrow or too wide for their spacing; change gauges.count or "
                  "gauges.radius_m");
  return *triple;
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
    fits.rows[row] = windowFit(response, kAllGauges);
    fits.triples[row] = {tripleFor(response, {-overlap, cone}), tripleFor(response, {-cone, overlap})};
  }
  return fits;
}

int amplitudeExponent(const WindowFits& fits) {
  double largest = 0;
  for (const WindowFit& fit : fits.rows) {
    largest = std::max({largest, fit.amplitude.cwiseAbs().maxCoeff(),
                        fit.amplitude_slope.cwiseAbs().maxCoeff() / kRowsPerPitch});
  }
  int exponent = 0;
  std::frexp(largest, &exponent);
  return 15 - exponent;
}

FitTable fitTable(const WindowFits& fits, int amplitudeExponent) {
  FitTable table;
  std::transform(
      fits.rows.begin(), fits.rows.end(), fits.triples.begin(), table.begin(),
      [&](const WindowFit& fit, const auto& triples) { return fitRow(fit, triples, amplitudeExponent); });
  return table;
}

}  // namespace strainfinger::tables
