#include "host/calibration/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

#include "host/base/angles.hpp"
#include "host/base/chi_squared.hpp"
#include "host/base/failure.hpp"
#include "host/calibration/complaints.hpp"
#include "host/calibration/joint_fit.hpp"
#include "host/calibration/known_units.hpp"
#include "host/calibration/model_error.hpp"
#include "host/calibration/noise_bias.hpp"
#include "host/calibration/touch_fit.hpp"
#include "host/config/over_range.hpp"
#include "host/model/pressure_profile.hpp"

namespace strainfinger::calibration {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

/// A touch whose largest reading is less than this part of what strong touches read tells nothing beside
/// them, as one below kWeakestTouch tells nothing beside noise.
constexpr double kWeakestOfStrong = 0.125, kStrong = 0.9;
/// Chi-squared by which a touch must explain a row better than any other.
constexpr double kClearGap = 16;
/// Of the ring's pitch: a slip, or two contacts that are near each other, reads like one touch of this width
/// and more, within noise; so wide touches have rivals half a pitch away besides. Measured (host/study):
/// where a tenth of the rows were slips and pairs, places came out up to 1.5 times as far off as without them
/// with 0.8, up to 1.2 times with 0.7.
constexpr double kMostWidth = 0.7;
/// The first, coarse fits take so many rows: enough to find the finger, few enough to be quick.
constexpr std::size_t kCoarseRows = 200;
/// A finger that nobody calibrated is off its drawing by as much, whatever its config says.
constexpr double kLeastFirstError = 0.02;
constexpr int kMostRounds = 4;
/// Widths are unknown, but not without end: the prior's standard deviation over the largest moment.
constexpr double kMomentSpread = 10;
/// Standard deviation of a known untouched finger's loads [N/m] and of a known width's moment [rad^2].
constexpr double kExactly = 1e-6;

/// Refused are touches of which the readings contradict this many rows for each that they confirm. Where
/// columns are exchanged, or touches belong to other rows, nine in ten are contradicted; of honest marks and
/// weights with slips among them, fewer than half.
constexpr std::size_t kMostContradicted = 2;

enum class Loss { kRobust, kSquares };
enum class Search { kEverywhere, kNearby };

/// Rows, their touches and the finger, as they come nearer to each other.
class Calibration {
 public:
  Calibration(const config::FingerConfig& config, std::span<const KnownTouch> known, const MatrixXd& readings,
              const KnownErrors& errors)
      : drawing_(config),
        lastHarmonic_(RingResponse::lastHarmonic(drawing_)),
        mostMoment_rad2_(model::momentOfWidth(config.contact.largest_width_m / config.finger.outer_radius_m)),
        rows_(static_cast<std::size_t>(readings.rows())),
        rivals_(rows_.size()),
        known_(known.begin(), known.end()),
        isMoved_(rows_.size()),
        finger_(VectorXd::Zero(drawing_.unknowns())),
        modelError_{std::max(config.gauges.model_error, kLeastFirstError), 0} {
    known_.resize(rows_.size());
    for (std::size_t row = 0; row < rows_.size(); ++row) {
      const KnownTouch& touch = known_[row];
      const VectorXd strains = readings.row(static_cast<Index>(row));
      rows_[row].use = useOf(strains, touch);
      strains.cwiseAbs().maxCoeff(&rows_[row].peakGauge);
      data_.push_back({strains, config.gauges.noise_strain, priorOf(touch, errors)});
    }
    leaveOutWeak();
    chooseZeroOfAngle();
  }

  /// Domain: before run(), or within it.
  void requireEnough() const {
    std::vector<RowResult> rows = rows_;
    for (std::size_t row = 0; row < rows.size(); ++row)
      if (isMoved_[row]) rows[row].use = RowUse::kUnexplained;
    requireTouches(drawing_.config().gauges, rows);
  }

  CalibrationResult run() {
    const auto all = usable();
    const auto some = coarse(all);
    for (int round = 0; round < 2; ++round) {
      locate(some, Search::kEverywhere);
      improve(some, Loss::kRobust);
    }
    if (some.size() < all.size()) {
      locate(all, Search::kEverywhere);
      improve(all, Loss::kRobust);
    }
    judge(all, Search::kEverywhere);
    findMovedZeros(all);
    requireExplained(modelError_.value, shareUnexplained(all));
    requireEnough();
    bool isAnother = true;
    for (int round = 0; isAnother && round < kMostRounds; ++round) {
      fitUsable();
      const bool isJudgedAnew = judge(all, Search::kNearby);
      isAnother = findMovedZeros(all) || isJudgedAnew;
    }
    if (isAnother) fitUsable();
    requireExplained(modelError_.value, shareUnexplained(all));
    requireEnough();
    tellMoved();
    requireBorneOut();
    return result(usable());
  }

 private:
  using Rows = std::vector<std::size_t>;

  /// A touch that explains a row second best, and by how much chi-squared.
  struct Rival {
    double gap = std::numeric_limits<double>::infinity();
    TouchState touch = TouchState::Zero();
  };

  /// What finds a touch of which nothing is known: made where the first row asks for it.
  struct WithoutKnowledge {
    RingResponse ring;
    TouchSearch search;
    TouchPrior prior;
  };

  /// Where angles count from, by the rows that are fitted.
  void chooseZeroOfAngle() {
    const config::FingerConfig config = drawing_.config();
    const bool isKnown = fittedRows([&](std::size_t row) { return isDirectionKnown(row); }) > 0;
    drawing_ = Drawing(config, isKnown ? ZeroOfAngle::kKnown : ZeroOfAngle::kByConvention);
  }

  void fitUsable() {
    chooseZeroOfAngle();
    improve(usable(), Loss::kSquares);
  }

  template <typename Which>
  std::size_t fittedRows(Which which) const {
    std::size_t count = 0;
    for (std::size_t row = 0; row < rows_.size(); ++row) count += isFitted(row) && which(row);
    return count;
  }

  bool isFitted(std::size_t row) const { return !isMoved_[row] && rows_[row].use == RowUse::kFitted; }
  bool isKnown(std::size_t row) const { return isDirectionKnown(row) || isLoadKnown(row); }
  bool isDirectionKnown(std::size_t row) const { return known_[row].angle_deg.has_value(); }
  bool isLoadKnown(std::size_t row) const {
    return known_[row].normal_n_per_m || known_[row].tangential_n_per_m;
  }

  RowUse useOf(const VectorXd& strains, const KnownTouch& touch) const {
    const config::Gauges& gauges = drawing_.config().gauges;
    const double largest = strains.cwiseAbs().maxCoeff();
    if (config::isOverRange(gauges, largest)) return RowUse::kOverRange;
    if (touch.isUntouched()) return RowUse::kUntouched;
    return largest < kWeakestTouch * gauges.noise_strain ? RowUse::kWeak : RowUse::kFitted;
  }

  void leaveOutWeak() {
    std::vector<double> peaks;
    for (const std::size_t row : usable()) peaks.push_back(peakOf(row));
    if (peaks.empty()) return;
    const auto strong =
        peaks.begin() + static_cast<std::ptrdiff_t>(kStrong * static_cast<double>(peaks.size()));
    std::nth_element(peaks.begin(), strong, peaks.end());
    for (std::size_t row = 0; row < rows_.size(); ++row)
      if (rows_[row].use == RowUse::kFitted && !isKnown(row) && peakOf(row) < kWeakestOfStrong * *strong)
        rows_[row].use = RowUse::kWeak;
  }

  TouchPrior priorOf(const KnownTouch& touch, const KnownErrors& errors) const {
    const config::Contact& contact = drawing_.config().contact;
    TouchPrior prior;
    const auto know = [&](TouchUnknown unknown, double value, double sigma) {
      prior.value[unknown] = value;
      prior.weight[unknown] = 1 / sigma;
    };
    know(kMoment, 0, kMomentSpread * mostMoment_rad2_);
    if (contact.width_m) {
      const double width_rad = *contact.width_m / drawing_.config().finger.outer_radius_m;
      know(kMoment, model::momentOf(model::Profile::kUniform, width_rad), kExactly);
    }
    if (touch.isUntouched()) {
      know(kPlace, 0, 1);
      know(kNormalLoad, 0, kExactly);
      know(kTangentialLoad, 0, kExactly);
      return prior;
    }
    const double load_n_per_m = touch.normal_n_per_m.value_or(touch.tangential_n_per_m.value_or(0));
    const double sigma_n_per_m = std::max(kExactly, errors.load * std::abs(load_n_per_m));
    if (touch.angle_deg)
      know(kPlace, *touch.angle_deg * kRadPerDeg, std::max(kExactly, errors.angle_deg * kRadPerDeg));
    if (touch.normal_n_per_m) know(kNormalLoad, *touch.normal_n_per_m, sigma_n_per_m);
    if (touch.tangential_n_per_m) know(kTangentialLoad, *touch.tangential_n_per_m, sigma_n_per_m);
    return prior;
  }

  bool isUsable(std::size_t row) const {
    const RowUse use = rows_[row].use;
    return !isMoved_[row] && (use == RowUse::kFitted || use == RowUse::kUntouched);
  }

  Rows usable() const {
    Rows rows;
    for (std::size_t row = 0; row < rows_.size(); ++row)
      if (isUsable(row)) rows.push_back(row);
    return rows;
  }

  /// Evenly some of them, and all of which something is known.
  Rows coarse(const Rows& rows) const {
    const std::size_t step = std::max<std::size_t>(1, rows.size() / kCoarseRows);
    Rows some;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (i % step == 0 || isKnown(rows[i])) some.push_back(rows[i]);
    return some;
  }

  double shareUnexplained(const Rows& rows) const {
    const auto count = std::count_if(rows.begin(), rows.end(), [this](std::size_t row) {
      return isMoved_[row] || rows_[row].use == RowUse::kUnexplained;
    });
    return static_cast<double>(count) / static_cast<double>(rows.size());
  }

  double peakOf(std::size_t row) const { return data_[row].readings.cwiseAbs().maxCoeff(); }

  void weigh(const Rows& rows) {
    for (const std::size_t row : rows)
      data_[row].sigma_strain =
          std::hypot(drawing_.config().gauges.noise_strain, modelError_.value * peakOf(row));
  }

  /// Fits the touches of these rows with the finger as it is known by now.
  void locate(const Rows& rows, Search search) {
    weigh(rows);
    const RingResponse ring(drawing_, finger_, lastHarmonic_);
    std::optional<TouchSearch> grid;
    if (search == Search::kEverywhere) grid.emplace(ring, drawing_.config());
    for (const std::size_t row : rows) {
      RowResult& result = rows_[row];
      std::vector<TouchState> starts{result.touch};
      if (!known_[row].isUntouched()) starts = startsOf(row, ring.zeros(), grid);
      const TouchFit found = refineTouches(ring, data_[row], starts);
      result.touch = found.touch;
      result.chiSquared = found.chiSquared;
      rivals_[row] = {found.rivalGap, found.rival};
    }
  }

  /// Where the touch was by now, and what the grid has or else its rival.
  std::vector<TouchState> startsOf(std::size_t row, const VectorXd& zeros,
                                   const std::optional<TouchSearch>& grid) const {
    std::vector<TouchState> starts;
    if (grid) starts = grid->starts(data_[row].readings - zeros, data_[row].prior);
    if (rows_[row].touch[kNormalLoad] != 0) starts.push_back(rows_[row].touch);
    if (!grid && std::isfinite(rivals_[row].gap)) starts.push_back(rivals_[row].touch);
    return starts;
  }

  /// One round: how well does the model explain the rows, what finger explains them best. Domain: located.
  void improve(const Rows& rows, Loss loss) {
    estimateModelError(rows);
    weigh(rows);
    auto [data, fit] = joint(rows);
    const double typical = degreesOfFreedom(rows);
    const FitEnd end = fitTogether(drawing_, lastHarmonic_, data, loss == Loss::kRobust ? typical : 0, fit);
    if (end == FitEnd::kFailed)
      throw Failure(
          ExitCode::kFailure,
          "no finger and touches could be fitted to the readings: the model has no finite answer "
          "there; look at the config's [finger] and [gauges], and for readings far from the others'");
    hasSettled_ = end == FitEnd::kSettled;
    finger_ = fit.deviations;
    for (std::size_t i = 0; i < rows.size(); ++i) rows_[rows[i]].touch = fit.touches[i];
    estimateModelError(rows);
  }

  struct Joint {
    std::vector<TouchData> data;
    JointFit fit;
  };

  /// These rows and where they and the finger are by now.
  Joint joint(const Rows& rows) const {
    Joint joint{{}, {finger_, {}}};
    for (const std::size_t row : rows) {
      joint.data.push_back(data_[row]);
      joint.fit.touches.push_back(rows_[row].touch);
    }
    return joint;
  }

  /// Of a row: readings less the touch's unknowns and its share of the finger's.
  double degreesOfFreedom(const Rows& rows) const {
    const double each = static_cast<double>(drawing_.unknowns()) / static_cast<double>(rows.size());
    return std::max(1.0, drawing_.gauges() - kTouchUnknowns - each);
  }

  void keepResiduals(const Rows& rows) {
    const RingResponse ring(drawing_, finger_, lastHarmonic_);
    for (const std::size_t row : rows)
      rows_[row].residual_strain = data_[row].readings - ring.readings(rows_[row].touch);
  }

  void estimateModelError(const Rows& rows) {
    keepResiduals(rows);
    std::vector<Misfit> misfits;
    for (const std::size_t row : rows)
      misfits.push_back({rows_[row].residual_strain.squaredNorm(), peakOf(row)});
    modelError_ = modelErrorOf(misfits, drawing_.config().gauges.noise_strain, degreesOfFreedom(rows));
  }

  /// Decides anew which rows no touch explains; whether any decision has changed.
  bool judge(const Rows& rows, Search search) {
    locate(rows, search);
    const double most = chiSquaredQuantile(drawing_.gauges() - kTouchUnknowns, kBeyondChance);
    bool changed = false;
    std::optional<WithoutKnowledge> free;
    for (const std::size_t row : rows) {
      RowUse& use = rows_[row].use;
      const RowUse now = rows_[row].chiSquared > most   ? whyUnexplained(row, most, free)
                         : known_[row].isUntouched()    ? RowUse::kUntouched
                         : rivals_[row].gap < kClearGap ? RowUse::kAmbiguous
                         : isWide(row)                  ? RowUse::kWide
                                                        : RowUse::kFitted;
      changed |= now != use;
      use = now;
    }
    return changed;
  }

  /// With what is known of it no touch explains the row; without that, one may.
  RowUse whyUnexplained(std::size_t row, double mostChiSquared, std::optional<WithoutKnowledge>& free) const {
    if (known_[row].isUntouched()) return RowUse::kContradicted;
    if (!isKnown(row)) return RowUse::kUnexplained;
    if (!free) {
      const RingResponse ring(drawing_, finger_, lastHarmonic_);
      free = {ring, {ring, drawing_.config()}, priorOf({}, {})};
    }
    const double chiSquared =
        free->search.find(free->ring, {data_[row].readings, data_[row].sigma_strain, free->prior}).chiSquared;
    return chiSquared > mostChiSquared ? RowUse::kUnexplained : RowUse::kContradicted;
  }

  /// Of the known directions, and of the known loads, the readings contradict fewer than half, or fewer than
  /// kMostContradicted for each that they bear out.
  void requireBorneOut() const {
    const auto require = [&](auto isSaid, const char* what, const char* lookAt) {
      Rows contradicted;
      std::size_t said = 0, borneOut = 0;
      for (std::size_t row = 0; row < rows_.size(); ++row) {
        if (known_[row].isUntouched() || !isSaid(row)) continue;
        if (rows_[row].use == RowUse::kContradicted) contradicted.push_back(row + 1);
        borneOut += rows_[row].use == RowUse::kFitted;
        ++said;
      }
      const bool isRefuted = contradicted.size() >= kMostContradicted * borneOut;
      if (!contradicted.empty() && 2 * contradicted.size() >= said && isRefuted)
        refuseContradicted(contradicted, borneOut, what, lookAt);
    };
    require([&](std::size_t row) { return isDirectionKnown(row); }, "angle_deg",
            "the angles themselves, gauges.first_angle_deg, the order of the gauges and --angle-error-deg");
    require([&](std::size_t row) { return isLoadKnown(row); }, "loads",
            "their unit, newtons per metre of the finger's length, the sign of tangential_n_per_m, which is "
            "positive counter-clockwise seen from the tip, finger.shear_modulus_pa and --load-error");
  }

  /// The fitted width is independent of the residuals, so that leaving out wide rows doesn't bias the fit.
  bool isWide(std::size_t row) const {
    if (isKnown(row) || drawing_.config().contact.width_m) return false;
    const double pitch_rad = 2 * std::numbers::pi / drawing_.gauges();
    return rows_[row].touch[kMoment] > model::momentOf(model::Profile::kUniform, kMostWidth * pitch_rad);
  }

  CalibrationResult result(const Rows& rows) {
    weigh(rows);
    const auto [data, fit] = joint(rows);
    const MatrixXd covariance = covarianceOf(drawing_, lastHarmonic_, data, fit);
    moveTo(fit.deviations - noiseBias(drawing_, lastHarmonic_, data, fit, covariance), rows);
    const bool isUnitKnown = fittedRows([&](std::size_t row) { return isLoadKnown(row); }) > 0;
    CalibrationResult result(drawing_, finger_, covariance, rows_, modelError_, isUnitKnown, movedZeros_,
                             hasSettled_);
    requireTold(result);
    requireReadable(result);
    return result;
  }

  /// Another finger, and these rows' touches as it has them.
  void moveTo(const VectorXd& finger, const Rows& rows) {
    finger_ = finger;
    double& poisson = finger_[drawing_.at(kPoissonRatio)];
    poisson = std::min(poisson, drawing_.mostPoissonDeviation());
    const RingResponse ring(drawing_, finger_, lastHarmonic_);
    for (const std::size_t row : rows)
      rows_[row].touch = refineTouch(ring, data_[row], rows_[row].touch).touch;
    keepResiduals(rows);
    keepResiduals(refuted());
  }

  /// Rows that no touch explains, or none as it is known.
  Rows refuted() const {
    Rows rows;
    for (std::size_t row = 0; row < rows_.size(); ++row)
      if (rows_[row].use == RowUse::kUnexplained || rows_[row].use == RowUse::kContradicted)
        rows.push_back(row);
    return rows;
  }

  /// Decides anew which zeros moved, whose rows are used no longer; whether any row has changed.
  bool findMovedZeros(const Rows& rows) {
    const RingResponse ring(drawing_, finger_, lastHarmonic_);
    std::vector<ZeroEvidence> evidence;
    for (const std::size_t row : rows)
      if (std::isfinite(rows_[row].chiSquared))
        evidence.push_back(zeroEvidence(row + 1, ring, data_[row], rows_[row].touch));
    movedZeros_ = movedZeros(std::move(evidence), drawing_.config().gauges.noise_strain);
    std::vector<bool> isMoved(rows_.size());
    for (const MovedZero& moved : movedZeros_)
      for (std::size_t row = moved.firstRow - 1; row < moved.lastRow; ++row) isMoved[row] = true;
    const bool changed = isMoved != isMoved_;
    isMoved_ = std::move(isMoved);
    requireStill(movedZeros_, shareUnexplained(rows));
    return changed;
  }

  /// That they were left out, of rows which touches beside the real ones explain.
  void tellMoved() {
    for (std::size_t row = 0; row < rows_.size(); ++row)
      if (isMoved_[row] && (rows_[row].use == RowUse::kFitted || rows_[row].use == RowUse::kUntouched))
        rows_[row].use = RowUse::kUnexplained;
  }

  Drawing drawing_;
  int lastHarmonic_;
  double mostMoment_rad2_;
  std::vector<RowResult> rows_;
  std::vector<Rival> rivals_;
  std::vector<TouchData> data_;
  std::vector<KnownTouch> known_;
  std::vector<bool> isMoved_;  ///< a row of a zero that moved
  std::vector<MovedZero> movedZeros_;
  VectorXd finger_;
  Estimate modelError_;
  bool hasSettled_ = true;  ///< the last fit
};

}  // namespace

CalibrationResult calibrate(const config::FingerConfig& config, std::span<const KnownTouch> known,
                            const MatrixXd& readings, const KnownErrors& errors) {
  requireRows(config.gauges, known, readings);
  requireWorking(findFailedGauges(config.gauges, readings));
  requireUnits(config, known, readings);
  Calibration calibration(config, known, readings, errors);
  calibration.requireEnough();
  requireAllAround(config.gauges, untouchedGauges(config.gauges, readings));
  requireWiring(findWiringFaults(config, known, readings, errors));
  return calibration.run();
}

}  // namespace strainfinger::calibration
