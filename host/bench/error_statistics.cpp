#include "host/bench/error_statistics.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/fixed_real.hpp"
#include "firmware/core/estimate.hpp"
#include "firmware/core/pipeline.hpp"
#include "host/base/no_value.hpp"
#include "host/bench/uniform.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::bench {
namespace {

constexpr std::uint32_t kPlaceChannel = kMaxGauges - 4;  ///< of the noise: behind the gauges'

}  // namespace

double Spread::rms() const {
  double squares = 0;
  for (const double magnitude : magnitudes_) squares += magnitude * magnitude;
  return std::sqrt(squares / static_cast<double>(magnitudes_.size()));
}

double Spread::most95() const {
  if (magnitudes_.empty()) return kNoValue;
  std::vector<double> sorted(magnitudes_);
  const auto at = sorted.begin() + static_cast<std::ptrdiff_t>((sorted.size() - 1) * 95 / 100);
  std::nth_element(sorted.begin(), at, sorted.end());
  return *at;
}

double Spread::worst() const {
  return magnitudes_.empty() ? kNoValue : *std::max_element(magnitudes_.begin(), magnitudes_.end());
}

Trial::Trial(const config::FingerConfig& actual, const config::FingerConfig& told, std::uint64_t seed)
    : actual_(actual),
      tables_(tables::buildTableImage(told)),
      strains_(actual),
      converter_(actual.gauges),
      analogNoise_strain_(simulation::analogNoise_strain(actual.gauges)),
      noise_(seed) {}

void Trial::touch(const simulation::Touch& touch, int repeats, ErrorStatistics& statistics) {
  const simulation::Strains strains = strains_.under({&touch, 1});
  std::vector<std::uint16_t> codes(static_cast<std::size_t>(strains_.count()));
  for (int repeat = 0; repeat < repeats; ++repeat, ++sample_) {
    for (std::uint32_t gauge = 0; gauge < codes.size(); ++gauge)
      codes[gauge] = converter_.codeOf(strains[gauge] + analogNoise_strain_ * noise_.at(sample_, gauge));
    judge(codes, touch, statistics);
  }
}

void Trial::touchAnywhere(double load_n_per_m, int contacts, ErrorStatistics& statistics) {
  for (int contact = 0; contact < contacts; ++contact) {
    const double angle_rad = uniform(noise_, sample_, kPlaceChannel) * 2 * std::numbers::pi;
    const double direction_rad = uniform(noise_, sample_, kPlaceChannel + 2) * std::numbers::pi / 2;
    touch({angle_rad, load_n_per_m * std::cos(direction_rad), load_n_per_m * std::sin(direction_rad)}, 1,
          statistics);
  }
}

void Trial::judge(const std::vector<std::uint16_t>& codes, const simulation::Touch& touch,
                  ErrorStatistics& statistics) const {
  ++statistics.contacts;
  firmware::Pipeline pipeline(tables_, firmware::FitMode::kRefined);
  const auto& fit = pipeline.process(codes).fit;
  if (!fit) {
    ++statistics.unnoticed;
    return;
  }
  const Contact contact = firmware::estimate(tables_.constants, *fit);
  if (contact.uncertain) {
    ++statistics.uncertain;
    return;
  }
  const double revolution_rad = 2 * std::numbers::pi;
  const double apart_rad =
      std::remainder(toReal(contact.angle) * revolution_rad - touch.angle_rad, revolution_rad);
  statistics.wrong += std::abs(apart_rad) > revolution_rad / 2 / strains_.count() ? 1 : 0;
  statistics.arc_mm.add(apart_rad * actual_.finger.outer_radius_m * 1e3);
  statistics.normal_n_per_m.add(toReal(contact.normal) - touch.normal_n_per_m);
  statistics.tangential_n_per_m.add(toReal(contact.tangential) - touch.tangential_n_per_m);
}

}  // namespace strainfinger::bench
