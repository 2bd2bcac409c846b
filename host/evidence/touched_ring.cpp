#include "host/evidence/touched_ring.hpp"

#include "common/fixed_real.hpp"
#include "common/quantities.hpp"

namespace strainfinger::evidence {

TouchedRing::TouchedRing(const config::FingerConfig& config, std::uint64_t seed)
    : strains_(config),
      converter_(config.gauges),
      noise_strain_(config.gauges.noise_strain),
      analogNoise_strain_(simulation::analogNoise_strain(config.gauges)),
      noise_(seed) {}

Eigen::VectorXd TouchedRing::noisy(const Eigen::VectorXd& exact, std::uint64_t number) const {
  Eigen::VectorXd readings = exact;
  for (Eigen::Index gauge = 0; gauge < exact.size(); ++gauge)
    readings[gauge] += noise_strain_ * noise_.at(number, static_cast<std::uint32_t>(gauge));
  return readings;
}

std::vector<std::uint16_t> TouchedRing::codes(const Eigen::VectorXd& exact, std::uint64_t number) const {
  std::vector<std::uint16_t> codes;
  for (Eigen::Index gauge = 0; gauge < exact.size(); ++gauge)
    codes.push_back(converter_.codeOf(
        exact[gauge] + analogNoise_strain_ * noise_.at(number, static_cast<std::uint32_t>(gauge))));
  return codes;
}

std::vector<std::int32_t> conditioned_q32(const Eigen::VectorXd& readings) {
  std::vector<std::int32_t> rounded;
  for (const double strain : readings) rounded.push_back(fromReal<StrainQ32>(strain).raw());
  return rounded;
}

}  // namespace strainfinger::evidence
