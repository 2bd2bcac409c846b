// impulse_table FILE: writes impulse_table.hpp, what the gauges of the default finger read around a contact,
// as integers, so that the same sample sets can be made here and on an emulated board.
#include <fmt/os.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "host/simulation/gauge_strains.hpp"

using namespace strainfinger;

namespace {

constexpr int kPoints = 4096;      ///< round the ring: straight lines between them are 3e-5 of the peak off
constexpr double kPeak = 1 << 14;  ///< of the normal response

std::vector<double> response(const simulation::GaugeStrains& ring, const simulation::Touch& touch) {
  std::vector<double> strains;
  for (int i = 0; i < kPoints; ++i)
    strains.push_back(ring.at(2 * std::numbers::pi * i / kPoints, {&touch, 1}));
  return strains;
}

void print(fmt::ostream& file, const char* name, const std::vector<double>& strains, double scale) {
  file.print("inline constexpr std::int16_t {}[{}] = {{", name, kPoints);
  for (const double strain : strains) file.print("{}, ", std::lround(strain * scale));
  file.print("}};\n");
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 2) return 2;
  auto file = fmt::output_file(arguments[1]);
  const simulation::GaugeStrains ring{config::FingerConfig{}};
  const auto normal = response(ring, {.normal_n_per_m = 1});
  const auto tangential = response(ring, {.tangential_n_per_m = 1});
  double peak = 0;
  for (const double strain : normal) peak = std::max(peak, std::abs(strain));
  file.print("#pragma once\n#include <cstdint>\nnamespace strainfinger::emulated {{\n");
  print(file, "kNormalResponse", normal, kPeak / peak);
  print(file, "kTangentialResponse", tangential, kPeak / peak);
  file.print("}}\n");
}
