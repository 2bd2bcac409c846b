#pragma once
// A finger as the elastic model has it, in double precision, and the tables made for it.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <random>
#include <vector>

#include "common/table_image.hpp"
#include "host/model/impulse_response.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger {

/// A line contact: position in pitches from gauge 0, loads in N/m.
struct Press {
  double position_pitch;
  double normal;
  double tangential;
};

/// Random contacts: uniform round the ring, load directions uniform within +-45 degrees.
class Presses {
 public:
  Presses(int gauges, double load, std::uint64_t seed) : gauges_(gauges), load_(load), random_(seed) {
    std::printf("seed %llu ", static_cast<unsigned long long>(seed));
  }
  Press next() {
    const double direction = (uniform_(random_) - 0.5) * std::numbers::pi / 2;
    return {uniform_(random_) * gauges_, load_ * std::cos(direction), load_ * std::sin(direction)};
  }
  double noise(double sigma) { return sigma * normal_(random_); }

 private:
  double gauges_;
  double load_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<> uniform_{0, 1};
  std::normal_distribution<> normal_;
};

class ModelRing {
 public:
  explicit ModelRing(const config::FingerConfig& config = {})
      : gauges_(config.gauges.count),
        outerRadius_m_(config.finger.outer_radius_m),
        noise_(config.gauges.noise_strain),
        response_({config.finger.core_radius_m, config.finger.outer_radius_m, config.finger.shear_modulus_pa,
                   config.finger.poisson_ratio},
                  config.gauges.radius_m, config.gauges.component, config.gauges.arc_length_m,
                  config.contact.width_m.value_or(0)),
        tables_(std::make_unique<TableImage>(tables::buildTableImage(config))) {}

  static config::FingerConfig configOf(int gauges, StrainComponent component = StrainComponent::kRadial) {
    config::FingerConfig config;
    config.gauges.count = gauges;
    config.gauges.component = component;
    return config;
  }

  const TableImage& tables() const { return *tables_; }
  const TableConstants& constants() const { return tables_->constants; }
  int gauges() const { return gauges_; }
  double noise_strain() const { return noise_; }
  double arc_um(double pitches) const { return pitches * pitch_rad() * outerRadius_m_ * 1e6; }
  double pitch_rad() const { return 2 * std::numbers::pi / gauges_; }

  model::ImpulseResponse::Value response(double pitches) const { return response_.at(pitches * pitch_rad()); }
  double peakPerLoad() const {
    double peak = 0;
    for (int step = 0; step < 1000; ++step)
      peak = std::max(peak, std::abs(response_.at(step * std::numbers::pi / 1000).normal));
    return peak;
  }

  std::vector<double> strains(const Press& press) const {
    std::vector<double> result;
    for (int gauge = 0; gauge < gauges_; ++gauge) {
      const auto value = response(gauge - press.position_pitch);
      result.push_back(press.normal * value.normal + press.tangential * value.tangential);
    }
    return result;
  }

  /// As conditioning would hand them on: rounded, within the locator's range.
  std::vector<std::int32_t> raw(const std::vector<double>& strains) const {
    const double limit = std::ldexp(1.0, 15 + constants().gate_shift) - 1;
    std::vector<std::int32_t> result;
    for (const double strain : strains)
      result.push_back(
          static_cast<std::int32_t>(std::llround(std::clamp(std::ldexp(strain, 32), -limit, limit))));
    return result;
  }
  std::vector<std::int32_t> raw(const Press& press) const { return raw(strains(press)); }

  /// The shorter way round from one position to another [pitches].
  double between(double from_pitch, double to_pitch) const {
    const double apart = to_pitch - from_pitch;
    return apart - gauges_ * std::round(apart / gauges_);
  }

 private:
  int gauges_;
  double outerRadius_m_;
  double noise_;
  model::ImpulseResponse response_;
  std::unique_ptr<TableImage> tables_;
};

}  // namespace strainfinger
