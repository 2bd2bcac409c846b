#include "host/bench/readings.hpp"

#include <cmath>
#include <numbers>

#include "common/fixed_real.hpp"
#include "host/bench/fingers.hpp"
#include "host/evidence/bound.hpp"
#include "host/evidence/uniform.hpp"
#include "host/simulation/noise.hpp"

namespace strainfinger::bench {
namespace {

Place<double> drawPlace(const simulation::Noise& noise, std::uint64_t number) {
  const double position = (evidence::uniform(noise, number, kGauges) + 0.5) * kGauges;
  const double direction = evidence::uniform(noise, number, kGauges + 2) * std::numbers::pi / 2;
  return {position, kBenchLoad_n_per_m * std::cos(direction), kBenchLoad_n_per_m * std::sin(direction)};
}

simulation::Touch drawTouch(const simulation::Noise& noise, std::uint64_t number, const Place<double>& place,
                            const evidence::Range& width_m) {
  const double share = evidence::uniform(noise, number, kGauges + 4) + 0.5;
  return {.angle_rad = place.position_pitch * BenchFinger::pitch_rad(),
          .normal_n_per_m = place.normal,
          .tangential_n_per_m = place.tangential,
          .width_m = width_m.least + (width_m.most - width_m.least) * share};
}

}  // namespace

BenchFinger::BenchFinger()
    : config_(perfectFinger()),
      response_(config_.finger.annulus(), config_.gauges.radius_m, config_.gauges.component),
      model_(config_),
      strains_(config_) {}

double BenchFinger::pitch_rad() { return 2 * std::numbers::pi / kGauges; }

double BenchFinger::arc_um(double pitches) const {
  return pitches * pitch_rad() * config_.finger.outer_radius_m * 1e6;
}

double BenchFinger::peakPerLoad() const { return std::abs(response_.at(0).normal); }

model::ImpulseResponse::Value BenchFinger::response(double pitches) const {
  auto value = response_.at(pitches * pitch_rad());
  value.normalSlope *= pitch_rad();
  value.tangentialSlope *= pitch_rad();
  return value;
}

Eigen::VectorXd BenchFinger::readings(const simulation::Touch& touch) const {
  return strains_.readings({&touch, 1});
}

Eigen::Vector3d BenchFinger::bound(const simulation::Touch& touch, double noise_strain) const {
  const evidence::Unknowns& unknowns = touch.width_m > 0 ? evidence::kWidthUnknown : evidence::kWidthKnown;
  const evidence::Parameters bound =
      evidence::cramerRaoBound(model_, model_.describe(touch), unknowns, noise_strain);
  return {bound[evidence::kAngle] / pitch_rad(), bound[evidence::kNormal], bound[evidence::kTangential]};
}

Reading readingOf(const BenchFinger& finger, std::uint64_t seed, std::uint64_t number, double relativeNoise,
                  const evidence::Range& width_m) {
  const double noise_strain = relativeNoise * finger.peakPerLoad() * kBenchLoad_n_per_m;
  const simulation::Noise noise(seed);
  Reading reading{drawPlace(noise, number), {}, {}};
  const simulation::Touch touch = drawTouch(noise, number, reading.truth, width_m);
  reading.bound = finger.bound(touch, noise_strain);
  const Eigen::VectorXd exact = finger.readings(touch);
  for (std::uint32_t gauge = 0; gauge < kGauges; ++gauge) {
    const StrainQ32 rounded = fromReal<StrainQ32>(exact[gauge] + noise_strain * noise.at(number, gauge));
    reading.sample.strain_q32[gauge] = rounded.raw();
    reading.sample.strain[gauge] = static_cast<float>(toReal(rounded));
  }
  return reading;
}

}  // namespace strainfinger::bench
