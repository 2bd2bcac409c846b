#pragma once
// The least-squares fit over one window of gauges, in real numbers: what the rows of a fit table hold.

#include <Eigen/Core>
#include <array>
#include <optional>

#include "common/table_image.hpp"
#include "host/model/impulse_response.hpp"

namespace strainfinger::tables {

/// What a fit reads: a window's gauges from the one farthest on the - side on, then the difference of the
/// outer pair over sqrt(2), which has the noise of a reading; 0 in rings without.
inline constexpr int kWindowReadings = kWindowGauges + 1;
using WindowVector = Eigen::Matrix<double, kWindowReadings, 1>;
using WindowMatrix = Eigen::Matrix<double, kWindowReadings, 2>;

/// Readings of a window that take part.
using GaugeMask = std::array<bool, kWindowReadings>;
inline constexpr GaugeMask kAllGauges{true, true, true, true, true, true, true, true};

/// Responses of a window's readings to a contact `offset` pitches towards + from the middle gauge: columns
/// normal and tangential [strain per N/m]; `slope` is their derivative by the offset in pitches.
struct WindowResponse {
  WindowMatrix value;
  WindowMatrix slope;
};
WindowResponse windowResponse(const model::ImpulseResponse& response, int gaugeCount, double offset_pitch);

/// Variable projection (Golub & Pereyra 1973, with Kaufman's simplification): with B = U R the loads of given
/// offset are R^-1 U^T s, what remains is s - U U^T s, and its derivative by the offset is -W (U^T s).
struct WindowFit {
  WindowMatrix basis;               ///< U, orthonormal, first column along the normal response
  Eigen::Matrix2d amplitude;        ///< R^-1, upper triangular
  WindowMatrix gradient;            ///< W = (1 - U U^T) B' R^-1
  Eigen::Matrix2d amplitude_slope;  ///< d(loads)/d(offset in pitches) for loads = R^-1 u: -R^-1 U^T B' R^-1
};
WindowFit windowFit(const WindowResponse& response, const GaugeMask& mask);

/// The gauges of kTripleList[triple].
GaugeMask gaugesOfTriple(std::size_t triple);

/// Load directions, as tangential / normal load.
struct DirectionRange {
  double least;
  double most;
};

/// Of all triples, the one whose standard errors of offset and loads, each over the whole window's, are least
/// in the worst case over `directions`. Three gauges see the offset through one number, which vanishes for
/// one load direction: it must lie outside. (For the three nearest gauges it is 0 when the contact is over
/// the middle one.) Its number in kTripleList; none if there is none.
std::optional<std::uint8_t> bestTriple(const WindowResponse& response, DirectionRange directions);

}  // namespace strainfinger::tables
