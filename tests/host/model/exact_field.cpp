#include "tests/host/model/exact_field.hpp"

#include <cmath>
#include <vector>

#include "tests/host/model/wide.hpp"

namespace strainfinger::testing {
struct ExactField::Harmonics {
  WideAnnulus finger;
  std::vector<WideResponse> responses;
};

ExactField::ExactField(const model::Annulus<double>& annulus, double radius_m) {
  auto harmonics = std::make_unique<Harmonics>();
  harmonics->finger = widen(annulus);
  const int last = static_cast<int>(std::log(1e-30) / std::log(radius_m / annulus.outer_radius_m)) + 50;
  for (int n = 0; n <= last; ++n)
    harmonics->responses.push_back(michellResponse(harmonics->finger, radius_m, n));
  harmonics_ = std::move(harmonics);
}

ExactField::~ExactField() = default;

std::array<long double, model::kRowCount> ExactField::at(const model::SurfaceLoad& load, double angle_rad,
                                                         double gauge_rad) const {
  using namespace model;
  const Wide unit = 1 / (boost::math::constants::pi<Wide>() * harmonics_->finger.outer_radius_m);
  const Wide p = -load.normal_n_per_m * unit, q = load.tangential_n_per_m * unit;
  Multiples angle{angle_rad}, width{Wide(load.width_rad) / 2}, gauge{Wide(gauge_rad) / 2};
  std::array<Wide, kRowCount> sums;
  for (std::size_t n = 0; n < harmonics_->responses.size(); ++n) {
    const Wide weight = width.mean() * gauge.mean() / (n == 0 ? 2 : 1);
    for (std::size_t row = 0; row < sums.size(); ++row) {
      const Wide normal = harmonics_->responses[n](static_cast<int>(row), kNormal) * p * weight;
      const Wide tangential = harmonics_->responses[n](static_cast<int>(row), kTangential) * q * weight;
      const bool isShear = row == kTrt || row == kUt || row == kErt;
      sums[row] +=
          isShear ? tangential * angle.c - normal * angle.s : normal * angle.c + tangential * angle.s;
    }
    for (Multiples* each : {&angle, &width, &gauge}) each->advance();
  }
  std::array<long double, kRowCount> rounded;
  for (std::size_t row = 0; row < sums.size(); ++row) rounded[row] = static_cast<long double>(sums[row]);
  return rounded;
}

}  // namespace strainfinger::testing
