#include "host/calibration/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

#include "host/base/chi_squared.hpp"
#include "host/base/failure.hpp"
#include "host/calibration/complaints.hpp"
#include "host/calibration/joint_fit.hpp"
#include "host/calibration/known_units.hpp"
#include "host/calibration/model_error.hpp"
#include "host/calibration/noise_bias.hpp"
#include "host/calibration/row.hpp"
#include "host/model/pressure_profile.hpp"

namespace strainfinger::calibration {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

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

/// Refused are touches of which the readings contradict this many rows for each that they confirm. Where
/// columns are exchanged, or touches belong to other rows, nine in ten are contradicted; of honest marks and
/// weights with slips among them, fewer than half.
constexpr std::size_t kMostContradicted = 2;

enum class Loss { kRobust, kSquares };
enum class Search { kEverywhere, kNearby };

/// Rows, their touches and the finger, as they come nearer to each other.
class Calibration {
 public:
  Calibration(const config::FingerConfig& config, std::vector<Row> rows)
      : drawing_(config),
        lastHarmonic_(RingResponse::lastHarmonic(drawing_)),
        rows_(std::move(rows)),
        finger_(VectorXd::Zero(drawing_.unknowns())),
        modelError_{std::max(config.gauges.model_error, kLeastFirstError), 0} {
    chooseZeroOfAngle();
  }

  /// Domain: before run(), or within it.
  void requireEnough() const {
    std::vector<RowResult> results;
    for (const Row& row : rows_) {
      results.push_back(row.result);
      if (row.isMoved) results.back().use = RowUse::kUnexplained;
    }
    requireTouches(drawing_.config().gauges, results);
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
  /// Which rows, counted from 0.
  using Selection = std::vector<std::size_t>;

  /// What finds a touch of which nothing is known: made where the first row asks for it.
  struct WithoutKnowledge {
    RingResponse ring;
    TouchSearch search;
    TouchPrior prior;
  };

  /// Where angles count from, by the rows that are fitted.
  void chooseZeroOfAngle() {
    const config::FingerConfig config = drawing_.config();
    const bool isKnown = isAnyFitted(&Row::isDirectionKnown);
    drawing_ = Drawing(config, isKnown ? ZeroOfAngle::kKnown : ZeroOfAngle::kByConvention);
  }

  bool isAnyFitted(bool (Row::*which)() const) const {
    return std::any_of(rows_.begin(), rows_.end(),
                       [&](const Row& row) { return row.isFitted() && (row.*which)(); });
  }

  void fitUsable() {
    chooseZeroOfAngle();
    improve(usable(), Loss::kSquares);
  }

  template <typename Which>
  Selection select(Which which) const {
    Selection selected;
    for (std::size_t row = 0; row < rows_.size(); ++row)
      if (which(rows_[row])) selected.push_back(row);
    return selected;
  }

  Selection usable() const {
    return select([](const Row& row) { return row.isUsable(); });
  }

  /// Evenly some of them, and all of which something is known.
  Selection coarse(const Selection& rows) const {
    const std::size_t step = std::max<std::size_t>(1, rows.size() / kCoarseRows);
    Selection some;
    for (std::size_t i = 0; i < rows.size(); ++i)
      if (i % step == 0 || rows_[rows[i]].isKnown()) some.push_back(rows[i]);
    return some;
  }

  double shareUnexplained(const Selection& rows) const {
    const auto count = std::count_if(rows.begin(), rows.end(), [this](std::size_t row) {
      return rows_[row].isMoved || rows_[row].result.use == RowUse::kUnexplained;
    });
    return static_cast<double>(count) / static_cast<double>(rows.size());
  }

  void weigh(const Selection& rows) {
    for (const std::size_t row : rows)
      rows_[row].data.sigma_strain =
          std::hypot(drawing_.config().gauges.noise_strain, modelError_.value * rows_[row].peak_strain());
  }

  /// Fits the touches of these rows with the finger as it is known by now.
  void locate(const Selection& rows, Search search) {
    weigh(rows);
    const RingResponse ring(drawing_, finger_, lastHarmonic_);
    std::optional<TouchSearch> grid;
    if (search == Search::kEverywhere) grid.emplace(ring, drawing_.config());
    for (const std::size_t i : rows) {
      Row& row = rows_[i];
      const TouchFit found = refineTouches(ring, row.data, startsOf(row, ring.zeros(), grid));
      row.result.touch = found.touch;
      row.result.chiSquared = found.chiSquared;
      row.rivalGap = found.rivalGap;
      row.rival = found.rival;
    }
  }

  /// Where the touch was by now, and what the grid has or else its rival.
  static std::vector<TouchState> startsOf(const Row& row, const VectorXd& zeros,
                                          const std::optional<TouchSearch>& grid) {
    if (row.known.isUntouched()) return {row.result.touch};
    std::vector<TouchState> starts;
    if (grid) starts = grid->starts(row.data.readings - zeros, row.data.prior);
    if (row.result.touch[kNormalLoad] != 0) starts.push_back(row.result.touch);
    if (!grid && std::isfinite(row.rivalGap)) starts.push_back(row.rival);
    return starts;
  }

  /// One round: how well does the model explain the rows, what finger explains them best. Domain: located.
  void improve(const Selection& rows, Loss loss) {
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
    for (std::size_t i = 0; i < rows.size(); ++i) rows_[rows[i]].result.touch = fit.touches[i];
    estimateModelError(rows);
  }

  struct Joint {
    std::vector<TouchData> data;
    JointFit fit;
  };

  /// These rows and where they and the finger are by now.
  Joint joint(const Selection& rows) const {
    Joint joint{{}, {finger_, {}}};
    for (const std::size_t row : rows) {
      joint.data.push_back(rows_[row].data);
      joint.fit.touches.push_back(rows_[row].result.touch);
    }
    return joint;
  }

  /// Of a row: readings less the touch's unknowns and its share of the finger's.
  double degreesOfFreedom(const Selection& rows) const {
    const double each = static_cast<double>(drawing_.unknowns()) / static_cast<double>(rows.size());
    return std::max(1.0, drawing_.gauges() - kTouchUnknowns - each);
  }

  void keepResiduals(const Selection& rows) {
    const RingResponse ring(drawing_, finger_, lastHarmonic_);
    for (const std::size_t i : rows) {
      RowResult& result = rows_[i].result;
      result.residual_strain = rows_[i].data.readings - ring.readings(result.touch);
    }
  }

  void estimateModelError(const Selection& rows) {
    keepResiduals(rows);
    std::vector<Misfit> misfits;
    for (const std::size_t row : rows)
      misfits.push_back({rows_[row].result.residual_strain.squaredNorm(), rows_[row].peak_strain()});
    modelError_ = modelErrorOf(misfits, drawing_.config().gauges.noise_strain, degreesOfFreedom(rows));
  }

  /// Decides anew which rows no touch explains; whether any decision has changed.
  bool judge(const Selection& rows, Search search) {
    locate(rows, search);
    const double most = chiSquaredQuantile(drawing_.gauges() - kTouchUnknowns, kBeyondChance);
    bool changed = false;
    std::optional<WithoutKnowledge> free;
    for (const std::size_t i : rows) {
      Row& row = rows_[i];
      const RowUse now = row.result.chiSquared > most ? whyUnexplained(row, most, free)
                         : row.known.isUntouched()    ? RowUse::kUntouched
                         : row.rivalGap < kClearGap   ? RowUse::kAmbiguous
                         : isWide(row)                ? RowUse::kWide
                                                      : RowUse::kFitted;
      changed |= now != row.result.use;
      row.result.use = now;
    }
    return changed;
  }

  /// With what is known of it no touch explains the row; without that, one may.
  RowUse whyUnexplained(const Row& row, double mostChiSquared, std::optional<WithoutKnowledge>& free) const {
    if (row.known.isUntouched()) return RowUse::kContradicted;
    if (!row.isKnown()) return RowUse::kUnexplained;
    if (!free) {
      const RingResponse ring(drawing_, finger_, lastHarmonic_);
      free = {ring, {ring, drawing_.config()}, priorOfAny(drawing_.config())};
    }
    const TouchData data{row.data.readings, row.data.sigma_strain, free->prior};
    const double chiSquared = free->search.find(free->ring, data).chiSquared;
    return chiSquared > mostChiSquared ? RowUse::kUnexplained : RowUse::kContradicted;
  }

  /// Of the known directions, and of the known loads, the readings contradict fewer than half, or fewer than
  /// kMostContradicted for each that they bear out.
  void requireBorneOut() const {
    const auto require = [&](bool (Row::*isSaid)() const, const char* what, const char* lookAt) {
      std::vector<std::size_t> contradicted;
      std::size_t said = 0, borneOut = 0;
      for (std::size_t i = 0; i < rows_.size(); ++i) {
        const Row& row = rows_[i];
        if (row.known.isUntouched() || !(row.*isSaid)()) continue;
        if (row.result.use == RowUse::kContradicted) contradicted.push_back(i + 1);
        borneOut += row.result.use == RowUse::kFitted;
        ++said;
      }
      const bool isRefuted = contradicted.size() >= kMostContradicted * borneOut;
      if (!contradicted.empty() && 2 * contradicted.size() >= said && isRefuted)
        refuseContradicted(contradicted, borneOut, what, lookAt);
    };
    require(&Row::isDirectionKnown, "angle_deg",
            "the angles themselves, gauges.first_angle_deg, the order of the gauges and --angle-error-deg");
    require(&Row::isLoadKnown, "loads",
            "their unit, newtons per metre of the finger's length, the sign of tangential_n_per_m, which is "
            "positive counter-clockwise seen from the tip, finger.shear_modulus_pa and --load-error");
  }

  /// The fitted width is independent of the residuals, so that leaving out wide rows doesn't bias the fit.
  bool isWide(const Row& row) const {
    if (row.isKnown() || drawing_.config().contact.width_m) return false;
    const double pitch_rad = 2 * std::numbers::pi / drawing_.gauges();
    return row.result.touch[kMoment] > model::momentOf(model::Profile::kUniform, kMostWidth * pitch_rad);
  }

  CalibrationResult result(const Selection& rows) {
    weigh(rows);
    const auto [data, fit] = joint(rows);
    const MatrixXd covariance = covarianceOf(drawing_, lastHarmonic_, data, fit);
    moveTo(fit.deviations - noiseBias(drawing_, lastHarmonic_, data, fit, covariance), rows);
    std::vector<RowResult> results;
    for (const Row& row : rows_) results.push_back(row.result);
    CalibrationResult result(drawing_, finger_, covariance, std::move(results), modelError_,
                             isAnyFitted(&Row::isLoadKnown), movedZeros_, hasSettled_);
    requireTold(result);
    requireReadable(result);
    return result;
  }

  /// Another finger, and these rows' touches as it has them.
  void moveTo(const VectorXd& finger, const Selection& rows) {
    finger_ = finger;
    double& poisson = finger_[drawing_.at(kPoissonRatio)];
    poisson = std::min(poisson, drawing_.mostPoissonDeviation());
    const RingResponse ring(drawing_, finger_, lastHarmonic_);
    for (const std::size_t i : rows) {
      TouchState& touch = rows_[i].result.touch;
      touch = refineTouch(ring, rows_[i].data, touch).touch;
    }
    keepResiduals(rows);
    keepResiduals(refuted());
  }

  /// Rows that no touch explains, or none as it is known.
  Selection refuted() const {
    return select([](const Row& row) {
      return row.result.use == RowUse::kUnexplained || row.result.use == RowUse::kContradicted;
    });
  }

  /// Decides anew which zeros moved, whose rows are used no longer; whether any row has changed.
  bool findMovedZeros(const Selection& rows) {
    const RingResponse ring(drawing_, finger_, lastHarmonic_);
    std::vector<ZeroEvidence> evidence;
    for (const std::size_t i : rows) {
      const Row& row = rows_[i];
      if (std::isfinite(row.result.chiSquared))
        evidence.push_back(zeroEvidence(i + 1, ring, row.data, row.result.touch));
    }
    movedZeros_ = movedZeros(std::move(evidence), drawing_.config().gauges.noise_strain);
    std::vector<bool> isMoved(rows_.size());
    for (const MovedZero& moved : movedZeros_)
      for (std::size_t row = moved.firstRow - 1; row < moved.lastRow; ++row) isMoved[row] = true;
    bool changed = false;
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      changed |= isMoved[i] != rows_[i].isMoved;
      rows_[i].isMoved = isMoved[i];
    }
    requireStill(movedZeros_, shareUnexplained(rows));
    return changed;
  }

  /// That they were left out, of rows which touches beside the real ones explain.
  void tellMoved() {
    for (Row& row : rows_) {
      RowUse& use = row.result.use;
      if (row.isMoved && (use == RowUse::kFitted || use == RowUse::kUntouched)) use = RowUse::kUnexplained;
    }
  }

  Drawing drawing_;
  int lastHarmonic_;
  std::vector<Row> rows_;
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
  Calibration calibration(config, rowsOf(config, known, readings, errors));
  calibration.requireEnough();
  requireAllAround(config.gauges, untouchedGauges(config.gauges, readings));
  requireWiring(findWiringFaults(config, known, readings, errors));
  return calibration.run();
}

}  // namespace strainfinger::calibration
