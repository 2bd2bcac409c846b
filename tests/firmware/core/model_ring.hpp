#pragma once
// A finger as the elastic model has it, in double precision, and the tables made for it.

#include <Eigen/Core>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <initializer_list>
#include <memory>
#include <numbers>
#include <random>
#include <span>
#include <vector>

#include "common/table_image.hpp"
#include "firmware/core/hypothesis.hpp"
#include "host/evidence/bound.hpp"
#include "host/evidence/fit_model.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger {

/// A contact: position in pitches from gauge 0, loads in N/m, width of the uniform pressure that has the same
/// second moment.
struct Press {
  double position_pitch;
  double normal;
  double tangential;
  double width_mm = 0;
};

constexpr double momentOf_mm2(double width_mm) { return width_mm * width_mm / 12; }
inline double widthOf_mm(double moment_mm2) { return std::sqrt(12 * std::max(moment_mm2, 0.0)); }

/// Random contacts: uniform round the ring, load directions uniform within +-45 degrees, widths uniform.
class Presses {
 public:
  Presses(int gauges, double load, std::uint64_t seed, double leastWidth_mm = 0, double mostWidth_mm = 0)
      : gauges_(gauges), load_(load), random_(seed), width_mm_(leastWidth_mm, mostWidth_mm) {
    std::printf("seed %llu ", static_cast<unsigned long long>(seed));
  }
  Press next() {
    const double direction = (uniform_(random_) - 0.5) * std::numbers::pi / 2;
    const double position = uniform_(random_) * gauges_;
    return {position, load_ * std::cos(direction), load_ * std::sin(direction), width_mm_(random_)};
  }
  double noise(double sigma) { return sigma * normal_(random_); }
  std::vector<double> noisy(std::vector<double> strains, double sigma) {
    for (double& strain : strains) strain += noise(sigma);
    return strains;
  }

 private:
  double gauges_;
  double load_;
  std::mt19937_64 random_;
  std::uniform_real_distribution<> uniform_{0, 1};
  std::uniform_real_distribution<> width_mm_;
  std::normal_distribution<> normal_;
};

class ModelRing {
 public:
  explicit ModelRing(const config::FingerConfig& config = {})
      : config_(config),
        model_(config),
        tables_(std::make_unique<TableImage>(tables::buildTableImage(config))) {}

  static config::FingerConfig configOf(int gauges, StrainComponent component = StrainComponent::kRadial) {
    config::FingerConfig config;
    config.gauges.count = gauges;
    config.gauges.component = component;
    return config;
  }
  /// A finger that is as drawn: nothing but noise is between it and the model.
  static config::FingerConfig asDrawn(int gauges = 16, StrainComponent component = StrainComponent::kRadial) {
    config::FingerConfig config = configOf(gauges, component);
    config.gauges.model_error = 0;
    return config;
  }
  /// The same, touched by contacts of one width.
  static config::FingerConfig ofKnownWidth(double width_mm) {
    config::FingerConfig config = asDrawn();
    config.contact.width_m = width_mm * 1e-3;
    return config;
  }

  const TableImage& tables() const { return *tables_; }
  const TableConstants& constants() const { return tables_->constants; }
  int gauges() const { return config_.gauges.count; }
  firmware::GaugeSet allGauges() const { return firmware::allGauges(gauges()); }
  double noise_strain() const { return config_.gauges.noise_strain; }
  double arc_um(double pitches) const { return pitches * pitch_rad() * config_.finger.outer_radius_m * 1e6; }
  double pitch_rad() const { return 2 * std::numbers::pi / gauges(); }

  std::vector<double> strains(std::span<const Press> presses) const {
    const Eigen::VectorXd readings = model_.readings(contactsOf(presses));
    return {readings.begin(), readings.end()};
  }
  std::vector<double> strains(std::initializer_list<Press> presses) const {
    return strains(std::span(presses.begin(), presses.size()));
  }
  std::vector<double> strains(const Press& press) const { return strains({press}); }

  /// Of another finger as built with each call: gauges are off their places and gains by these standard
  /// deviations, 0.6 degrees and 4 %.
  std::vector<double> strainsAsBuilt(const Press& press, Presses& draws) const {
    constexpr double kOff_pitch = 0.6 / 22.5, kGain = 0.04;
    std::vector<double> built;
    for (int gauge = 0; gauge < gauges(); ++gauge) {
      Press seen = press;
      seen.position_pitch += draws.noise(kOff_pitch);
      built.push_back(strains(seen)[static_cast<std::size_t>(gauge)] * (1 + draws.noise(kGain)));
    }
    return built;
  }

  /// Derivatives of the strains to position [pitch], normal and tangential load [N/m], second moment [mm^2].
  Eigen::MatrixX4d slopes(const Press& press) const {
    return model_.slopes(contactOf(press)) * unitsOfModel().asDiagonal();
  }
  /// The Cramer-Rao bound of each press, all found together, in the same units.
  std::vector<Eigen::Vector4d> bounds(std::span<const Press> presses, bool isWidthFree = true,
                                      std::span<const int> leftOut = {}) const {
    const auto& unknowns = isWidthFree ? evidence::kWidthUnknown : evidence::kWidthKnown;
    auto bounds = evidence::cramerRaoBound(model_, contactsOf(presses), unknowns, noise_strain(), leftOut);
    for (Eigen::Vector4d& bound : bounds) bound = bound.cwiseQuotient(unitsOfModel());
    return bounds;
  }
  Eigen::Vector4d bound(const Press& press, bool isWidthFree = true) const {
    return bounds({&press, 1}, isWidthFree).front();
  }

  /// By how much each of these readings may be off: noise, and a model error of a part of the reading, an
  /// eighth of that of each neighbour's, a sixteenth of that of the largest.
  Eigen::VectorXd deviations(const std::vector<double>& strains) const {
    const double error = config_.gauges.model_error;
    const auto size = [&](int gauge) { return std::abs(strains[static_cast<std::size_t>(gauge)]); };
    double largest = 0;
    for (int i = 0; i < gauges(); ++i) largest = std::max(largest, size(i));
    Eigen::VectorXd deviations(gauges());
    for (int i = 0; i < gauges(); ++i)
      deviations[i] =
          std::hypot(noise_strain(), error * largest / 16) +
          error * (size(i) + (size((i + 1) % gauges()) + size((i + gauges() - 1) % gauges())) / 8);
    return deviations;
  }
  /// The bound of a press where readings are off by so much each.
  Eigen::Vector4d bound(const Press& press, const Eigen::VectorXd& deviations) const {
    const Eigen::MatrixX4d columns = deviations.cwiseInverse().asDiagonal() * slopes(press);
    return (columns.transpose() * columns).inverse().diagonal().cwiseSqrt();
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

  /// Readings as a fit takes them, of all gauges.
  firmware::ScaledReadings scaled(const std::vector<double>& strains) const {
    return firmware::scaledReadings(constants(), raw(strains), allGauges());
  }

  /// A contact in the firmware's units, of readings that were divided by 2^shift.
  firmware::ContactState stateOf(const Press& press, int shift) const {
    const double turns = angleOf_turn(press.position_pitch), load = loadOfOne(shift);
    const double part = constants().largest_moment_um2 == 0
                            ? 0
                            : momentOf_mm2(press.width_mm) * 1e6 / constants().largest_moment_um2;
    const auto nearest = [](double value) { return static_cast<std::int64_t>(std::llround(value)); };
    return {static_cast<std::uint32_t>(nearest(std::ldexp(turns, 32))),
            static_cast<firmware::Number>(nearest(press.normal / load)),
            static_cast<firmware::Number>(nearest(press.tangential / load)),
            static_cast<firmware::Number>(nearest(std::ldexp(part, kMomentBits)))};
  }
  Press pressOf(const firmware::ContactState& state, int shift) const {
    const double turns = std::ldexp(state.angle_q32, -32) - config_.gauges.first_angle_deg / 360;
    const double moment_mm2 =
        std::ldexp(state.moment_q20, -kMomentBits) * constants().largest_moment_um2 * 1e-6;
    return {(turns - std::floor(turns)) * gauges(), state.normal * loadOfOne(shift),
            state.tangential * loadOfOne(shift), widthOf_mm(moment_mm2)};
  }

  /// The shorter way round from one position to another [pitches].
  double between(double from_pitch, double to_pitch) const {
    const double apart = to_pitch - from_pitch;
    return apart - gauges() * std::round(apart / gauges());
  }
  /// Largest |tangential| / normal that friction allows.
  double friction() const { return config_.contact.friction_coefficient; }

 private:
  double perRadian_mm() const { return config_.finger.outer_radius_m * 1e3; }
  /// A pitch, N/m, N/m and a square millimetre in units of the model's parameters.
  Eigen::Vector4d unitsOfModel() const { return {pitch_rad(), 1, 1, 1 / (perRadian_mm() * perRadian_mm())}; }
  evidence::FittedContact contactOf(const Press& press) const {
    const double moment_rad2 = momentOf_mm2(press.width_mm) * unitsOfModel()[evidence::kMoment];
    return {2 * std::numbers::pi * angleOf_turn(press.position_pitch),
            {press.normal, press.tangential, moment_rad2, model::Profile::kEllipse, friction()}};
  }
  std::vector<evidence::FittedContact> contactsOf(std::span<const Press> presses) const {
    std::vector<evidence::FittedContact> contacts;
    for (const Press& press : presses) contacts.push_back(contactOf(press));
    return contacts;
  }
  double angleOf_turn(double position_pitch) const {
    const double turns = position_pitch / gauges() + config_.gauges.first_angle_deg / 360;
    return turns - std::floor(turns);
  }
  /// [N/m] of an amplitude of 1.
  double loadOfOne(int shift) const {
    return std::ldexp(constants().load_scale, constants().load_exponent + shift - 12);
  }

  config::FingerConfig config_;
  evidence::FitModel model_;
  std::unique_ptr<TableImage> tables_;
};

}  // namespace strainfinger
