#include "host/calibration/moved_zero.hpp"

#include <fmt/format.h>

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <optional>
#include <span>
#include <tuple>

#include "host/base/chi_squared.hpp"
#include "host/calibration/model_error.hpp"

namespace strainfinger::calibration {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// [standard deviations of a reading] The shift whose log likelihood is compared with that of none. A row
/// that is half as far off counts for neither; what the model leaves in rows of like touches, as large as
/// noise as a rule, therefore counts against a shift.
constexpr double kTriedShift = 4;
/// [1, of a log likelihood ratio] What one row counts at most, for or against: noise does that to one row in
/// 200, and for a false alarm six rows of junk or more must follow each other, off alike.
constexpr double kMostOfOneRow = 3;
/// Of healthy sessions: those in which a zero is told to have moved.
constexpr double kFalseAlarms = 1e-3;
/// [noise] A smaller shift is as large as what the model leaves, in touches that are alike.
constexpr double kLeastShift = 3;
/// Of the rows of a segment: as many must be explained once the zeros that moved are taken off, as other rows
/// are or but for a twentieth of their chi-squared (a touch is no linear function of what it reads). Two
/// contacts and slips are off at many gauges, and differ from row to row.
constexpr double kLeastExplained = 0.6, kMostLeftOver = 0.05;
/// Of the freedom that a touch leaves: with less of it left any row is explained. Of 16 gauges, four may move
/// at once.
constexpr double kLeastFree = 0.6;
/// [1] Of what a gauge reads: with less left the touch suits whatever it reads.
constexpr double kLeastTold = 1e-3;

constexpr std::size_t kMostShiftsTold = 8;  ///< in words

using Rows = std::vector<ZeroEvidence>;

struct Weighed {
  double value, weight;
};

/// The value that half of the weight is below; 0 where there is none.
double weightedMedian(std::vector<Weighed> values) {
  std::sort(values.begin(), values.end(), [](const auto& a, const auto& b) { return a.value < b.value; });
  double half = 0;
  for (const Weighed& each : values) half += each.weight / 2;
  for (const Weighed& each : values)
    if ((half -= each.weight) <= 0) return each.value;
  return 0;
}

/// Rows from `first` to before `end`, counted from 0 among those that tell something, and what they count.
struct Segment {
  std::size_t first = 0, end = 0;
  double sum = 0;
};

/// How far each row alone has a gauge's zero off [strain], weighed by what it tells of it.
std::vector<Weighed> shiftsOf(const Rows& rows, Index gauge, const Segment& segment) {
  std::vector<Weighed> shifts;
  for (std::size_t i = segment.first; i < segment.end; ++i) {
    const double left = rows[i].left(gauge, gauge);
    if (left > kLeastTold) shifts.push_back({rows[i].sigma_strain * rows[i].residual[gauge] / left, left});
  }
  return shifts;
}

/// The log likelihood ratio of a shift of kTriedShift from where the gauge's zero mostly is, against none.
double scoreOf(const ZeroEvidence& row, Index gauge, double centre, double sign) {
  const double left = row.left(gauge, gauge);
  if (left < kLeastTold) return 0;
  const double off = sign * (row.residual[gauge] - centre * left);
  return std::clamp(kTriedShift * off - kTriedShift * kTriedShift / 2 * left, -kMostOfOneRow, kMostOfOneRow);
}

/// The segment that counts most (Kadane) for a shift from `centre_strain`; of no length where no row does.
Segment mostCounting(const Rows& rows, Index gauge, double centre_strain, double sign) {
  Segment best, here;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (here.sum <= 0) here = {i, i, 0};
    here.sum += scoreOf(rows[i], gauge, centre_strain / rows[i].sigma_strain, sign);
    here.end = i + 1;
    if (here.sum > best.sum) best = here;
  }
  return best;
}

/// A sum beyond this is no chance: one from a given row on exceeds it with the probability exp(-sum) at most
/// (Ville 1939; limits on both sides alike don't raise the ratio's mean of 1), and it may begin at any row,
/// of any gauge, up or down. 18.4 for 3,000 rows of 16 gauges.
double beyondChance(const Rows& rows, Index gauges) {
  return std::log(2 * static_cast<double>(gauges) * static_cast<double>(rows.size()) / kFalseAlarms);
}

struct Found {
  Index gauge;
  Segment segment;
  double strain;
};

/// The one whose rows count most; none where chance makes as much.
std::optional<Found> mostMoved(const Rows& rows, double noise_strain) {
  const Index gauges = rows.front().residual.size();
  double most = beyondChance(rows, gauges);
  std::optional<Found> found;
  for (Index gauge = 0; gauge < gauges; ++gauge) {
    const double centre_strain = weightedMedian(shiftsOf(rows, gauge, {0, rows.size()}));
    for (const double sign : {1.0, -1.0}) {
      const Segment segment = mostCounting(rows, gauge, centre_strain, sign);
      if (segment.sum <= most) continue;
      const double strain = weightedMedian(shiftsOf(rows, gauge, segment));
      if (sign * strain < kLeastShift * noise_strain) continue;
      most = segment.sum;
      found = {gauge, segment, strain};
    }
  }
  return found;
}

/// What is left of a row once that gauge's zero suits, whatever it is.
void takeOff(ZeroEvidence& row, Index gauge) {
  const VectorXd column = row.left.col(gauge);
  if (column[gauge] < kLeastTold) return;
  row.residual -= column * (row.residual[gauge] / column[gauge]);
  row.left -= column * column.transpose() / column[gauge];
}

std::vector<double> chiSquareds(const Rows& rows) {
  std::vector<double> values;
  for (const ZeroEvidence& row : rows) values.push_back(row.residual.squaredNorm());
  return values;
}

/// Whether zeros that moved explain most rows of a segment: `rows` is what these left, `before` chi-squared.
bool isExplained(const Segment& segment, const std::vector<double>& before, const Rows& rows) {
  const auto freedom = static_cast<double>(rows.front().residual.size() - kTouchUnknowns);
  const double most = chiSquaredQuantile(freedom, kBeyondChance);
  int explained = 0;
  for (std::size_t i = segment.first; i < segment.end; ++i)
    explained += rows[i].residual.squaredNorm() < std::max(most, kMostLeftOver * before[i]) &&
                 rows[i].left.trace() > kLeastFree * freedom;
  return explained >= kLeastExplained * static_cast<double>(segment.end - segment.first);
}

}  // namespace

ZeroEvidence zeroEvidence(std::size_t row, const RingResponse& ring, const TouchData& data,
                          const TouchState& touch) {
  const TouchEquations at(ring, data, touch, false);
  const Index gauges = ring.gauges();
  return {row, data.sigma_strain, at.residual,
          MatrixXd::Identity(gauges, gauges) - at.toTouch * at.matrix.ldlt().solve(at.toTouch.transpose())};
}

std::vector<MovedZero> movedZeros(std::vector<ZeroEvidence> rows, double noise_strain) {
  std::vector<MovedZero> moved;
  if (rows.empty()) return moved;
  const std::vector<double> before = chiSquareds(rows);
  std::vector<Found> all;
  while (const auto found = mostMoved(rows, noise_strain)) {
    all.push_back(*found);
    // what the other gauges leave of it would name them, too
    for (std::size_t i = found->segment.first; i < found->segment.end; ++i) takeOff(rows[i], found->gauge);
  }
  for (const auto& [gauge, segment, strain] : all)
    if (isExplained(segment, before, rows))
      moved.push_back({static_cast<int>(gauge), rows[segment.first].row, rows[segment.end - 1].row, strain});
  std::sort(moved.begin(), moved.end(), [](const MovedZero& a, const MovedZero& b) {
    return std::tie(a.gauge, a.firstRow) < std::tie(b.gauge, b.firstRow);
  });
  return moved;
}

std::string textOf(const std::vector<MovedZero>& moved) {
  std::string text;
  const std::size_t named = std::min(moved.size(), kMostShiftsTold);
  for (const MovedZero& each : std::span(moved).first(named))
    text += fmt::format("{}gauge {} reads {:.0f} microstrain {} in rows {} to {}", text.empty() ? "" : "; ",
                        each.gauge, 1e6 * std::abs(each.strain), each.strain > 0 ? "more" : "less",
                        each.firstRow, each.lastRow);
  if (moved.size() > named) text += fmt::format("; {} more", moved.size() - named);
  return text;
}

}  // namespace strainfinger::calibration
