#include "host/calibration/wiring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numeric>
#include <optional>

#include "host/calibration/touch_fit.hpp"
#include "host/calibration/wiring_turn.hpp"
#include "host/config/over_range.hpp"

namespace strainfinger::calibration {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Kind = WiringFault::Kind;

/// Rows that are looked at, of those in which a gauge reads most: so many of the strongest third but for
/// those over range. The strongest alone would be alike, of firm and narrow touches right above the gauge.
constexpr std::size_t kRowsPerGauge = 6, kStrongPart = 3;
/// Touches in which a gauge or one beside it reads most; a single one may be junk. Where gauges side by side
/// have none, how the others were built looks like a fault.
constexpr std::size_t kLeastNear = 2;
/// Of a row's energy: what no touch explains counts no more than this.
constexpr double kMostMisfit = 0.15;
/// Mean share of the energy that a drawn finger leaves of a glued one's rows; with less nothing is wrong.
constexpr double kHealthy = 0.001;
/// A mend is believed if it leaves less than this share of the misfit.
constexpr double kImproved = 0.75;        ///< with all gauges: a wrong mend makes the misfit larger
constexpr double kImprovedWithout = 0.6;  ///< without a gauge that looks dead, or glued to its neighbour
constexpr double kImprovedMuch = 0.3;  ///< without any other: a healthy ring may have half of it at one gauge
/// A mend that keeps a gauge is preferred unless it leaves more than this many times what leaving out a gauge
/// leaves, or leaving out that very one: then its share of what a glued finger leaves is gone, too.
constexpr double kNearly = 1.3, kNearlyThere = 3;
/// Poisson's ratios that are tried, in tolerances below the drawing's: of all unknowns it changes the strains
/// of touches most.
constexpr double kPoissonDeviations[] = {0, -0.75, -1.5};
constexpr int kMostFaults = 4;
/// Of the mends of either sort, so many are compared on all rows.
constexpr std::ptrdiff_t kPromising = 4;
/// Of the reading of a healthy gauge beside it: less is dead. A correlation beyond kSame is its neighbour's.
constexpr double kDeadShare = 0.1, kSame = 0.8;
bool concerns(const WiringFault& fault, int gauge) {
  return fault.gauge == gauge || (fault.kind == Kind::kSwapped && fault.other == gauge);
}

/// The readings with a fault mended; of a gauge that is left out they are 0.
MatrixXd mended(const MatrixXd& readings, const WiringFault& fault) {
  MatrixXd result = readings;
  switch (fault.kind) {
    case Kind::kSwapped:
      result.col(fault.gauge).swap(result.col(fault.other));
      break;
    case Kind::kSign:
      result.col(fault.gauge) *= -1;
      break;
    case Kind::kAllSigns:
      result *= -1;
      break;
    default:
      result.col(fault.gauge).setZero();
  }
  return result;
}

/// Of each gauge the rows in which none reads more, with what it reads there [strain], weakest first.
using RowsOfGauges = std::vector<std::vector<std::pair<double, Index>>>;

RowsOfGauges rowsOfGauges(const config::Gauges& gauges, const MatrixXd& readings) {
  RowsOfGauges result(static_cast<std::size_t>(gauges.count));
  for (Index row = 0; row < readings.rows(); ++row) {
    Index gauge = 0;
    const double peak = readings.row(row).cwiseAbs().maxCoeff(&gauge);
    if (!config::isOverRange(gauges, peak)) result[static_cast<std::size_t>(gauge)].emplace_back(peak, row);
  }
  for (auto& rows : result) std::sort(rows.begin(), rows.end());
  return result;
}

class WiringCheck {
 public:
  WiringCheck(const config::FingerConfig& config, const MatrixXd& readings)
      : drawing_(config),
        lastHarmonic_(RingResponse::lastHarmonic(drawing_)),
        isLeftOut_(static_cast<std::size_t>(drawing_.gauges()), false) {
    takeStrongRows(rowsOfGauges(config.gauges, readings), readings);
    listKeepingMends();
  }

  std::vector<WiringFault> run() {
    std::vector<WiringFault> faults = leaveOutDead();
    choosePoissonRatio();
    while (misfits_.mean() > kHealthy && static_cast<int>(faults.size()) < kMostFaults) {
      const auto fault = bestMend();
      if (!fault) break;
      faults.push_back(*fault);
      readings_ = mended(readings_, *fault);
      lookAgain();
    }
    return faults;
  }

  const MatrixXd& strongRows() const { return readings_; }
  /// In tolerances from the drawing's, what explains the readings best. Domain: after run().
  double poissonDeviation() const { return poissonDeviation_; }

 private:
  VectorXd deviations() const {
    VectorXd deviations = VectorXd::Zero(drawing_.unknowns());
    deviations[drawing_.at(kPoissonRatio)] = poissonDeviation_;
    for (int gauge = 0; gauge < drawing_.gauges(); ++gauge)
      if (isLeftOut_[static_cast<std::size_t>(gauge)])
        deviations[Drawing::at(gauge, kGain)] = -1 / drawing_.tolerance(kGain);
    return deviations;
  }

  RingResponse ring() const { return {drawing_, deviations(), lastHarmonic_}; }

  struct Mend {
    WiringFault fault;
    double misfit = std::numeric_limits<double>::infinity();
  };

  /// Of each gauge, strong rows in which none reads more: a fault shows where it is touched.
  void takeStrongRows(const RowsOfGauges& ofGauges, const MatrixXd& readings) {
    std::vector<Index> strong;
    for (std::size_t gauge = 0; gauge < ofGauges.size(); ++gauge) {
      const auto& rows = ofGauges[gauge];
      const std::size_t count = std::min(rows.size(), kRowsPerGauge),
                        from = std::max(count, rows.size() / kStrongPart);
      for (std::size_t i = 0; i < count; ++i) {
        strong.push_back(rows[rows.size() - 1 - i * from / count].second);
        strongest_.push_back(static_cast<int>(gauge));
      }
    }
    readings_ = readings(strong, Eigen::all);
  }

  void listKeepingMends() {
    keeping_.push_back({Kind::kAllSigns});
    for (int gauge = 0; gauge < drawing_.gauges(); ++gauge) {
      keeping_.push_back({Kind::kSign, gauge});
      leaving_.push_back({Kind::kUnfit, gauge});
      for (int other = gauge + 1; other < drawing_.gauges(); ++other)
        keeping_.push_back({Kind::kSwapped, gauge, other});
    }
  }

  void lookAgain() {
    search_.emplace(ring(), drawing_.config());
    misfits_ = misfitsOf(readings_, std::nullopt);
  }

  /// Of each row, the share of its energy that no touch explains, but no more than kMostMisfit.
  VectorXd misfitsOf(const MatrixXd& readings, std::optional<int> leftOut) const {
    VectorXd misfits(readings.rows());
    for (Index row = 0; row < readings.rows(); ++row)
      misfits[row] = std::min(kMostMisfit, search_->unexplainedShare(readings.row(row), leftOut));
    return misfits;
  }

  /// What these rows leave with a fault mended.
  VectorXd misfitsWith(const WiringFault& fault, const std::vector<Index>& rows) const {
    const bool leavesOut = fault.kind == Kind::kUnfit;
    return misfitsOf(mended(readings_(rows, Eigen::all), fault),
                     leavesOut ? std::optional(fault.gauge) : std::nullopt);
  }

  /// The one that explains the readings best, wired as they are.
  void choosePoissonRatio() {
    double least = std::numeric_limits<double>::infinity(), best = 0;
    for (const double deviation : kPoissonDeviations) {
      poissonDeviation_ = deviation;
      lookAgain();
      if (misfits_.mean() >= least) continue;
      least = misfits_.mean();
      best = deviation;
    }
    if (poissonDeviation_ == best) return;
    poissonDeviation_ = best;
    lookAgain();
  }

  /// Gauges that read far less than both beside them: no touch does that, wherever the finger was touched.
  std::vector<WiringFault> leaveOutDead() {
    std::vector<WiringFault> faults;
    const int count = drawing_.gauges();
    const VectorXd read = readings_.colwise().norm();
    for (int gauge = 0; gauge < count; ++gauge) {
      const double beside = std::min(read[(gauge + 1) % count], read[(gauge + count - 1) % count]);
      if (read[gauge] >= kDeadShare * beside) continue;
      faults.push_back({Kind::kDead, gauge});
      isLeftOut_[static_cast<std::size_t>(gauge)] = true;
      readings_.col(gauge).setZero();
    }
    return faults;
  }

  /// The best there is, if it is good enough.
  std::optional<WiringFault> bestMend() {
    const double misfit = misfits_.mean();
    const Mend kept = bestOf(keeping_), out = bestOf(leaving_);
    const double nearly = concerns(kept.fault, out.fault.gauge) ? kNearlyThere : kNearly;
    if (kept.misfit <= kImproved * misfit && kept.misfit <= nearly * out.misfit) return kept.fault;
    const WiringFault fault = described(out.fault.gauge);
    const double most = fault.kind == Kind::kUnfit ? kImprovedMuch : kImprovedWithout;
    if (out.misfit > most * misfit) return std::nullopt;
    isLeftOut_[static_cast<std::size_t>(fault.gauge)] = true;
    return fault;
  }

  /// Of mends, the one that leaves least: those that gain most on the rows of their own gauges are compared
  /// on all rows.
  Mend bestOf(const std::vector<WiringFault>& mends) const {
    std::vector<std::pair<double, WiringFault>> gains;
    for (const WiringFault& fault : mends) {
      const auto rows = rowsAt(fault);
      gains.emplace_back((misfits_(rows) - misfitsWith(fault, rows)).sum(), fault);
    }
    const auto promising = gains.begin() + std::min<std::ptrdiff_t>(kPromising, std::ssize(gains));
    std::partial_sort(gains.begin(), promising, gains.end(),
                      [](const auto& a, const auto& b) { return a.first > b.first; });
    std::vector<Index> all(static_cast<std::size_t>(readings_.rows()));
    std::iota(all.begin(), all.end(), Index{0});
    Mend best;
    for (auto each = gains.begin(); each != promising; ++each) {
      const double misfit = misfitsWith(each->second, all).mean();
      if (misfit < best.misfit) best = {each->second, misfit};
    }
    return best;
  }

  /// The rows in which a gauge of the fault reads most, or the gauges beside it, as a gauge at fault may read
  /// most nowhere.
  std::vector<Index> rowsAt(const WiringFault& fault) const {
    const int count = drawing_.gauges();
    const auto isNear = [&](int gauge, int other) {
      const int away = std::abs(gauge - other);
      return std::min(away, count - away) <= 1;
    };
    std::vector<Index> rows;
    for (std::size_t row = 0; row < strongest_.size(); ++row)
      if (fault.kind == Kind::kAllSigns || isNear(strongest_[row], fault.gauge) ||
          (fault.kind == Kind::kSwapped && isNear(strongest_[row], fault.other)))
        rows.push_back(static_cast<Index>(row));
    return rows;
  }

  /// What is wrong with a gauge that is better left out.
  WiringFault described(int gauge) const {
    const int count = drawing_.gauges();
    const VectorXd own = readings_.col(gauge);
    for (const int other : {(gauge + 1) % count, (gauge + count - 1) % count}) {
      const VectorXd beside = readings_.col(other);
      if (own.norm() < kDeadShare * beside.norm()) return {Kind::kDead, gauge};
      if (own.dot(beside) > kSame * own.norm() * beside.norm()) return {Kind::kGlued, gauge, other};
    }
    return {Kind::kUnfit, gauge};
  }

  Drawing drawing_;
  int lastHarmonic_;
  std::vector<WiringFault> keeping_, leaving_;  ///< mends that are tried: with all gauges, without one
  MatrixXd readings_;                           ///< strong rows
  std::vector<int> strongest_;                  ///< of each row, the gauge that reads most
  std::vector<bool> isLeftOut_;
  double poissonDeviation_ = 0;
  std::optional<TouchSearch> search_;
  VectorXd misfits_;  ///< of each row, wired as found by now
};

/// Of each gauge, what it reads on average where nothing is known to touch the finger; 0 without such rows.
VectorXd untouchedMean_strain(std::span<const KnownTouch> known, const MatrixXd& readings) {
  VectorXd sum = VectorXd::Zero(readings.cols());
  double rows = 0;
  for (std::size_t row = 0; row < known.size(); ++row)
    if (known[row].isUntouched()) {
      sum += readings.row(static_cast<Index>(row)).transpose();
      ++rows;
    }
  return sum / std::max(rows, 1.0);
}

/// Of gauges that read what no touch does, those whose zeros alone may be why.
void tellZeros(std::vector<WiringFault>& faults, const config::FingerConfig& config,
               const VectorXd& zeros_strain) {
  for (WiringFault& fault : faults) {
    const double zero_strain = zeros_strain[fault.gauge];
    if (fault.kind == Kind::kUnfit && std::abs(zero_strain) > kFarZero * config.tolerance.zero_strain)
      fault = {.kind = Kind::kZeroOff, .gauge = fault.gauge, .zero_strain = zero_strain};
  }
}

/// Behind what a turn is: that it may be the mark. Empty where several directions agree.
std::string orTheMark(const WiringFault& fault) {
  if (fault.onlyMark == 0) return {};
  return fmt::format(
      "; or angle_deg of touch {}, the only one that is known, is wrong: another one would tell",
      fault.onlyMark);
}

}  // namespace

std::vector<int> untouchedGauges(const config::Gauges& gauges, const MatrixXd& readings) {
  std::vector<std::size_t> touches;
  for (const auto& rows : rowsOfGauges(gauges, readings))
    touches.push_back(static_cast<std::size_t>(std::count_if(rows.begin(), rows.end(), [&](const auto& row) {
      return row.first >= kWeakestTouch * gauges.noise_strain;
    })));
  const std::size_t count = touches.size();
  std::vector<int> untouched;
  for (std::size_t gauge = 0; gauge < count; ++gauge)
    if (touches[(gauge + count - 1) % count] + touches[gauge] + touches[(gauge + 1) % count] < kLeastNear)
      untouched.push_back(static_cast<int>(gauge));
  return untouched;
}

std::vector<WiringFault> findWiringFaults(const config::FingerConfig& config,
                                          std::span<const KnownTouch> known, const MatrixXd& readings,
                                          const KnownErrors& errors) {
  WiringCheck check(config, readings);
  std::vector<WiringFault> faults = check.run();
  tellZeros(faults, config, untouchedMean_strain(known, readings));
  if (faults.empty())
    if (const auto turn =
            findTurn(config, known, readings, errors, {check.strongRows(), check.poissonDeviation()}))
      faults.push_back(*turn);
  return faults;
}

bool isOfFinger(const WiringFault& fault) { return fault.kind != Kind::kTurnUnclear && fault.onlyMark == 0; }

std::string textOf(const WiringFault& fault) {
  switch (fault.kind) {
    case Kind::kSwapped:
      return fmt::format("gauges {} and {} are swapped: exchange their wires", fault.gauge, fault.other);
    case Kind::kSign:
      return fmt::format("gauge {} reads with the wrong sign: exchange the two ends of its bridge",
                         fault.gauge);
    case Kind::kAllSigns:
      return "all gauges read with the wrong sign: exchange the ends of the bridges' supply; or "
             "gauges.component is wrong, as radial and hoop strains have opposite signs";
    case Kind::kDead:
      return fmt::format("gauge {} is dead: look for an open wire or joint", fault.gauge);
    case Kind::kGlued:
      return fmt::format("gauge {} reads what gauge {} does: glued to it, or on the same wires", fault.gauge,
                         fault.other);
    case Kind::kUnfit:
      return fmt::format("gauge {} reads what no touch does: has it come loose?", fault.gauge);
    case Kind::kZeroOff:
      return fmt::format(
          "gauge {} reads {:.4g} microstrain where nothing touches the finger: its zero is off: tare, and "
          "touch the finger anew",
          fault.gauge, 1e6 * fault.zero_strain);
    case Kind::kShifted:
      return fmt::format(
          "the gauges are shifted: gauge 0 is where gauge {0} should be, and so on round the ring; connect "
          "the wire that is at input 0 to input {0}, and every other wire as many inputs further; or leave "
          "the "
          "wires and set gauges.first_angle_deg to where gauge {0} is drawn (for an uneven ring let the list "
          "gauges.angle_deg begin with that angle){1}",
          fault.other, orTheMark(fault));
    case Kind::kReversed:
      return fmt::format(
          "the gauges are connected in reverse order: gauge 0 is where gauge {0} should be, gauge 1 is one "
          "gauge before that, and so on; reverse the order of the wires; if the known angle_deg were counted "
          "clockwise seen from the tip, leave the wires and change the signs of angle_deg{1}",
          fault.other, orTheMark(fault));
    case Kind::kTurnUnclear:
      break;
  }
  return "the gauges are shifted or connected in reverse order, and the touches don't determine which: add a "
         "touch of known angle_deg that is neither at a gauge nor midway between two" +
         orTheMark(fault);
}

}  // namespace strainfinger::calibration
