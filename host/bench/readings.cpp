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

}  // namespace

BenchFinger::BenchFinger()
    : config_(perfectFinger()),
      response_(config_.finger.annulus(), config_.gauges.radius_m, config_.gauges.component),
      model_(config_) {}

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

Eigen::Vector3d BenchFinger::bound(const Place<double>& place, double noise_strain) const {
  const evidence::FittedContact contact{place.position_pitch * pitch_rad(), {place.normal, place.tangential}};
  const evidence::Parameters bound =
      evidence::cramerRaoBound(model_, contact, evidence::kWidthKnown, noise_strain);
  return {bound[evidence::kAngle] / pitch_rad(), bound[evidence::kNormal], bound[evidence::kTangential]};
}

Reading readingOf(const BenchFinger& finger, std::uint64_t seed, std::uint64_t number, double relativeNoise) {
  const double noise_strain = relativeNoise * finger.peakPerLoad() * kBenchLoad_n_per_m;
  const simulation::Noise noise(seed);
  Reading reading{drawPlace(noise, number), {}, {}};
  reading.bound = finger.bound(reading.truth, noise_strain);
  for (std::uint32_t gauge = 0; gauge < kGauges; ++gauge) {
    const auto value = finger.response(gauge - reading.truth.position_pitch);
    const double strain = reading.truth.normal * value.normal + reading.truth.tangential * value.tangential +
                          noise_strain * noise.at(number, gauge);
    const StrainQ32 rounded = fromReal<StrainQ32>(strain);
    reading.sample.strain_q32[gauge] = rounded.raw();
    reading.sample.strain[gauge] = static_cast<float>(toReal(rounded));
  }
  return reading;
}

}  // namespace strainfinger::bench
