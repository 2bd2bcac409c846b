#include "host/calibration/joint_fit.hpp"

#include <ceres/ceres.h>
#include <ceres/normal_prior.h>

#include <Eigen/Dense>
#include <cmath>
#include <memory>
#include <vector>

#include "host/base/failure.hpp"

namespace strainfinger::calibration {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Of holding Poisson's ratio and letting go of it: two are needed, as a rule.
constexpr int kMostTurns = 6;

/// The finger where the solver stands: computed once for all touches.
class FingerAtPoint : public ceres::EvaluationCallback {
 public:
  FingerAtPoint(const Drawing& drawing, int lastHarmonic, const VectorXd& deviations)
      : drawing_(drawing), lastHarmonic_(lastHarmonic), deviations_(deviations) {}
  void PrepareForEvaluation(bool, bool isNewPoint) override {
    if (isNewPoint || !ring_) ring_ = std::make_unique<RingResponse>(drawing_, deviations_, lastHarmonic_);
  }
  const RingResponse& ring() const { return *ring_; }

 private:
  const Drawing& drawing_;
  int lastHarmonic_;
  const VectorXd& deviations_;
  std::unique_ptr<RingResponse> ring_;
};

/// Residuals of one touch: its readings, then what is known of it. Parameters: the finger, the touch.
class TouchCost : public ceres::CostFunction {
 public:
  TouchCost(const FingerAtPoint& finger, const TouchData& data, Index fingerUnknowns)
      : finger_(finger), data_(data) {
    set_num_residuals(static_cast<int>(data.readings.size() + kTouchUnknowns));
    mutable_parameter_block_sizes()->assign({static_cast<int>(fingerUnknowns), kTouchUnknowns});
  }

  bool Evaluate(double const* const* parameters, double* residuals, double** jacobians) const override {
    const TouchState touch = Eigen::Map<const TouchState>(parameters[1]);
    const Index gauges = data_.readings.size();
    const double weight = 1 / data_.sigma_strain;
    const bool withSlopes = jacobians != nullptr;
    const auto model = finger_.ring().linearised(touch, withSlopes && jacobians[0] != nullptr);
    Eigen::Map<VectorXd> residual(residuals, num_residuals());
    residual.head(gauges) = weight * (data_.readings - model.readings);
    residual.tail<kTouchUnknowns>() = data_.prior.residuals(touch);
    if (withSlopes && jacobians[0] != nullptr) {
      Eigen::Map<RowMajor> slopes(jacobians[0], num_residuals(), model.toFinger.cols());
      slopes.topRows(gauges) = -weight * model.toFinger;
      slopes.bottomRows<kTouchUnknowns>().setZero();
    }
    if (withSlopes && jacobians[1] != nullptr) {
      Eigen::Map<Eigen::Matrix<double, Eigen::Dynamic, 4, Eigen::RowMajor>> slopes(jacobians[1],
                                                                                   num_residuals(), 4);
      slopes.topRows(gauges) = -weight * model.toTouch;
      slopes.bottomRows<kTouchUnknowns>() = (-data_.prior.weight).asDiagonal();
    }
    return residual.allFinite();
  }

 private:
  const FingerAtPoint& finger_;
  const TouchData& data_;
};

/// Cauchy's loss of a chi-squared beyond `scale`.
ceres::LossFunction* lossOf(double scale) {
  return scale > 0 ? new ceres::CauchyLoss(std::sqrt(scale)) : nullptr;
}

/// Poisson's ratio at most 1/2. Ceres shortens each step to the bound, but a step that would pass it moves
/// what goes along with the ratio, the core's radius above all, the wrong way: the fit stalls far from its
/// best. So where the ratio is at the bound and would pass it, it is held.
class PoissonBound {
 public:
  PoissonBound(const Drawing& drawing, ceres::Problem& problem, VectorXd& deviations)
      : problem_(problem),
        deviations_(deviations),
        ratio_(static_cast<int>(drawing.at(kPoissonRatio))),
        most_(drawing.mostPoissonDeviation()),
        held_(static_cast<int>(deviations.size()), {ratio_}) {
    problem.SetParameterUpperBound(deviations.data(), ratio_, most_);
  }

  void holdIfPressed() { hold(isPressed()); }

  /// Held where it is pressed against the bound, free elsewhere.
  bool isRespected() { return isPressed() == isHeld_; }

 private:
  void hold(bool isHeld) {
    isHeld_ = isHeld;
    problem_.SetManifold(deviations_.data(), isHeld ? &held_ : nullptr);
  }

  bool isPressed() {
    constexpr double kRounding = 1e-9;
    if (deviations_[ratio_] < most_ - kRounding) return false;
    const bool wasHeld = isHeld_;
    hold(false);  // a gradient with the ratio's part
    ceres::Problem::EvaluateOptions options;
    options.parameter_blocks = {deviations_.data()};
    std::vector<double> gradient;
    problem_.Evaluate(options, nullptr, nullptr, &gradient, nullptr);
    hold(wasHeld);
    return gradient[static_cast<std::size_t>(ratio_)] < 0;
  }

  ceres::Problem& problem_;
  VectorXd& deviations_;
  int ratio_;
  double most_;
  ceres::SubsetManifold held_;
  bool isHeld_ = false;
};

ceres::Solver::Options solverOptions(JointFit& fit, bool preliminary) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_SCHUR;
  options.max_num_iterations = 50;
  options.function_tolerance = preliminary ? 1e-3 : 1e-7;
  options.parameter_tolerance = 1e-10;
  options.logging_type = ceres::SILENT;
  auto ordering = std::make_shared<ceres::ParameterBlockOrdering>();
  for (TouchState& touch : fit.touches) ordering->AddElementToGroup(touch.data(), 0);
  ordering->AddElementToGroup(fit.deviations.data(), 1);
  options.linear_solver_ordering = ordering;
  return options;
}

}  // namespace

FitEnd fitTogether(const Drawing& drawing, int lastHarmonic, const std::vector<TouchData>& data,
                   double robust, JointFit& fit) {
  FingerAtPoint finger(drawing, lastHarmonic, fit.deviations);
  ceres::Problem::Options problemOptions;
  problemOptions.evaluation_callback = &finger;
  problemOptions.manifold_ownership = ceres::DO_NOT_TAKE_OWNERSHIP;
  ceres::Problem problem(problemOptions);
  const Index unknowns = drawing.unknowns();
  for (std::size_t i = 0; i < data.size(); ++i)
    problem.AddResidualBlock(new TouchCost(finger, data[i], unknowns), lossOf(robust), fit.deviations.data(),
                             fit.touches[i].data());
  problem.AddResidualBlock(new ceres::NormalPrior(drawing.priorRoot(), VectorXd::Zero(unknowns)), nullptr,
                           fit.deviations.data());
  PoissonBound bound(drawing, problem, fit.deviations);
  ceres::Solver::Summary summary;
  for (int turn = 0; turn < kMostTurns && (turn == 0 || !bound.isRespected()); ++turn) {
    bound.holdIfPressed();
    ceres::Solve(solverOptions(fit, robust > 0), &problem, &summary);
    if (!summary.IsSolutionUsable()) return FitEnd::kFailed;
  }
  return summary.termination_type == ceres::NO_CONVERGENCE ? FitEnd::kStopped : FitEnd::kSettled;
}

MatrixXd inverseOf(const MatrixXd& information) {
  const Eigen::LLT<MatrixXd> factor(information);
  if (factor.info() != Eigen::Success || !information.allFinite())
    throw Failure(ExitCode::kFailure,
                  "how certain the finger's values are cannot be computed: what the touches tell of them is "
                  "lost in rounding; leave out touches with loads or readings far from the others'");
  return factor.solve(MatrixXd::Identity(information.rows(), information.cols()));
}

MatrixXd covarianceOf(const Drawing& drawing, int lastHarmonic, const std::vector<TouchData>& data,
                      const JointFit& fit) {
  const RingResponse ring(drawing, fit.deviations, lastHarmonic);
  const MatrixXd prior = drawing.priorRoot();
  MatrixXd information = prior.transpose() * prior;
  for (std::size_t i = 0; i < data.size(); ++i)
    information += TouchEquations(ring, data[i], fit.touches[i], true).fingerInformation();
  return inverseOf(information);
}

}  // namespace strainfinger::calibration
