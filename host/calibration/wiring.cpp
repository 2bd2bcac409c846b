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

/// Rows that are looked at, of those in which a gauge reads most: the strongest but for those over range.
constexpr std::size_t kRowsPerGauge = 6;
/// Of a row's energy: what no touch explains counts no more than this.
constexpr double kMostMisfit = 0.15;
/// Mean share of the energy that a drawn finger leaves of a glued one's rows; with less nothing is wrong.
constexpr double kHealthy = 0.001;
/// A mend that is right leaves less than this of the misfit: with all gauges, which a wrong mend makes worse;
/// without one that looks dead or glued to its neighbour; without one of which nothing else speaks, as a
/// healthy ring may have half of its misfit at one gauge. One that keeps a gauge is preferred unless it
/// leaves so much more than leaving out a gauge, or than leaving out that very one: without it, its share of
/// what the build of a glued finger leaves is gone too.
constexpr double kImproved = 0.75, kImprovedWithout = 0.6, kImprovedMuch = 0.3, kNearly = 1.3,
                 kNearlyThere = 3;
/// Poisson's ratios that are tried, in tolerances below the drawing's: of all unknowns it changes the strains
/// of touches most.
constexpr double kPoissonDeviations[] = {0, -0.75, -1.5};
constexpr int kMostFaults = 4;
/// Of the reading of a healthy gauge beside it: less is dead. A correlation beyond kSame is its neighbour's.
constexpr double kDeadShare = 0.1, kSame = 0.8;
/// A touch of known direction is where the drawn ring sees it, give or take so many tolerances of a gauge's
/// angle: 0.3 mm of a pitch of 5, as glued rings that nobody calibrated are off; and the drawn ring explains
/// its reading but for this part of the largest.
constexpr double kPlacedTolerances = 3, kFirstError = 0.05;
/// Chi-squared by which another turn must explain the directions better than the drawn one, and than others.
constexpr double kClearly = 16;

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

class WiringCheck {
 public:
  WiringCheck(const config::FingerConfig& config, const MatrixXd& readings)
      : drawing_(config),
        lastHarmonic_(RingResponse::lastHarmonic(drawing_)),
        readings_(strongRows(readings)),
        isLeftOut_(static_cast<std::size_t>(drawing_.gauges()), false) {}

  std::vector<WiringFault> run() {
    std::vector<WiringFault> faults = leaveOutDead();
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

  /// Of each gauge, the strongest rows in which none reads more: a fault shows where it is touched.
  MatrixXd strongRows(const MatrixXd& readings) const {
    std::vector<std::vector<std::pair<double, Index>>> ofGauge(static_cast<std::size_t>(readings.cols()));
    for (Index row = 0; row < readings.rows(); ++row) {
      Index gauge = 0;
      const double peak = readings.row(row).cwiseAbs().maxCoeff(&gauge);
      if (peak < drawing_.config().gauges.full_scale_strain)
        ofGauge[static_cast<std::size_t>(gauge)].emplace_back(peak, row);
    }
    std::vector<Index> strong;
    for (auto& rows : ofGauge) {
      std::sort(rows.rbegin(), rows.rend());
      rows.resize(std::min(rows.size(), kRowsPerGauge));
      for (const auto& [peak, row] : rows) strong.push_back(row);
    }
    return readings(strong, Eigen::all);
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
  std::optional<Mend> bestMend(double misfit) {
    const Mend kept = bestThatKeepsAll(), out = bestThatLeavesOneOut();
    const double nearly = concerns(kept.fault, out.fault.gauge) ? kNearlyThere : kNearly;
    if (kept.misfit <= kImproved * misfit && kept.misfit <= nearly * out.misfit) return kept;
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

/// How the ring may lie: gauge i is where gauge shift + i, or shift - i, should be.
struct Turn {
  int shift;
  bool isReversed;
};

/// How well rows of known direction are explained by rings that lie otherwise than drawn.
class TurnCheck {
 public:
  TurnCheck(const config::FingerConfig& config, std::span<const KnownTouch> known, const MatrixXd& readings,
            const KnownErrors& errors)
      : gauges_(config.gauges), wired_(config, MatrixXd(0, readings.cols())), ring_(wired_.ring()) {
    const double sigma_deg = std::hypot(errors.angle_deg, kPlacedTolerances * config.tolerance.angle_deg);
    for (std::size_t row = 0; row < known.size(); ++row) {
      if (!known[row].angle_deg || known[row].isUntouched()) continue;
      const VectorXd strains = readings.row(static_cast<Index>(row));
      TouchData data{
          strains, std::hypot(gauges_.noise_strain, kFirstError * strains.cwiseAbs().maxCoeff()), {}};
      data.prior.value[kPlace] = *known[row].angle_deg * kRadPerDeg;
      data.prior.weight[kPlace] = 1 / (sigma_deg * kRadPerDeg);
      directions_.push_back(data);
    }
    if (!directions_.empty()) search_.emplace(wired_.search());
  }

  std::optional<WiringFault> run() const {
    if (directions_.empty()) return std::nullopt;
    const double drawn = chiSquaredOf({0, false});
    double best = drawn;
    WiringFault fault{Kind::kTurnUnclear};
    std::vector<double> all;
    for (int shift = 0; shift < gauges_.count; ++shift)
      for (const bool isReversed : {false, true}) {
        all.push_back(chiSquaredOf({shift, isReversed}));
        if (all.back() >= best) continue;
        best = all.back();
        fault = {isReversed ? Kind::kReversed : Kind::kShifted, 0, shift};
      }
    if (!(best + kClearly < drawn)) return std::nullopt;
    const auto rivals =
        std::count_if(all.begin(), all.end(), [&](double each) { return each < best + kClearly; });
    return rivals == 1 ? fault : WiringFault{Kind::kTurnUnclear};
  }

 private:
  /// Of all directions, each where such a ring would see it.
  double chiSquaredOf(const Turn& turn) const {
    const double pitch_rad = 2 * std::numbers::pi / gauges_.count, first_rad = gauges_.angle_rad(0);
    double sum = 0;
    for (TouchData seen : directions_) {
      double& place_rad = seen.prior.value[kPlace];
      const double along_rad = place_rad - first_rad - turn.shift * pitch_rad;
      place_rad = first_rad + (turn.isReversed ? -along_rad : along_rad);
      sum += search_->find(ring_, seen).chiSquared;
    }
    return sum;
  }

  config::Gauges gauges_;
  WiringCheck wired_;
  RingResponse ring_;
  std::vector<TouchData> directions_;
  std::optional<TouchSearch> search_;
};

std::optional<WiringFault> findTurn(const config::FingerConfig& config, std::span<const KnownTouch> known,
                                    const MatrixXd& readings, const KnownErrors& errors) {
  if (!config.gauges.isEven()) return std::nullopt;
  return TurnCheck(config, known, readings, errors).run();
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
