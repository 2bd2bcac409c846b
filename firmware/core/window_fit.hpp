#pragma once
// The fit within one window: Gauss-Newton steps of a variable projection from tabled rows.

#include <algorithm>
#include <cstdint>

#include "firmware/core/fit_step.hpp"

namespace strainfinger::firmware {

/// A contact as one window sees it.
struct WindowFit {
  Signal signal;  ///< as seen from `side`
  int centre;     ///< the window's middle gauge
  int side;       ///< +1: the offset counts towards +theta
  int row;        ///< that the step was taken from
  FitStep step;

  /// At a row (negative: on the - side), before the first step.
  void start(const Signal& window, int middle, int atRow, int mirrorSign) {
    signal = atRow >= 0 ? window : mirrored(window, mirrorSign);
    centre = middle;
    side = atRow >= 0 ? 1 : -1;
    row = absolute(atRow);
  }

  /// From the middle gauge; may come out slightly negative.
  PitchQ20 offset() const { return row * kRowSpacing + step.length; }
  PitchQ20 position() const { return centre * kOnePitch + side * offset(); }
};

inline int nearestRow(PitchQ20 offset) {
  constexpr int kBits = kRowBits + kRowStrideBits, kLast = (kFitRows - 1) >> kRowStrideBits;
  return std::min<int>((offset + (1 << kBits) / 2) >> kBits, kLast) << kRowStrideBits;
}

/// To the row nearest to where the last step leads; over the middle gauge if need be.
inline void follow(WindowFit& fit, Number length, int mirrorSign) {
  PitchQ20 offset = fit.row * kRowSpacing + length;
  if (offset < 0) {
    offset = -offset;
    fit.side = -fit.side;
    fit.signal = mirrored(fit.signal, mirrorSign);
  }
  fit.row = nearestRow(offset);
}

inline void takeStep(const FitTable& rows, WindowFit& fit) {
  fit.step = fitStep(*unknown(unknown(rows.data()) + fit.row), fit.signal);
}

constexpr bool isConverged(Number length) { return length <= kConverged && length >= -kConverged; }

/// Beside a gauge two neighbouring rows may hand a fit to and fro all the same (24 of 400,000 contacts at
/// 0.1 % of noise): where it ends is between them.
[[gnu::noinline, gnu::cold]] inline bool isBetweenRows(Number length) {
  return length < kRowSpacing && length > -kRowSpacing;
}

/// Steps from the fit's row until the next one would no longer matter, within kConverged of its row: two are
/// typical. False: not there after eight steps, or walked beyond the last row; the fit is then no answer.
inline bool refine(const FitTable& rows, int mirrorSign, WindowFit& fit) {
  const FitRow* const first = unknown(rows.data());
  FitStep step = fitStep(*unknown(first + fit.row), fit.signal);
  for (int left = kMostSteps - 1; left > 0 && !isConverged(step.length); --left) {
    follow(fit, step.length, mirrorSign);
    step = fitStep(*unknown(first + fit.row), fit.signal);
  }
  fit.step = step;
  return isConverged(step.length) || isBetweenRows(step.length);
}

}  // namespace strainfinger::firmware
