#include "firmware/core/window_fit.hpp"

#include <algorithm>
#include <bit>

namespace strainfinger::firmware {
namespace {

constexpr PitchQ20 kLongestStep = kOnePitch / 8;
/// A step this short lands so near its row that another would change nothing that matters; a little more than
/// half a spacing, so that two neighbouring rows can't hand a fit to and fro.
constexpr PitchQ20 kConverged = kRowSpacing * 5 / 8;
constexpr int kMaxSteps = 8;
constexpr int kQuotientBits = 14;

/// numerator / denominator [* 2^14], saturating at +-4; 0 where the denominator says nothing.
std::int32_t quotientQ14(std::int32_t numerator, std::int32_t denominator) {
  if (denominator <= 0) return 0;
  const int excess = 17 - std::countl_zero(static_cast<std::uint32_t>(denominator));  // beyond 15 bits
  const std::int64_t dividend =
      excess >= 0 ? std::int64_t{numerator} >> excess : std::int64_t{numerator} * (1 << -excess);
  const std::int32_t divisor = excess >= 0 ? denominator >> excess : denominator * (1 << -excess);
  constexpr std::int64_t limit = (1 << (30 - kQuotientBits)) - 1;
  return static_cast<std::int32_t>(std::clamp(dividend, -limit, limit)) * (1 << kQuotientBits) / divisor;
}

PitchQ20 stepLength(std::int32_t quotient_q14, int gradientExponent) {
  const int up = kPitchBits - kQuotientBits - gradientExponent;
  const std::int64_t length =
      up >= 0 ? std::int64_t{quotient_q14} * (std::int64_t{1} << up) : std::int64_t{quotient_q14} >> -up;
  return static_cast<PitchQ20>(std::clamp<std::int64_t>(length, -kLongestStep, kLongestStep));
}

int nearestRow(PitchQ20 offset) {
  return std::min<int>((offset + kRowSpacing / 2) >> kRowBits, kFitRows - 1);
}

const FitRow& rowOf(const FitTables& tables, const WindowFit& fit) {
  return (*tables[fit.sense])[static_cast<std::size_t>(fit.row)];
}

void turnToItsSide(WindowFit& fit, int mirrorSign) {
  if (fit.offset >= 0) return;
  fit.offset = -fit.offset;
  fit.side = -fit.side;
  fit.sense = fit.sense == kWithOffset ? kAgainstOffset : kWithOffset;
  fit.signal = mirrored(fit.signal, mirrorSign);
}

/// An amplitude's coefficient times a projection, * 2^-16.
std::int32_t scaledBy(std::int16_t coefficient, std::int32_t projection) {
  return mulHigh(std::int32_t{coefficient} * 65536, projection);
}

}  // namespace

FitStep fitStep(const FitRow& row, const Signal& signal) {
  const std::int32_t u1 = project(row.basis[0], signal), u2 = project(row.basis[1], signal);
  const std::int32_t n1 = project(row.gradient[0], signal), n2 = project(row.gradient[1], signal);
  const std::int32_t v1 = u1 >> row.lag[0], v2 = u2 >> row.lag[1];
  const std::int32_t numerator = mulHigh(v1, n1) + mulHigh(v2, n2);
  // Energies stay below 2^27 and Gram numbers (2^14) below 2^15: their high product after these shifts is
  // energy * gram.
  const auto times = [](std::int32_t energy, std::int16_t gram) {
    return mulHigh(energy * 8, std::int32_t{gram} * 32768);
  };
  FitStep step;
  step.projection = {u1, u2};
  step.information = times(mulHigh(v1, v1), row.gram[0]) + times(mulHigh(v1, v2), row.gram[1]) +
                     times(mulHigh(v2, v2), row.gram[2]);
  const std::int32_t quotient = quotientQ14(numerator, step.information);
  step.energy =
      energyOf(u1, u2) + static_cast<std::int32_t>((std::int64_t{numerator} * quotient) >> kQuotientBits);
  step.length = stepLength(quotient, row.gradient_exponent);
  return step;
}

bool refine(const FitTables& tables, int mirrorSign, WindowFit& fit) {
  for (int count = 0; count < kMaxSteps; ++count) {
    turnToItsSide(fit, mirrorSign);
    fit.row = nearestRow(fit.offset);
    const FitStep step = fitStep(rowOf(tables, fit), fit.signal);
    fit.projection = step.projection;
    fit.information = step.information;
    fit.energy = step.energy;
    fit.offset = fit.row * kRowSpacing + step.length;
    if (step.length <= kConverged && step.length >= -kConverged) return true;
  }
  return false;
}

Amplitudes amplitudesOf(const FitTables& tables, const WindowFit& fit) {
  const FitRow& row = rowOf(tables, fit);
  const auto [u1, u2] = fit.projection;
  Amplitudes result;
  result.normalSlope = scaledBy(row.load_slope[0], u1) + scaledBy(row.load_slope[1], u2);
  result.tangentialSlope = scaledBy(row.load_slope[2], u1) + scaledBy(row.load_slope[3], u2);
  const std::int64_t beyondRow = fit.offset - fit.row * kRowSpacing;
  const auto moved = [&](std::int32_t atRow, std::int32_t slope) {
    return atRow + static_cast<std::int32_t>((slope * beyondRow) >> kRowBits);
  };
  result.normal = moved(scaledBy(row.load[0], u1) + scaledBy(row.load[1], u2), result.normalSlope);
  result.tangential = moved(scaledBy(row.load[2], u2), result.tangentialSlope);
  return result;
}

}  // namespace strainfinger::firmware
