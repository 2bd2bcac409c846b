// impulse_table FILE: writes impulse_table.hpp, what the gauges of the default finger read around a line
// contact and one 2 mm wide, as integers, so that the same sample sets can be made here and on an emulated
// board.
#include <fmt/os.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/simulation/gauge_strains.hpp"

using namespace strainfinger;

namespace {

constexpr int kPoints = 4096;      ///< round the ring: straight lines between them are 3e-5 of the peak off
constexpr double kPeak = 1 << 14;  ///< of a line load's normal response
constexpr double kWidths_m[] = {0, 2e-3};

std::vector<double> response(const simulation::GaugeStrains& ring, const simulation::Touch& touch) {
  std::vector<double> strains;
  for (int i = 0; i < kPoints; ++i)
    strains.push_back(ring.at(2 * std::numbers::pi * i / kPoints, {&touch, 1}));
  return strains;
}

std::vector<double> normal(const simulation::GaugeStrains& ring, double width_m) {
  return response(ring, {.normal_n_per_m = 1, .width_m = width_m});
}

/// Of a contact half of which slips: how far a tangential load spreads depends on that (Mindlin).
std::vector<double> tangential(const simulation::GaugeStrains& ring, double width_m) {
  constexpr double kPull = 0.5;  // friction is 1
  std::vector<double> strains =
      response(ring, {.normal_n_per_m = 1, .tangential_n_per_m = kPull, .width_m = width_m});
  const std::vector<double> pressed = normal(ring, width_m);
  for (std::size_t i = 0; i < strains.size(); ++i) strains[i] = (strains[i] - pressed[i]) / kPull;
  return strains;
}

void print(fmt::ostream& file, const std::vector<double>& strains, double scale) {
  file.print("{{");
  for (const double strain : strains) file.print("{}, ", std::lround(strain * scale));
  file.print("}},\n");
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  auto file = fmt::output_file(arguments[1]);
  const config::FingerConfig config;
  const simulation::GaugeStrains ring{config};
  double peak = 0;
  for (const double strain : normal(ring, 0)) peak = std::max(peak, std::abs(strain));
  file.print("#pragma once\n#include <cstdint>\nnamespace strainfinger::emulated {{\n");
  const double codes_per_strain = 0x10000 / (2 * config.gauges.full_scale_strain);
  file.print("inline constexpr std::int32_t kPeakCodesAt30_n_per_m = {};\n",
             std::lround(30 * peak * codes_per_strain));
  file.print("inline constexpr std::uint32_t kTurn_q32Of50_um = {};\n",
             std::lround(50e-6 / (2 * std::numbers::pi * config.finger.outer_radius_m) * 4294967296.0));
  for (const char* const load : {"Normal", "Tangential"}) {
    const bool isNormal = *load == 'N';
    file.print("inline constexpr std::int16_t k{}Response[{}][{}] = {{\n", load, std::size(kWidths_m),
               kPoints);
    for (const double width_m : kWidths_m) {
      print(file, isNormal ? normal(ring, width_m) : tangential(ring, width_m), kPeak / peak);
    }
    file.print("}};\n");
  }
  file.print("}}\n");
}
