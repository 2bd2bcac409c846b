#include "host/calibration/wiring.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <numbers>
#include <optional>

#include "host/base/angles.hpp"
#include "host/calibration/touch_fit.hpp"
#include "host/model/pressure_profile.hpp"

namespace strainfinger::calibration {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Kind = WiringFault::Kind;

/// Rows that are looked at, the strongest there are but for those over range.
constexpr std::size_t kMostRows = 64;
/// Of a row's energy: what no touch explains counts no more than this.
constexpr double kMostMisfit = 0.15;
/// Mean share of the energy that a drawn finger leaves of a glued one's rows; with less nothing is wrong.
constexpr double kHealthy = 0.003;
/// A mend that is right leaves less than this of the misfit: with all gauges, which a wrong mend makes worse;
/// without one that looks dead or glued to its neighbour; without one of which nothing else speaks, as a
/// healthy ring may have half of its misfit at one gauge. One that keeps a gauge is preferred unless it
/// leaves so much more than leaving it out.
constexpr double kImproved = 0.75, kImprovedWithout = 0.6, kImprovedMuch = 0.3, kNearly = 1.3;
/// Poisson's ratios that are tried, in tolerances below the drawing's: of all unknowns it changes the strains
/// of touches most.
constexpr double kPoissonDeviations[] = {0, -0.75, -1.5};
constexpr int kMostFaults = 4;
/// Of the reading of a healthy gauge beside it: less is dead. A correlation beyond kSame is its neighbour's.
constexpr double kDeadShare = 0.1, kSame = 0.8;
/// A direction that is known is found within so much of a pitch, uncalibrated; of a wide touch between two
/// gauges not always, so the ring as drawn has the benefit of the doubt up to nearly half of one.
constexpr double kTurnTolerance = 0.25, kDoubtfulTurn = 0.45;

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

class WiringCheck {
 public:
  WiringCheck(const config::FingerConfig& config, const MatrixXd& readings)
      : drawing_(config),
        lastHarmonic_(RingResponse::lastHarmonic(drawing_)),
        readings_(strongRows(readings)),
        isLeftOut_(static_cast<std::size_t>(drawing_.gauges()), false) {}

  std::vector<WiringFault> run() {
    std::vector<WiringFault> faults;
    double misfit = choosePoissonRatio();
    while (misfit > kHealthy && static_cast<int>(faults.size()) < kMostFaults) {
      const auto mend = bestMend(misfit);
      if (!mend) break;
      faults.push_back(mend->fault);
      readings_ = mended(readings_, mend->fault);
      misfit = mend->misfit;
    }
    return faults;
  }

  TouchSearch search() const { return {ring(isLeftOut_), friction(), mostMoment_rad2()}; }
  RingResponse ring() const { return ring(isLeftOut_); }

 private:
  struct Mend {
    WiringFault fault;
    double misfit = std::numeric_limits<double>::infinity();
  };

  double friction() const { return drawing_.config().contact.friction_coefficient; }
  double mostMoment_rad2() const {
    const config::FingerConfig& config = drawing_.config();
    return model::momentOfWidth(config.contact.largest_width_m / config.finger.outer_radius_m);
  }

  /// As drawn, gauges that are left out reading nothing.
  RingResponse ring(const std::vector<bool>& isLeftOut) const {
    VectorXd deviations = VectorXd::Zero(drawing_.unknowns());
    deviations[drawing_.at(kPoissonRatio)] = poissonDeviation_;
    for (int gauge = 0; gauge < drawing_.gauges(); ++gauge)
      if (isLeftOut[static_cast<std::size_t>(gauge)])
        deviations[Drawing::at(gauge, kGain)] = -1 / drawing_.tolerance(kGain);
    return {drawing_, deviations, lastHarmonic_};
  }

  MatrixXd strongRows(const MatrixXd& readings) const {
    std::vector<std::pair<double, Index>> rows;
    for (Index row = 0; row < readings.rows(); ++row) {
      const double peak = readings.row(row).cwiseAbs().maxCoeff();
      if (peak < drawing_.config().gauges.full_scale_strain) rows.emplace_back(peak, row);
    }
    std::sort(rows.rbegin(), rows.rend());
    rows.resize(std::min(rows.size(), kMostRows));
    MatrixXd strong(static_cast<Index>(rows.size()), readings.cols());
    for (std::size_t i = 0; i < rows.size(); ++i)
      strong.row(static_cast<Index>(i)) = readings.row(rows[i].second);
    return strong;
  }

  static double misfitOf(const MatrixXd& readings, const TouchSearch& search) {
    double sum = 0;
    for (Index row = 0; row < readings.rows(); ++row)
      sum += std::min(kMostMisfit, search.unexplainedShare(readings.row(row)));
    return sum / static_cast<double>(std::max<Index>(1, readings.rows()));
  }

  /// The one that explains the readings best, wired as they are; what it leaves.
  double choosePoissonRatio() {
    double least = std::numeric_limits<double>::infinity(), best = 0;
    for (const double deviation : kPoissonDeviations) {
      poissonDeviation_ = deviation;
      const double misfit = misfitOf(readings_, search());
      if (misfit >= least) continue;
      least = misfit;
      best = deviation;
    }
    poissonDeviation_ = best;
    return least;
  }

  /// The best there is, if it is good enough.
  std::optional<Mend> bestMend(double misfit) {
    const Mend kept = bestThatKeepsAll(), out = bestThatLeavesOneOut();
    if (kept.misfit <= kImproved * misfit && kept.misfit <= kNearly * out.misfit) return kept;
    const WiringFault fault = described(out.fault.gauge);
    const double most = fault.kind == Kind::kUnfit ? kImprovedMuch : kImprovedWithout;
    if (out.misfit > most * misfit) return std::nullopt;
    isLeftOut_[static_cast<std::size_t>(fault.gauge)] = true;
    return Mend{fault, out.misfit};
  }

  Mend bestThatKeepsAll() const {
    const TouchSearch search = this->search();
    Mend best;
    const auto consider = [&](const WiringFault& fault) {
      const double misfit = misfitOf(mended(readings_, fault), search);
      if (misfit < best.misfit) best = {fault, misfit};
    };
    consider({Kind::kAllSigns});
    for (int gauge = 0; gauge < drawing_.gauges(); ++gauge) {
      consider({Kind::kSign, gauge});
      for (int other = gauge + 1; other < drawing_.gauges(); ++other)
        consider({Kind::kSwapped, gauge, other});
    }
    return best;
  }

  Mend bestThatLeavesOneOut() const {
    Mend best;
    for (int gauge = 0; gauge < drawing_.gauges(); ++gauge) {
      std::vector<bool> isLeftOut = isLeftOut_;
      isLeftOut[static_cast<std::size_t>(gauge)] = true;
      const WiringFault fault{Kind::kUnfit, gauge};
      const double misfit =
          misfitOf(mended(readings_, fault), {ring(isLeftOut), friction(), mostMoment_rad2()});
      if (misfit < best.misfit) best = {fault, misfit};
    }
    return best;
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
  MatrixXd readings_;
  std::vector<bool> isLeftOut_;
  double poissonDeviation_ = 0;
};

/// A row of known direction: where it is, and where the drawn ring has it.
struct Direction {
  double known_rad, found_rad;
};

std::vector<Direction> directionsOf(const config::FingerConfig& config, std::span<const KnownTouch> known,
                                    const MatrixXd& readings) {
  std::vector<Direction> directions;
  const WiringCheck check(config, MatrixXd(0, readings.cols()));
  std::optional<TouchSearch> search;
  for (std::size_t row = 0; row < known.size(); ++row) {
    if (!known[row].angle_deg || known[row].isUntouched()) continue;
    if (!search) search.emplace(check.search());
    const VectorXd strains = readings.row(static_cast<Index>(row));
    const double sigma_strain = std::hypot(config.gauges.noise_strain, 0.05 * strains.cwiseAbs().maxCoeff());
    const TouchFit fit = search->find(check.ring(), {strains, sigma_strain, {}});
    if (std::isfinite(fit.chiSquared))
      directions.push_back({*known[row].angle_deg * kRadPerDeg, fit.touch[kPlace]});
  }
  return directions;
}

/// How the ring may lie: gauge i is where gauge shift + i, or shift - i, should be.
struct Turn {
  int shift;
  bool isReversed;
};

/// Whether the known directions are what such a ring would have them found as.
bool explains(const Turn& turn, const std::vector<Direction>& directions, const config::Gauges& gauges,
              double tolerance_rad) {
  const double pitch_rad = 2 * std::numbers::pi / gauges.count, first_rad = gauges.angle_rad(0);
  return std::all_of(directions.begin(), directions.end(), [&](const Direction& direction) {
    const double along = direction.found_rad - first_rad;
    const double real_rad = first_rad + turn.shift * pitch_rad + (turn.isReversed ? -along : along);
    return std::abs(std::remainder(real_rad - direction.known_rad, 2 * std::numbers::pi)) < tolerance_rad;
  });
}

std::optional<WiringFault> findTurn(const config::FingerConfig& config, std::span<const KnownTouch> known,
                                    const MatrixXd& readings, const KnownErrors& errors) {
  if (!config.gauges.isEven()) return std::nullopt;
  const auto directions = directionsOf(config, known, readings);
  const double pitch_rad = 2 * std::numbers::pi / config.gauges.count;
  const double known_rad = 3 * errors.angle_deg * kRadPerDeg;
  const double tolerance_rad = kTurnTolerance * pitch_rad + known_rad;
  if (directions.empty() ||
      explains({0, false}, directions, config.gauges, kDoubtfulTurn * pitch_rad + known_rad))
    return std::nullopt;
  std::vector<WiringFault> turns;
  for (int shift = 0; shift < config.gauges.count; ++shift)
    for (const bool isReversed : {false, true})
      if (explains({shift, isReversed}, directions, config.gauges, tolerance_rad))
        turns.push_back({isReversed ? Kind::kReversed : Kind::kShifted, 0, shift});
  if (turns.empty()) return std::nullopt;
  return turns.size() == 1 ? turns.front() : WiringFault{Kind::kTurnUnclear};
}

}  // namespace

std::vector<WiringFault> findWiringFaults(const config::FingerConfig& config,
                                          std::span<const KnownTouch> known, const MatrixXd& readings,
                                          const KnownErrors& errors) {
  std::vector<WiringFault> faults = WiringCheck(config, readings).run();
  if (faults.empty())
    if (const auto turn = findTurn(config, known, readings, errors)) faults.push_back(*turn);
  return faults;
}

std::string textOf(const WiringFault& fault) {
  switch (fault.kind) {
    case Kind::kSwapped:
      return fmt::format("gauges {} and {} are swapped: exchange their wires", fault.gauge, fault.other);
    case Kind::kSign:
      return fmt::format("gauge {} reads with the wrong sign: exchange the two ends of its bridge",
                         fault.gauge);
    case Kind::kAllSigns:
      return "all gauges read with the wrong sign: exchange the ends of the bridges' supply";
    case Kind::kDead:
      return fmt::format("gauge {} is dead: look for an open wire or joint", fault.gauge);
    case Kind::kGlued:
      return fmt::format("gauge {} reads what gauge {} does: glued to it, or on the same wires", fault.gauge,
                         fault.other);
    case Kind::kUnfit:
      return fmt::format("gauge {} reads what no touch does: has it come loose?", fault.gauge);
    case Kind::kShifted:
      return fmt::format(
          "the gauges are shifted: gauge 0 is where gauge {} should be; move the connector by so "
          "many, or set gauges.first_angle_deg",
          fault.other);
    case Kind::kReversed:
      return fmt::format(
          "the gauges are counted the wrong way round: gauge 0 is where gauge {0} should be, gauge 1 "
          "one before it; reverse the connector",
          fault.other);
    case Kind::kTurnUnclear:
      break;
  }
  return "the gauges are shifted or counted the wrong way round, and the known directions don't tell which: "
         "add "
         "another touch of known angle_deg, not opposite nor at a gauge";
}

}  // namespace strainfinger::calibration
