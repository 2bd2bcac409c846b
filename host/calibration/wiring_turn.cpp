#include "host/calibration/wiring_turn.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>
#include <vector>

#include "host/base/angles.hpp"
#include "host/base/chi_squared.hpp"
#include "host/calibration/joint_fit.hpp"
#include "host/calibration/model_error.hpp"
#include "host/calibration/touch_fit.hpp"
#include "host/config/over_range.hpp"

namespace strainfinger::calibration {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using Kind = WiringFault::Kind;

/// A touch of known direction is where the fitted ring sees it, give or take so many tolerances of a gauge's
/// angle, though the mean of all of them is nearer.
constexpr double kPlacedTolerances = 1;
/// Of the largest reading: what a ring leaves of strong rows when it is fitted to them for the first time;
/// what its covariance makes of another touch's readings, that the touch can't explain, at least.
constexpr double kFirstError = 0.005, kFittedError = 0.002;
/// Fits of a ring to its strong rows, each weighing them by what the one before left, until that changes by
/// no more than this part: by the first weights the drawing would count too much for an uneven ring to show
/// its shape.
constexpr int kMostFits = 8;
constexpr double kSettled = 0.02;
/// Chi-squared by which another turn must explain directions and shape better than the drawn one, and than
/// others.
constexpr double kClearly = 16;
/// Of the known directions, what a turn must explain: one of four may be wrong, of three none.
constexpr double kMostOfThem = 0.75;

/// A touch of which nothing is known but its readings.
TouchData touchData(const VectorXd& strains, double noise_strain, double error) {
  return {strains, std::hypot(noise_strain, error * strains.cwiseAbs().maxCoeff()), {}};
}

/// All ways a ring may lie that read alike where the ring is even; the drawn one first.
std::vector<WiringFault> turns(int gauges) {
  std::vector<WiringFault> all;
  for (int shift = 0; shift < gauges; ++shift)
    for (const Kind kind : {Kind::kShifted, Kind::kReversed}) all.push_back({kind, 0, shift});
  return all;
}

/// The even ring that is nearest to the drawn one, whose gauges may be as far off as those of that one are:
/// no turn of it is likelier than another. Of an uneven ring that is wired otherwise the drawing is a bad
/// start.
config::FingerConfig evened(config::FingerConfig config) {
  config::Gauges& gauges = config.gauges;
  const double pitch_deg = 360.0 / gauges.count;
  VectorXd off_deg(gauges.count);  // of the even ring that has gauge 0 where it is
  off_deg[0] = 0;
  for (int gauge = 1; gauge < gauges.count; ++gauge)
    off_deg[gauge] = off_deg[gauge - 1] + gauges.gap_deg(gauge - 1) - pitch_deg;
  const double mean_deg = off_deg.mean();
  gauges.first_angle_deg = gauges.angle_deg(0) + mean_deg;
  gauges.angles_deg.clear();
  const double spread_deg = (off_deg.array() - mean_deg).matrix().norm() / std::sqrt(gauges.count);
  config.tolerance.angle_deg = std::hypot(config.tolerance.angle_deg, spread_deg);
  return config;
}

/// A ring in the order and sense in which it is wired, as its readings alone tell it.
struct OwnRing {
  TouchSearch search;  ///< of the ring before it was fitted
  RingResponse ring;
  std::vector<double> angles_rad;
  double error;  ///< what it leaves of readings besides noise, of the largest
};

class OwnRingFit {
 public:
  OwnRingFit(const config::FingerConfig& config, double poissonDeviation)
      : drawing_(config),
        lastHarmonic_(RingResponse::lastHarmonic(drawing_)),
        fit_{VectorXd::Zero(drawing_.unknowns()), {}} {
    fit_.deviations[drawing_.at(kPoissonRatio)] = poissonDeviation;
  }

  OwnRing run(const MatrixXd& readings) {
    const TouchSearch search(ring(), drawing_.config());
    locate(readings, search);
    double error = improve();
    for (int round = 1; round < kMostFits; ++round) {
      const bool isAnyLeftOut = leaveOutUnexplained(error);
      weigh(error);
      const double before = std::exchange(error, improve());
      if (!isAnyLeftOut && std::abs(error - before) <= kSettled * before) break;
    }
    std::vector<double> angles_rad;
    for (int gauge = 0; gauge < drawing_.gauges(); ++gauge)
      angles_rad.push_back(drawing_.gauge(fit_.deviations, gauge).angle_rad);
    return {search, ring(), angles_rad, error};
  }

 private:
  RingResponse ring() const { return {drawing_, fit_.deviations, lastHarmonic_}; }
  double noise_strain() const { return drawing_.config().gauges.noise_strain; }
  double degreesOfFreedom() const { return drawing_.gauges() - kTouchUnknowns; }

  /// The rows, each where the ring of the search sees it.
  void locate(const MatrixXd& readings, const TouchSearch& search) {
    const RingResponse start = ring();
    for (Index row = 0; row < readings.rows(); ++row) {
      const TouchData data = touchData(readings.row(row), noise_strain(), kFirstError);
      const TouchFit found = search.find(start, data);
      if (found.touch[kNormalLoad] <= 0) continue;
      data_.push_back(data);
      fit_.touches.push_back(found.touch);
    }
  }

  /// What the ring leaves of readings then, besides noise.
  double improve() {
    // Where it fails the ring stays as it was, and what that leaves of readings tells against it.
    static_cast<void>(fitTogether(drawing_, lastHarmonic_, data_, degreesOfFreedom(), fit_));
    const RingResponse fitted = ring();
    std::vector<Misfit> misfits;
    for (std::size_t i = 0; i < data_.size(); ++i)
      misfits.push_back({(data_[i].readings - fitted.readings(fit_.touches[i])).squaredNorm(),
                         data_[i].readings.cwiseAbs().maxCoeff()});
    return misfits.empty() ? kFirstError : modelErrorOf(misfits, noise_strain(), degreesOfFreedom()).value;
  }

  /// A row of two contacts, a slip or another zero draws the ring, though it counts less: what the ring
  /// doesn't explain is no touch. Whether there were any.
  bool leaveOutUnexplained(double error) {
    const double most = chiSquaredQuantile(degreesOfFreedom(), kBeyondChance);
    const RingResponse fitted = ring();
    std::size_t kept = 0;
    for (std::size_t i = 0; i < data_.size(); ++i) {
      const VectorXd& strains = data_[i].readings;
      const double sigma_strain = touchData(strains, noise_strain(), error).sigma_strain;
      const VectorXd left = strains - fitted.readings(fit_.touches[i]);
      if (left.squaredNorm() > most * sigma_strain * sigma_strain) continue;
      data_[kept] = data_[i];
      fit_.touches[kept++] = fit_.touches[i];
    }
    const bool isAny = kept < data_.size();
    data_.resize(kept);
    fit_.touches.resize(kept);
    return isAny;
  }

  void weigh(double error) {
    for (TouchData& data : data_) data = touchData(data.readings, noise_strain(), error);
  }

  Drawing drawing_;
  int lastHarmonic_;
  std::vector<TouchData> data_;
  JointFit fit_;
};

/// How the drawn ring must be mirrored (sense -1) and turned to be the ring that is fitted in its own order;
/// and chi-squared of the gauges' places then.
struct Lie {
  int sense;
  double turn_rad, chiSquared;
};

Lie lieOf(const config::FingerConfig& config, const OwnRing& own, const WiringFault& turn) {
  const config::Gauges& gauges = config.gauges;
  const int sense = turn.kind == Kind::kReversed ? -1 : 1;
  VectorXd turns_rad(gauges.count);
  for (int gauge = 0; gauge < gauges.count; ++gauge) {
    const int place = (turn.other + sense * gauge + gauges.count) % gauges.count;
    turns_rad[gauge] = own.angles_rad[static_cast<std::size_t>(gauge)] - sense * gauges.angle_rad(place);
  }
  const double first_rad = turns_rad[0];
  const VectorXd beside_rad =
      turns_rad.unaryExpr([&](double angle_rad) { return shortWay_rad(angle_rad, first_rad); });
  const double mean_rad = beside_rad.mean(), sigma_rad = config.tolerance.angle_deg * kRadPerDeg;
  return {sense, first_rad + mean_rad,
          (beside_rad.array() - mean_rad).matrix().squaredNorm() / (sigma_rad * sigma_rad)};
}

/// Rows of known direction from which the turn of a ring is told: one that is well placed would do. Each is
/// located once for each of the turns, twice as many as there are gauges.
constexpr std::size_t kMostDirections = 8;

/// Where there are more rows of known direction than are needed: some of the stronger half of them, from all
/// the session.
std::vector<std::size_t> tellingRows(const config::Gauges& gauges, std::span<const KnownTouch> known,
                                     const MatrixXd& readings) {
  const VectorXd peaks = readings.cwiseAbs().rowwise().maxCoeff();
  std::vector<std::size_t> rows;
  for (std::size_t row = 0; row < known.size(); ++row) {
    const double peak = peaks[static_cast<Index>(row)];
    const bool isWithin = peak >= kWeakestTouch * gauges.noise_strain && !config::isOverRange(gauges, peak);
    if (known[row].angle_deg && isWithin) rows.push_back(row);
  }
  if (rows.size() <= kMostDirections) return rows;
  std::stable_sort(rows.begin(), rows.end(), [&](std::size_t a, std::size_t b) {
    return peaks[static_cast<Index>(a)] > peaks[static_cast<Index>(b)];
  });
  rows.resize(std::max(kMostDirections, rows.size() / 2));
  std::sort(rows.begin(), rows.end());
  std::vector<std::size_t> some;
  for (std::size_t i = 0; i < kMostDirections; ++i) some.push_back(rows[i * rows.size() / kMostDirections]);
  return some;
}

/// How well the shape of an uneven ring and rows of known direction are explained by rings that lie otherwise
/// than drawn: shifted or reversed.
class TurnCheck {
 public:
  TurnCheck(const config::FingerConfig& config, const OwnRing& own) : config_(config), own_(own) {}

  void know(std::size_t row, double angle_deg, double sigma_deg, const VectorXd& strains) {
    TouchData data = touchData(strains, config_.gauges.noise_strain, std::max(kFittedError, own_.error));
    data.prior.value[kPlace] = angle_deg * kRadPerDeg;
    data.prior.weight[kPlace] =
        1 / (std::hypot(sigma_deg, kPlacedTolerances * config_.tolerance.angle_deg) * kRadPerDeg);
    onlyMark_ = directions_.empty() ? static_cast<int>(row) + 1 : 0;
    directions_.push_back(data);
  }

  std::optional<WiringFault> run() const {
    std::vector<Told> all;
    for (const WiringFault& turn : turns(config_.gauges.count)) all.push_back(toldBy(turn));
    const Told drawn = all.front();
    const double leastOfShape = std::min_element(all.begin(), all.end(), hasBetterShape)->ofShape;
    std::erase_if(all, [&](const Told& each) { return each.ofShape > leastOfShape + kClearly; });
    const Told& best = *std::min_element(all.begin(), all.end(), isBetter);
    const bool isToldByShape = drawn.ofShape > leastOfShape + kClearly;
    const bool isToldByDirections = best.explained >= kMostOfThem * static_cast<double>(directions_.size()) &&
                                    best.chiSquared() + kClearly < drawn.chiSquared();
    if (!isToldByShape && !isToldByDirections) return std::nullopt;
    const auto rivals = std::count_if(all.begin(), all.end(), [&](const Told& each) {
      return each.chiSquared() < best.chiSquared() + kClearly;
    });
    WiringFault fault = rivals == 1 ? best.turn : WiringFault{Kind::kTurnUnclear};
    if (!isToldByShape) fault.onlyMark = onlyMark_;
    return fault;
  }

 private:
  /// What a turn makes of the ring's shape and of the known directions; the drawn ring is shifted by 0. What
  /// it doesn't explain counts no more than what chance makes.
  struct Told {
    WiringFault turn;
    double ofShape = 0, ofDirections = 0;
    int explained = 0;  ///< directions
    double chiSquared() const { return ofShape + ofDirections; }
  };

  static bool isBetter(const Told& a, const Told& b) { return a.chiSquared() < b.chiSquared(); }
  static bool hasBetterShape(const Told& a, const Told& b) { return a.ofShape < b.ofShape; }

  Told toldBy(const WiringFault& turn) const {
    const Lie lie = lieOf(config_, own_, turn);
    const double mostOfShape = chiSquaredQuantile(config_.gauges.count - 1, kBeyondChance);
    const double most =
        chiSquaredQuantile(config_.gauges.count + 1 - kTouchUnknowns, kBeyondChance);  // + 1: the direction
    Told told{turn, std::min(mostOfShape, lie.chiSquared)};
    for (TouchData direction : directions_) {
      double& place_rad = direction.prior.value[kPlace];
      place_rad = lie.turn_rad + lie.sense * place_rad;
      const double chiSquared = refineTouches(own_.ring, direction, startsOf(direction)).chiSquared;
      told.ofDirections += std::min(most, chiSquared);
      told.explained += chiSquared < most;
    }
    return told;
  }

  /// Those of the grid, which may be on the far side of another minimum, and where the touch is known to be.
  std::vector<TouchState> startsOf(const TouchData& seen) const {
    std::vector<TouchState> starts = own_.search.starts(seen.readings - own_.ring.zeros(), seen.prior);
    const std::size_t found = starts.size();
    for (std::size_t i = 0; i < found; ++i) {
      starts.push_back(starts[i]);
      starts.back()[kPlace] = seen.prior.value[kPlace];
    }
    return starts;
  }

  const config::FingerConfig& config_;
  const OwnRing& own_;
  std::vector<TouchData> directions_;
  int onlyMark_ = 0;  ///< as WiringFault::onlyMark
};

}  // namespace

std::optional<WiringFault> findTurn(const config::FingerConfig& config, std::span<const KnownTouch> known,
                                    const MatrixXd& readings, const KnownErrors& errors,
                                    const StrongRows& strong) {
  const std::vector<std::size_t> rows = tellingRows(config.gauges, known, readings);
  if (rows.empty() && config.gauges.isEven()) return std::nullopt;
  const OwnRing own = OwnRingFit(evened(config), strong.poissonDeviation).run(strong.readings);
  TurnCheck check(config, own);
  for (const std::size_t row : rows)
    check.know(row, *known[row].angle_deg, errors.angle_deg, readings.row(static_cast<Index>(row)));
  return check.run();
}

}  // namespace strainfinger::calibration
