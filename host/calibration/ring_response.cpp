#include "host/calibration/ring_response.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "host/calibration/rubber_jet.hpp"
#include "host/model/harmonic.hpp"
#include "host/model/impulse_response.hpp"
#include "host/model/series.hpp"
#include "host/model/touch_load.hpp"

namespace strainfinger::calibration {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;
using std::numbers::pi;

constexpr double kTolerance = 1e-7;       ///< of the peak: three orders below the noise
constexpr double kDeepestDeviations = 4;  ///< tolerances that a gauge may be nearer the surface

/// One load's harmonic and its derivatives to the touch's unknowns.
using WithSlopes = Eigen::Matrix<double, 1, 1 + kTouchUnknowns>;

/// Harmonic n of pressure and shear.
struct LoadHarmonics {
  WithSlopes normal, tangential;
};

/// See model::trueSpectrum(): the shear is mu P (wide - stuck narrow) with wide, narrow the ellipse's factors
/// at the pressure's moment m and at stuck m, stuck = 1 - |Q| / (mu P).
LoadHarmonics loadHarmonics(const TouchState& touch, double friction, int n) {
  const double P = touch[kNormalLoad], Q = touch[kTangentialLoad], m = touch[kMoment];
  const auto factor = [n](double moment) { return spreadFactor(model::Profile::kEllipse, n, moment); };
  const model::SpreadFactor wide = factor(m);
  LoadHarmonics load;
  load.normal << P * wide.value, 0, wide.value, 0, P * wide.slope;
  const double stuck = 1 - model::frictionUsed({P, Q, m, model::Profile::kEllipse, friction});
  if (stuck <= 0) {
    load.tangential << Q * wide.value, 0, 0, wide.value, Q * wide.slope;
    return load;
  }
  const model::SpreadFactor narrow = factor(stuck * m);
  const double limit = std::copysign(friction, Q), slid = limit * P;
  const double perStuck = narrow.value + stuck * m * narrow.slope;  // of stuck * narrow
  const double shear = wide.value - stuck * narrow.value;
  load.tangential << slid * shear, 0, limit * (shear - (1 - stuck) * perStuck), perStuck,
      slid * (wide.slope - stuck * stuck * narrow.slope);
  return load;
}

/// What a wave of a unit line load's harmonic n makes of strain at a gauge.
struct GaugeHarmonic {
  RubberJet even, odd;
};

GaugeHarmonic gaugeHarmonic(const model::HarmonicModel<RubberJet>& rubber, StrainComponent component, int n,
                            double outerRadius_m) {
  const model::Row row = model::rowOf(component);
  const auto response = rubber(n);
  const double scale = (n == 0 ? 0.5 : 1) / (pi * outerRadius_m);
  const RubberJet normal = scale * response(row, model::kNormal);
  const RubberJet tangential = scale * response(row, model::kTangential);
  return model::isEvenInNormalLoad(row) ? GaugeHarmonic{-normal, tangential}
                                        : GaugeHarmonic{tangential, normal};
}

/// What is left of harmonic n when a gauge averages over its length.
RubberJet averaged(const RubberJet& radius_m, double gaugeArc_m, int n) {
  if (n == 0 || gaugeArc_m == 0) return 1;
  const RubberJet half_rad = n * gaugeArc_m / (2 * radius_m);
  return sin(half_rad) / half_rad;
}

/// Columns of one harmonic: cosine and sine of the even load's wave, cosine and sine of the odd one's.
constexpr Index kWaves = 4;

}  // namespace

TouchWaves::TouchWaves(const TouchState& touch, double friction, bool normalIsEven, int lastHarmonic)
    : columns(kWaves * (lastHarmonic + 1), 1 + kTouchUnknowns) {
  model::visitMultiples(touch[kPlace], lastHarmonic, [&](int n, double c, double s) {
    const LoadHarmonics load = loadHarmonics(touch, friction, n);
    const WithSlopes& even = normalIsEven ? load.normal : load.tangential;
    const WithSlopes& odd = normalIsEven ? load.tangential : load.normal;
    auto rows = columns.middleRows<kWaves>(kWaves * n);
    rows.row(0) = c * even;
    rows.row(1) = s * even;
    rows.row(2) = c * odd;
    rows.row(3) = s * odd;
    rows.col(1 + kPlace) << -n * rows(1, 0), n * rows(0, 0), -n * rows(3, 0), n * rows(2, 0);
  });
}

int RingResponse::lastHarmonic(const Drawing& drawing) {
  const config::FingerConfig& config = drawing.config();
  const double reach_m = kDeepestDeviations * drawing.tolerance(kDepthOffset);
  const double outermost_m =
      std::min(config.gauges.radius_m + reach_m, (config.gauges.radius_m + config.finger.outer_radius_m) / 2);
  return model::ImpulseResponse(config.finger.annulus(), outermost_m, config.gauges.component, 0, 0,
                                kTolerance)
      .harmonics();
}

RingResponse::RingResponse(const Drawing& drawing, const VectorXd& deviations, int lastHarmonic)
    : normalIsEven_(model::isEvenInNormalLoad(model::rowOf(drawing.config().gauges.component))),
      friction_(drawing.config().contact.friction_coefficient),
      lastHarmonic_(lastHarmonic),
      strains_(drawing.gauges(), kWaves * (lastHarmonic + 1)),
      toRadius_(strains_.rows(), strains_.cols()),
      toCore_(strains_.rows(), strains_.cols()),
      toPoisson_(strains_.rows(), strains_.cols()),
      gain_(drawing.gauges()),
      zero_(drawing.gauges()),
      compliance_(drawing.config().finger.shear_modulus_pa / drawing.annulus(deviations).shear_modulus_pa),
      gaugeTolerance_(drawing.tolerance(kGain), drawing.tolerance(kZero), drawing.tolerance(kAngleOffset),
                      drawing.tolerance(kDepthOffset)),
      modulusTolerance_(drawing.tolerance(kShearModulus)) {
  for (int gauge = 0; gauge < drawing.gauges(); ++gauge) fillGauge(drawing, deviations, gauge);
  toRadius_ *= -drawing.tolerance(kDepthOffset);  // deeper is nearer the core
  toCore_ *= drawing.tolerance(kCoreRadius);
  toPoisson_ *= drawing.tolerance(kPoissonRatio);
}

void RingResponse::fillGauge(const Drawing& drawing, const VectorXd& deviations, int gauge) {
  const config::FingerConfig& config = drawing.config();
  const model::PlacedGauge placed = drawing.gauge(deviations, gauge);
  gain_[gauge] = compliance_ * placed.gain;
  zero_[gauge] = drawing.zero_strain(deviations, gauge);
  const model::Annulus<double> built = drawing.annulus(deviations);
  const RubberJet radius_m(placed.radius_m, kToRadius);
  const model::HarmonicModel<RubberJet> rubber(
      {RubberJet(built.core_radius_m, kToCore), built.outer_radius_m, config.finger.shear_modulus_pa,
       RubberJet(built.poisson_ratio, kToPoisson)},
      radius_m);
  model::visitMultiples(placed.angle_rad, lastHarmonic_, [&](int n, double c, double s) {
    const GaugeHarmonic h = gaugeHarmonic(rubber, config.gauges.component, n, config.finger.outer_radius_m);
    const RubberJet mean = averaged(radius_m, config.gauges.arc_length_m, n);
    // cos n (gauge - touch) and sin n (gauge - touch), as sums of products
    const std::array waves{c * mean * h.even, s * mean * h.even, s * mean * h.odd, -c * mean * h.odd};
    for (Index i = 0; i < kWaves; ++i) {
      const RubberJet& wave = waves[static_cast<std::size_t>(i)];
      const Index column = kWaves * n + i;
      strains_(gauge, column) = wave.a;
      toRadius_(gauge, column) = wave.v[kToRadius];
      toCore_(gauge, column) = wave.v[kToCore];
      toPoisson_(gauge, column) = wave.v[kToPoisson];
    }
  });
}

VectorXd RingResponse::readings(const TouchState& touch) const {
  const VectorXd strain = strains_ * wavesOf(touch).columns.col(0);
  return gain_.cwiseProduct(strain) + zero_;
}

RingResponse::Linearised RingResponse::linearised(const TouchState& touch, bool withFinger) const {
  const TouchWaves waves = wavesOf(touch);
  const MatrixXd strains = strains_ * waves.columns;
  Linearised result;
  result.readings = gain_.cwiseProduct(strains.col(0)) + zero_;
  result.toTouch = gain_.asDiagonal() * strains.rightCols<kTouchUnknowns>();
  if (!withFinger) return result;
  result.toFinger = MatrixXd::Zero(gauges(), kGaugeUnknowns * gauges() + kRubberUnknowns);
  const VectorXd deeper = toRadius_ * waves.columns.col(0);
  for (int i = 0; i < gauges(); ++i) {
    auto own = result.toFinger.row(i).segment<kGaugeUnknowns>(Drawing::at(i, kGain));
    own << gaugeTolerance_[kGain] * compliance_ * strains(i, 0), gaugeTolerance_[kZero],
        -gaugeTolerance_[kAngleOffset] * result.toTouch(i, kPlace), gain_[i] * deeper[i];
  }
  auto rubber = result.toFinger.rightCols<kRubberUnknowns>();
  rubber.col(kCoreRadius) = gain_.cwiseProduct(toCore_ * waves.columns.col(0));
  rubber.col(kPoissonRatio) = gain_.cwiseProduct(toPoisson_ * waves.columns.col(0));
  rubber.col(kShearModulus) = -modulusTolerance_ * gain_.cwiseProduct(strains.col(0));
  return result;
}

RingResponse::Spread RingResponse::spread(double moment_rad2, double shearMoment_rad2) const {
  Spread spread{VectorXd(lastHarmonic_ + 1), VectorXd(lastHarmonic_ + 1)};
  for (int n = 0; n <= lastHarmonic_; ++n) {
    spread.pressure[n] = spreadFactor(model::Profile::kEllipse, n, moment_rad2).value;
    spread.shear[n] = spreadFactor(model::Profile::kEllipse, n, shearMoment_rad2).value;
  }
  return spread;
}

Eigen::MatrixX2d RingResponse::unitReadings(double place_rad, const Spread& spread) const {
  VectorXd normal = VectorXd::Zero(strains_.cols()), tangential = normal;
  model::visitMultiples(place_rad, lastHarmonic_, [&](int n, double c, double s) {
    const double pressure = spread.pressure[n], shear = spread.shear[n];
    const Index even = kWaves * n, odd = even + 2;
    normal.segment<2>(normalIsEven_ ? even : odd) << c * pressure, s * pressure;
    tangential.segment<2>(normalIsEven_ ? odd : even) << c * shear, s * shear;
  });
  Eigen::MatrixX2d unit(gauges(), 2);
  unit.col(0) = gain_.cwiseProduct(strains_ * normal);
  unit.col(1) = gain_.cwiseProduct(strains_ * tangential);
  return unit;
}

}  // namespace strainfinger::calibration
