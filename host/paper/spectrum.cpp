#include "host/paper/spectrum.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "host/model/series.hpp"

namespace strainfinger::paper {
namespace {

constexpr double kTolerance = 1e-6;

std::span<const double> values(const Spectra& spectra, StrainComponent component, model::Traction load) {
  return {spectra.col(column(component, load)).data(), static_cast<std::size_t>(spectra.rows())};
}

}  // namespace

Spectra cylinderSpectra(const model::Annulus<double>& annulus, double radius_m) {
  constexpr std::array kRows{model::kErr, model::kEtt, model::kErt};  // in the order of StrainComponent
  Spectra spectra = model::truncatedSeries(annulus, radius_m, kRows, {}, kTolerance);
  spectra.row(0) /= 2;
  return spectra;
}

HalfPlane halfPlaneOf(const model::Annulus<double>& annulus, double radius_m) {
  return {annulus.shear_modulus_pa, annulus.poisson_ratio, annulus.outer_radius_m - radius_m};
}

Spectra halfPlaneSpectra(const model::Annulus<double>& annulus, double radius_m) {
  constexpr double kLast = 20;  // k depth: (1 + k depth) exp(-k depth) = 4e-8
  const HalfPlane plane = halfPlaneOf(annulus, radius_m);
  const double wave_per_m = 1 / annulus.outer_radius_m;
  Spectra spectra(static_cast<Eigen::Index>(std::ceil(kLast / (wave_per_m * plane.depth_m))) + 1, 6);
  for (Eigen::Index n = 0; n < spectra.rows(); ++n)
    spectra.row(n) =
        plane.atWaveNumber(static_cast<double>(n) * wave_per_m).reshaped<Eigen::RowMajor>().transpose();
  return spectra;
}

CutOff cutOff(std::span<const double> spectrum) {
  CutOff result{};
  for (const double value : spectrum) result.maximum = std::max(result.maximum, std::abs(value));
  if (result.maximum == 0) return {0, -1, std::numeric_limits<double>::quiet_NaN()};
  const double level = kCutOffLevel * result.maximum;
  std::size_t last = spectrum.size() - 1;
  while (last > 0 && std::abs(spectrum[last]) < level) --last;
  assert(last + 1 < spectrum.size());
  const double above = std::abs(spectrum[last]), below = std::abs(spectrum[last + 1]);
  result.last = static_cast<int>(last);
  result.interpolated = result.last + (above - level) / (above - below);
  return result;
}

CutOffs cutOffs(const Spectra& spectra, StrainComponent component) {
  return {cutOff(values(spectra, component, model::kNormal)),
          cutOff(values(spectra, component, model::kTangential))};
}

bool vanishes(const model::Annulus<double>& annulus, double radius_m, StrainComponent component) {
  const CutOffs found = cutOffs(cylinderSpectra(annulus, radius_m), component);
  return found.normal.maximum == 0 && found.tangential.maximum == 0;
}

}  // namespace strainfinger::paper
