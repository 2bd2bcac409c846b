#pragma once
// The fit within one window: Gauss-Newton steps of a variable projection from tabled rows.

#include <array>
#include <cstdint>

#include "common/table_image.hpp"
#include "firmware/core/signal.hpp"

namespace strainfinger::firmware {

/// Offset from a window's middle gauge, in pitches * 2^20.
using PitchQ20 = std::int32_t;
inline constexpr int kPitchBits = 20;
inline constexpr PitchQ20 kOnePitch = 1 << kPitchBits;
inline constexpr int kRowBits = 14;
inline constexpr PitchQ20 kRowSpacing = 1 << kRowBits;
static_assert(kOnePitch / kRowSpacing == kRowsPerPitch);

/// A step: from a row of the table towards the offset where the window's readings fit best.
struct FitStep {
  std::array<std::int32_t, 2> projection;  ///< onto the row's basis [scaled strain * 2^15]
  std::int32_t information;                ///< energy of the gradient / 4^gradient_exponent
  std::int32_t energy;                     ///< explained, once the step is taken
  PitchQ20 length;                         ///< at most an eighth of a pitch either way
};
FitStep fitStep(const FitRow& row, const Signal& signal);

/// Energy explained with the contact `beyondRow` from the row's offset, at most an eighth of a pitch.
std::int32_t explainedEnergy(const FitRow& row, const Signal& signal, PitchQ20 beyondRow);

/// The tables a fit works with, by FitSense.
using FitTables = std::array<const FitTable*, 2>;

/// A contact as one window sees it.
struct WindowFit {
  Signal signal{};      ///< as seen from `side`
  int centre = 0;       ///< the window's middle gauge
  int side = 1;         ///< +1: the offset counts towards +theta
  PitchQ20 offset = 0;  ///< from the middle gauge; may come out slightly negative
  FitSense sense = kWithOffset;
  int row = 0;  ///< the row the last step was taken from
  std::int32_t energy = 0;
  std::int32_t information = 0;
  std::array<std::int32_t, 2> projection{};

  PitchQ20 position() const { return centre * kOnePitch + side * offset; }
};

/// Steps until the next one would no longer matter, within 5/8 of a row spacing of its row: two steps are
/// typical. Changes sides where the fit walks across the middle gauge. False: not there after eight steps, or
/// walked beyond the last row; the fit is then no answer.
bool refine(const FitTables& tables, int mirrorSign, WindowFit& fit);

/// Amplitudes of the two loads at the fit's offset, and how they change per row spacing of it. In strains at
/// the response's peak, scaled as the signal, * 2^(amplitude_exponent - 1). `tangential` is + towards the
/// fit's side.
struct Amplitudes {
  std::int32_t normal;
  std::int32_t tangential;
  std::int32_t normalSlope;
  std::int32_t tangentialSlope;
};
Amplitudes amplitudesOf(const FitTables& tables, const WindowFit& fit);

}  // namespace strainfinger::firmware
