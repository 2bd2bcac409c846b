#include "host/calibration/calibrate.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <numbers>

#include "host/calibration/complaints.hpp"
#include "host/model/impulse_response.hpp"

namespace strainfinger::calibration {
namespace {

using Eigen::Index;
using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kDegree = std::numbers::pi / 180;

model::ImpulseResponse responseOf(const config::FingerConfig& config) {
  return {config.finger.annulus(), config.gauges.radius_m, config.gauges.component,
          config.gauges.arc_length_m, config.contact.width_m.value_or(0)};
}

/// What the model gives: a row a touch, a column a gauge.
MatrixXd expectedStrains(const model::ImpulseResponse& response, const config::Gauges& gauges,
                         std::span<const KnownTouch> touches) {
  MatrixXd strains(static_cast<Index>(touches.size()), gauges.count);
  for (Index row = 0; row < strains.rows(); ++row)
    for (Index gauge = 0; gauge < strains.cols(); ++gauge) {
      const KnownTouch& touch = touches[static_cast<std::size_t>(row)];
      const auto value = response.at(gauges.angle_rad(static_cast<int>(gauge)) - touch.angle_deg * kDegree);
      strains(row, gauge) = touch.normal_n_per_m * value.normal + touch.tangential_n_per_m * value.tangential;
    }
  return strains;
}

/// The load whose one touch tells a gain well enough, where it is felt most.
NeededTouch neededTouch(const model::ImpulseResponse& response, const config::Gauges& gauges) {
  constexpr int kSteps = 64;  // over a pitch on one side; the other mirrors it
  NeededTouch best{};
  double felt = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double offset_rad = 2 * std::numbers::pi / gauges.count * i / kSteps;
    const double normal = std::abs(response.at(offset_rad).normal);
    if (normal <= felt) continue;
    felt = normal;
    best = {offset_rad / kDegree, gauges.noise_strain / (kMostGainSigma * felt)};
  }
  return best;
}

/// y = gain * x + zero, or without zero.
class Line {
 public:
  Line(const VectorXd& x, const VectorXd& y, bool hasZero)
      : count_(static_cast<double>(x.size())), xMean_(hasZero ? x.mean() : 0), hasZero_(hasZero) {
    const double yMean = hasZero ? y.mean() : 0;
    const VectorXd dx = x.array() - xMean_, dy = y.array() - yMean;
    information_ = dx.squaredNorm();
    gain_ = information_ > 0 ? dx.dot(dy) / information_ : 0;
    zero_ = yMean - gain_ * xMean_;
    residuals_ = dy - gain_ * dx;
  }
  double unknowns() const { return hasZero_ ? 2 : 1; }
  double gainSigma(double noise) const { return noise / std::sqrt(information_); }
  const VectorXd& residuals() const { return residuals_; }
  GaugeCalibration result(double noise) const {
    const double left = count_ - unknowns();
    GaugeCalibration result{{gain_, gainSigma(noise)}, std::nullopt, 0};
    if (hasZero_)
      result.zero_strain = {zero_, noise * std::sqrt(1 / count_ + xMean_ * xMean_ / information_)};
    if (left > 0) result.residual_strain = residuals_.norm() / std::sqrt(left);
    return result;
  }

 private:
  double count_;
  double xMean_;
  bool hasZero_;
  double information_ = 0;
  double gain_ = 0;
  double zero_ = 0;
  VectorXd residuals_;
};

std::vector<Line> fitLines(const MatrixXd& expected, const MatrixXd& readings, bool hasZeros) {
  std::vector<Line> lines;
  for (Index gauge = 0; gauge < expected.cols(); ++gauge)
    lines.emplace_back(expected.col(gauge), readings.col(gauge), hasZeros);
  return lines;
}

MatrixXd residualsOf(const std::vector<Line>& lines, Index rows) {
  MatrixXd residuals(rows, static_cast<Index>(lines.size()));
  for (Index gauge = 0; gauge < residuals.cols(); ++gauge)
    residuals.col(gauge) = lines[static_cast<std::size_t>(gauge)].residuals();
  return residuals;
}

double excessOf(const MatrixXd& residuals, double unknowns, double noise_strain) {
  const double left = static_cast<double>(residuals.rows()) - unknowns;
  if (left <= 0) return 1;
  return residuals.norm() / std::sqrt(left * static_cast<double>(residuals.cols())) / noise_strain;
}

std::vector<int> undetermined(const std::vector<Line>& lines, double noise_strain) {
  std::vector<int> gauges;
  for (std::size_t i = 0; i < lines.size(); ++i)
    if (!(lines[i].gainSigma(noise_strain) <= kMostGainSigma)) gauges.push_back(static_cast<int>(i));
  return gauges;
}

}  // namespace

CalibrationFit calibrate(const config::FingerConfig& config, std::span<const KnownTouch> touches,
                         const MatrixXd& readings) {
  const config::Gauges& gauges = config.gauges;
  requireRows(gauges, touches, readings);
  const auto response = responseOf(config);
  const MatrixXd expected = expectedStrains(response, gauges, touches);
  const bool hasZeros = !std::all_of(touches.begin(), touches.end(), std::mem_fn(&KnownTouch::isTouch));
  const auto lines = fitLines(expected, readings, hasZeros);
  const auto unknown = undetermined(lines, gauges.noise_strain);
  if (!unknown.empty()) failUndetermined(gauges, unknown, neededTouch(response, gauges));
  const MatrixXd residuals = residualsOf(lines, readings.rows());
  CalibrationFit fit{{}, excessOf(residuals, lines.front().unknowns(), gauges.noise_strain)};
  requireExplained(expected, residuals, fit.excess);
  for (const Line& line : lines)
    fit.gauges.push_back(line.result(gauges.noise_strain * std::max(1.0, fit.excess)));
  requireGains(fit);
  return fit;
}

}  // namespace strainfinger::calibration
