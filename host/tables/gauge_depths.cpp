#include "host/tables/gauge_depths.hpp"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "common/fixed.hpp"
#include "host/model/impulse_response.hpp"
#include "host/model/pressure_profile.hpp"
#include "host/model/series.hpp"

namespace strainfinger::tables {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr double kTolerance = 1e-6;  ///< of the responses; gains are rounded to 3e-5

/// Angles over half a revolution at which responses are compared: twelve to a part of a shape.
constexpr Index kAnglesOfPart = 12, kAngles = kAnglesOfPart * (kDepthShapePoints - 1) + 1;

/// Responses and their slopes over the angle, at all angles under a load, then under the next one.
struct LoadedResponses {
  VectorXd normal, tangential;
  VectorXd normalSlope, tangentialSlope;

  VectorXd both() const {
    VectorXd both(normal.size() + tangential.size());
    both << normal, tangential;
    return both;
  }
};

/// Second moments of the loads that responses are compared under, of the largest: a line, and widths of a
/// quarter and a half of it; where the width is known, that one.
std::vector<double> comparedMoments(const config::Contact& contact) {
  return contact.width_m ? std::vector<double>{1} : std::vector<double>{0, 1.0 / 16, 1.0 / 4};
}

/// The elastic model of gauges at depths of their own.
class Depths {
 public:
  explicit Depths(const config::FingerConfig& config) : config_(config) {
    const model::ImpulseResponse response = responseAt(config.gauges.radius_m);
    const Index harmonics = response.even().size();
    order_ = VectorXd::LinSpaced(harmonics, 0, static_cast<double>(harmonics - 1));
    setWaves();
    const double largest_rad2 = largestMoment_m2(config) / std::pow(config.finger.outer_radius_m, 2);
    for (const double part : comparedMoments(config.contact))
      spread_.push_back(order_.unaryExpr([&](double n) {
        return model::spreadFactor(model::Profile::kEllipse, static_cast<int>(n), part * largest_rad2).value;
      }));
    drawn_ = samplesOf(response);
  }

  const LoadedResponses& drawn() const { return drawn_; }
  LoadedResponses at(double radius_m) const { return samplesOf(responseAt(radius_m)); }

 private:
  model::ImpulseResponse responseAt(double radius_m) const {
    return {config_.finger.annulus(),    radius_m, config_.gauges.component,
            config_.gauges.arc_length_m, 0,        kTolerance};
  }
  void setWaves() {
    cosines_.resize(kAngles, order_.size());
    sines_.resize(kAngles, order_.size());
    for (Index i = 0; i < kAngles; ++i)
      model::visitMultiples(static_cast<double>(i) * std::numbers::pi / (kAngles - 1),
                            static_cast<int>(order_.size()) - 1, [&](int n, double c, double s) {
                              cosines_(i, n) = c;
                              sines_(i, n) = s;
                            });
  }
  /// As many harmonics as the drawn gauge's; those that a deeper one doesn't have are 0.
  VectorXd harmonicsOf(const VectorXd& response) const {
    VectorXd harmonics = VectorXd::Zero(order_.size());
    const Index most = std::min(order_.size(), response.size());
    harmonics.head(most) = response.head(most);
    return harmonics;
  }
  LoadedResponses samplesOf(const model::ImpulseResponse& response) const {
    const VectorXd even = harmonicsOf(response.even()), odd = harmonicsOf(response.odd());
    const Index size = static_cast<Index>(spread_.size()) * kAngles;
    VectorXd evens(size), odds(size), evenSlopes(size), oddSlopes(size);
    for (std::size_t i = 0; i < spread_.size(); ++i) {
      const VectorXd spreadEven = even.cwiseProduct(spread_[i]), spreadOdd = odd.cwiseProduct(spread_[i]);
      const Index begin = static_cast<Index>(i) * kAngles;
      evens.segment(begin, kAngles) = cosines_ * spreadEven;
      odds.segment(begin, kAngles) = sines_ * spreadOdd;
      evenSlopes.segment(begin, kAngles) = -sines_ * order_.cwiseProduct(spreadEven);
      oddSlopes.segment(begin, kAngles) = cosines_ * order_.cwiseProduct(spreadOdd);
    }
    return response.isEvenInNormal() ? LoadedResponses{evens, odds, evenSlopes, oddSlopes}
                                     : LoadedResponses{odds, evens, oddSlopes, evenSlopes};
  }

  const config::FingerConfig& config_;
  VectorXd order_;
  MatrixXd cosines_, sines_;
  std::vector<VectorXd> spread_;  ///< factors of the harmonics, for each moment
  LoadedResponses drawn_;
};

/// What each point of a shape adds at the angles, under every load: straight lines from point to point.
MatrixXd shapeColumns(Index samples) {
  MatrixXd columns = MatrixXd::Zero(samples, kDepthShapePoints);
  for (Index row = 0; row < samples; ++row) {
    const Index angle = row % kAngles;
    const Index part = std::min<Index>(angle / kAnglesOfPart, kDepthShapePoints - 2);
    const double along = static_cast<double>(angle - part * kAnglesOfPart) / kAnglesOfPart;
    columns(row, part) = 1 - along;
    columns(row, part + 1) = along;
  }
  return columns;
}

VectorXd sampled(const DepthSlopes::Shape& shape, Index samples) {
  return shapeColumns(samples) * Eigen::Map<const VectorXd>(shape.data(), kDepthShapePoints);
}

/// What a metre of depth adds to the drawn responses, but for the factor.
VectorXd added(const LoadedResponses& drawn, const DepthSlopes& slopes) {
  const Index samples = drawn.normal.size();
  VectorXd both(2 * samples);
  both << slopes.normal_turn * drawn.tangentialSlope + sampled(slopes.normal_shape, samples),
      slopes.tangential * drawn.tangential + slopes.tangential_turn * drawn.normalSlope +
          sampled(slopes.tangential_shape, samples);
  return both;
}

/// Of the rubber's thickness above the gauges, over which the responses' change with depth is looked at.
constexpr double kDifference = 0.01;

DepthSlopes depthSlopes(const Depths& depths, const config::FingerConfig& config) {
  const double step_m = kDifference * (config.finger.outer_radius_m - config.gauges.radius_m);
  const double low_m = std::max(config.gauges.radius_m - step_m, config.finger.core_radius_m);
  const double high_m = config.gauges.radius_m + step_m;
  const LoadedResponses low = depths.at(low_m), high = depths.at(high_m);
  const LoadedResponses& drawn = depths.drawn();
  MatrixXd columns(drawn.normal.size(), 2 + kDepthShapePoints);
  const auto fitted = [&](const VectorXd& own, const VectorXd& turn, const VectorXd& change) {
    columns << own, turn, shapeColumns(own.size());
    return VectorXd(columns.colPivHouseholderQr().solve(change / (high_m - low_m)));
  };
  const VectorXd normal = fitted(drawn.normal, drawn.tangentialSlope, low.normal - high.normal);
  const VectorXd tangential = fitted(drawn.tangential, drawn.normalSlope, low.tangential - high.tangential);
  DepthSlopes slopes{.normal_turn = normal[1],
                     .tangential_turn = tangential[1],
                     .tangential = tangential[0] - normal[0],
                     .normal_shape = {},
                     .tangential_shape = {}};
  std::copy_n(normal.data() + 2, kDepthShapePoints, slopes.normal_shape.begin());
  std::copy_n(tangential.data() + 2, kDepthShapePoints, slopes.tangential_shape.begin());
  return slopes;
}

template <typename Values>
double largestOf(const Values& values) {
  double largest = 0;
  for (const double each : values) largest = std::max(largest, std::abs(each));
  return largest;
}

constexpr double kMostSteps = std::numeric_limits<std::int8_t>::max();

/// Units of the tables' slopes.
struct Units {
  double halfNode_rad, depth_m, strainPerStep;

  Units(const ResponseTable& responses, int step_nm)
      : halfNode_rad(std::numbers::pi / (2 * responses.nodes)),
        depth_m(std::ldexp(step_nm, GaugeDepths::kStepsBits) * 1e-9),
        strainPerStep(std::ldexp(responses.strainPerUnit, -15)) {}
};

template <typename Integer>
Integer fixed(double value, int bits) {
  return saturate<Integer>(std::llround(std::ldexp(value, bits)));
}

/// The smallest that makes the largest value fit 8 bits.
int shapeShift(double largest) {
  int shift = 0;
  while (std::ldexp(largest, -shift) > std::numeric_limits<std::int8_t>::max() &&
         shift < kMostDepthShapeShift)
    ++shift;
  return shift;
}

/// The slopes that a table has.
DepthSlopes slopesOf(const GaugeDepths& depths, const Units& units) {
  DepthSlopes slopes;
  slopes.normal_turn =
      std::ldexp(depths.normal_turn_q11, -GaugeDepths::kTurnBits) * units.halfNode_rad / units.depth_m;
  slopes.tangential_turn =
      std::ldexp(depths.tangential_turn_q11, -GaugeDepths::kTurnBits) * units.halfNode_rad / units.depth_m;
  slopes.tangential = std::ldexp(depths.tangential_q15, -GaugeDepths::kFactorBits) / units.depth_m;
  for (std::size_t i = 0; i < kDepthShapePoints; ++i) {
    const double unit = std::ldexp(units.strainPerStep, depths.shape_shift) / units.depth_m;
    slopes.normal_shape[i] = depths.normal_shape[i] * unit;
    slopes.tangential_shape[i] = depths.tangential_shape[i] * unit;
  }
  return slopes;
}

}  // namespace

DepthFit depthFit(const config::FingerConfig& config) {
  DepthFit fit;
  fit.gain.assign(static_cast<std::size_t>(config.gauges.count), 1);
  if (config.calibration.depth_offset_m.empty()) return fit;
  const Depths depths(config);
  fit.slopes = depthSlopes(depths, config);
  MatrixXd columns(2 * depths.drawn().normal.size(), 2);
  columns << depths.drawn().both(), added(depths.drawn(), fit.slopes);
  const auto solver = columns.colPivHouseholderQr();
  for (std::size_t i = 0; i < fit.gain.size(); ++i) {
    const Eigen::Vector2d parts =
        solver.solve(depths.at(config.calibrated(static_cast<int>(i)).radius_m).both());
    fit.gain[i] = parts[0];
    fit.depth_m.push_back(parts[1] / parts[0]);
  }
  fit.growth = largestOf(fit.depth_m) * largestOf(columns.col(1)) / largestOf(columns.col(0));
  return fit;
}

GaugeDepths gaugeDepths(const DepthFit& fit, const ResponseTable& responses) {
  GaugeDepths depths{};
  const double largest_nm = 1e9 * largestOf(fit.depth_m);
  if (largest_nm < 0.5) return depths;
  depths.step_nm = saturate<std::uint16_t>(std::llround(std::ceil(largest_nm / kMostSteps)));
  std::transform(fit.depth_m.begin(), fit.depth_m.end(), depths.steps.begin(), [&](double each_m) {
    return saturate<std::int8_t>(std::llround(1e9 * each_m / depths.step_nm));
  });
  const Units units(responses, depths.step_nm);
  const DepthSlopes& slopes = fit.slopes;
  const double turn = units.depth_m / units.halfNode_rad, shape = units.depth_m / units.strainPerStep;
  depths.normal_turn_q11 = fixed<std::int16_t>(slopes.normal_turn * turn, GaugeDepths::kTurnBits);
  depths.tangential_turn_q11 = fixed<std::int16_t>(slopes.tangential_turn * turn, GaugeDepths::kTurnBits);
  depths.tangential_q15 = fixed<std::int16_t>(slopes.tangential * units.depth_m, GaugeDepths::kFactorBits);
  const int shift =
      shapeShift(shape * std::max(largestOf(slopes.normal_shape), largestOf(slopes.tangential_shape)));
  depths.shape_shift = static_cast<std::uint8_t>(shift);
  for (std::size_t i = 0; i < kDepthShapePoints; ++i) {
    depths.normal_shape[i] = fixed<std::int8_t>(slopes.normal_shape[i] * shape, -shift);
    depths.tangential_shape[i] = fixed<std::int8_t>(slopes.tangential_shape[i] * shape, -shift);
  }
  return depths;
}

double depthError(const config::FingerConfig& config, const DepthFit& fit, const GaugeDepths& tabled,
                  const ResponseTable& responses) {
  if (!tabled.areKnown()) return 0;
  const Depths depths(config);
  const VectorXd drawn = depths.drawn().both();
  const VectorXd slopes = added(depths.drawn(), slopesOf(tabled, Units(responses, tabled.step_nm)));
  double squares = 0;
  for (std::size_t i = 0; i < fit.gain.size(); ++i) {
    const VectorXd actual = depths.at(config.calibrated(static_cast<int>(i)).radius_m).both() / fit.gain[i];
    const double depth_m = tabled.steps[i] * tabled.step_nm * 1e-9;
    squares += std::pow(largestOf(VectorXd(actual - drawn - depth_m * slopes)), 2);
  }
  return std::sqrt(squares / static_cast<double>(fit.gain.size())) / largestOf(depths.drawn().normal);
}

}  // namespace strainfinger::tables
