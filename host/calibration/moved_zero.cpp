#include "host/calibration/moved_zero.hpp"

#include <algorithm>
#include <cmath>

namespace strainfinger::calibration {
namespace {

/// A zero moved where so many rows at least, and of the rows at that end of the session so large a part, are
/// explained by no touch, and half of them leave more than so many times the noise at one gauge.
constexpr int kLeastMoved = 8;
constexpr double kMostlyMoved = 0.8, kMovedNoises = 5;

/// Of a session from `first` on: the longest end of which the rows are mostly unexplained.
struct End {
  std::size_t first, last;  ///< of the rows; counted from 0
  int unexplained = 0, fitted = 0;
};

End unexplainedEnd(const std::vector<RowResult>& rows, bool isBeginning) {
  End end{0, 0}, best{0, 0};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::size_t row = isBeginning ? i : rows.size() - 1 - i;
    end.unexplained += rows[row].use == RowUse::kUnexplained;
    end.fitted += rows[row].use == RowUse::kFitted;
    end.first = isBeginning ? 0 : row;
    end.last = isBeginning ? row : rows.size() - 1;
    if (end.unexplained - end.fitted > best.unexplained - best.fitted) best = end;
  }
  return best;
}

double medianResidual(const std::vector<RowResult>& rows, const End& end, Eigen::Index gauge) {
  std::vector<double> residuals;
  for (std::size_t row = end.first; row <= end.last; ++row)
    if (rows[row].use == RowUse::kUnexplained) residuals.push_back(rows[row].residual_strain[gauge]);
  const auto middle = residuals.begin() + static_cast<std::ptrdiff_t>(residuals.size() / 2);
  std::nth_element(residuals.begin(), middle, residuals.end());
  return *middle;
}

}  // namespace

std::optional<MovedZero> movedZero(const std::vector<RowResult>& rows, const config::Gauges& gauges) {
  const End beginning = unexplainedEnd(rows, true), ending = unexplainedEnd(rows, false);
  const End& end = beginning.unexplained > ending.unexplained ? beginning : ending;
  if (end.unexplained < kLeastMoved || end.unexplained < kMostlyMoved * (end.unexplained + end.fitted))
    return std::nullopt;
  MovedZero moved{0, end.first + 1, end.last + 1, 0};
  for (int gauge = 0; gauge < gauges.count; ++gauge) {
    const double strain = medianResidual(rows, end, gauge);
    if (std::abs(strain) > std::abs(moved.strain)) moved = {gauge, moved.firstRow, moved.lastRow, strain};
  }
  if (std::abs(moved.strain) < kMovedNoises * gauges.noise_strain) return std::nullopt;
  return moved;
}

}  // namespace strainfinger::calibration
