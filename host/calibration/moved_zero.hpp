#pragma once
// Zeros that moved while the finger was being touched, by what single rows tell of them.

#include <Eigen/Core>
#include <string>
#include <vector>

#include "host/calibration/touch_fit.hpp"

namespace strainfinger::calibration {

/// What a row of readings tells of how far each gauge's zero is off, whatever its touch.
struct ZeroEvidence {
  std::size_t row;           ///< of the session, counted from 1
  double sigma_strain;       ///< of one of its readings
  Eigen::VectorXd residual;  ///< a gauge each, in these standard deviations
  /// A column a gauge: what is left of 1 at that gauge once the touch suits. Symmetric; for a zero that is
  /// off by d (in standard deviations) the residual is d times its column, of noise it is the covariance.
  Eigen::MatrixXd left;
};

/// Domain: `touch` is where data's chi-squared is least, of a load other than 0 or known. Costs 40 us.
ZeroEvidence zeroEvidence(std::size_t row, const RingResponse& ring, const TouchData& data,
                          const TouchState& touch);

struct MovedZero {
  int gauge;
  std::size_t firstRow, lastRow;  ///< where it was another one; counted from 1
  double strain;  ///< how much more it read there than by the zero that the finger was fitted with
};

/// A gauge each and the rows, where they are those of a zero that moved, at the beginning, in the middle or
/// at the end; by gauges, then by rows. A gauge is named again where its zero moved more than once.
/// Domain: rows in the order of the session, all of one number of gauges; most of them of the zero that the
/// finger was fitted with; noise_strain > 0.
/// A session without any has a false alarm less than once in 1,000, whatever its length.
/// Cost: linear in rows; 3,000 of 16 gauges take 10 ms, and 10 ms for each that moved.
std::vector<MovedZero> movedZeros(std::vector<ZeroEvidence> rows, double noise_strain);

/// "gauge 5 reads 80 microstrain more in rows 301 to 456; gauge 9 ..", of many the first; empty for none.
std::string textOf(const std::vector<MovedZero>& moved);

}  // namespace strainfinger::calibration
