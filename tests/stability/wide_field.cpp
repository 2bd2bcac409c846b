#include "tests/stability/wide_field.hpp"

#include <cmath>

#include "host/model/surface_sums.hpp"

namespace strainfinger::stability {
namespace {

using namespace model;

using Phases = WideField::Value;
using testing::Multiples;

/// What multiplies the responses of a row: of a pressing load p^c = -1, of a tangential one q^c = 1.
void addTerm(Phases& sum, const testing::WideResponse& response, const Wide& c, const Wide& s) {
  for (int row = 0; row < kRowCount; ++row) {
    const bool even = isEvenInNormalLoad(static_cast<Row>(row));
    sum(row, kNormal) -= response(row, kNormal) * (even ? c : Wide(-s));
    sum(row, kTangential) += response(row, kTangential) * (even ? s : c);
  }
}

/// Of c_0 + c_1 / (n - 1) + c_2 / (n + 1), n >= 2, over a load of some width.
Phases closedForm(const testing::WideAnnulus& annulus, const Wide& width, const Wide& angle) {
  const Wide pi = boost::math::constants::pi<Wide>();
  const auto difference = edgeDifferences<Wide>(angle, width / 2, pi);
  const Vector3<Wide> cosines = difference.sines / width, sines = -difference.cosines / width;
  Phases sum;
  for (int row = 0; row < kRowCount; ++row) {
    const auto factors = asymptote(annulus, static_cast<Row>(row));
    const bool even = isEvenInNormalLoad(static_cast<Row>(row));
    sum(row, kNormal) = (even ? -1 : 1) * factors.normal.dot(even ? cosines : sines);
    sum(row, kTangential) = factors.tangential.dot(even ? sines : cosines);
  }
  return sum;
}

constexpr double kDigits = 20;

}  // namespace

int WideField::harmonics(const Annulus<double>& annulus, double radius_m) {
  const double base = radius_m == annulus.outer_radius_m
                          ? 2 * std::log1p((annulus.core_radius_m - radius_m) / radius_m)
                          : std::log1p((radius_m - annulus.outer_radius_m) / annulus.outer_radius_m);
  double n = 10;
  for (int i = 0; i < 20; ++i) n = 10 + (kDigits * std::log(10) + 2 * std::log(n)) / -base;
  return static_cast<int>(n);
}

WideField::WideField(const Annulus<double>& annulus, double radius_m)
    : atSurface_(radius_m == annulus.outer_radius_m),
      annulus_(testing::widen(annulus)),
      radius_m_(radius_m),
      harmonics_(harmonics(annulus, radius_m)) {}

/// At r_b without what the closed form has.
testing::WideResponse WideField::response(const HarmonicModel<Wide>& responses, int n) const {
  testing::WideResponse response = responses(n);
  for (int row = 0; atSurface_ && n >= 2 && row < kRowCount; ++row)
    for (const Traction traction : {kNormal, kTangential})
      response(row, traction) -= asymptote(annulus_, static_cast<Row>(row)).at(n, traction);
  return response;
}

std::vector<WideField::Value> WideField::at(std::span<const Place> places) const {
  const HarmonicModel<Wide> responses(annulus_, radius_m_);
  std::vector<Value> sums(places.size(), Value::Zero());
  std::vector<Multiples> angles, widths;
  for (const Place& place : places) {
    angles.emplace_back(Wide(place.angle_rad));
    widths.emplace_back(Wide(place.width_rad) / 2);
  }
  for (int n = 0; n <= harmonics_; ++n) {
    const testing::WideResponse each = response(responses, n);
    for (std::size_t k = 0; k < places.size(); ++k) {
      const Wide weight = n == 0 ? Wide(0.5) : widths[k].mean();
      addTerm(sums[k], each, weight * angles[k].c, weight * angles[k].s);
      angles[k].advance();
      widths[k].advance();
    }
  }
  for (std::size_t k = 0; k < places.size(); ++k) {
    if (atSurface_) sums[k] += closedForm(annulus_, places[k].width_rad, places[k].angle_rad);
    sums[k] /= boost::math::constants::pi<Wide>() * annulus_.outer_radius_m;
  }
  return sums;
}

}  // namespace strainfinger::stability
