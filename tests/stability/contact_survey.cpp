#include <cmath>
#include <limits>
#include <numbers>

#include "tests/stability/survey.hpp"

namespace strainfinger::stability {
namespace {

using namespace contact;

constexpr double kOuterRadius_m = 12.7e-3, kShearModulus_pa = 8.3e4;
constexpr std::array kWidths_rad{1e-6, 1e-4, 1e-2, 0.15, std::numbers::pi / 4, std::numbers::pi / 2};
constexpr double kThinnest = 0.99, kWidestThin_rad = 1e-2;

bool isFinite(const Contact& contact) {
  for (const double value :
       {contact.normal_n_per_m, contact.tangential_n_per_m, contact.depth_m, contact.offset_rad,
        contact.residual_m, tractionAt(contact.tractions, contact.offset_rad).pressure_pa})
    if (!std::isfinite(value)) return false;
  return true;
}

ContactRegion contactOf(const SurfaceKernel& kernel, double width_rad, Regime regime) {
  ContactRequest request;
  request.regime = regime;
  request.friction = 0.5;
  request.size.value = width_rad * kOuterRadius_m;
  const Contact contact = solveContact(kernel, request);
  const model::Annulus<double>& annulus = kernel.annulus();
  return {annulus.core_radius_m / annulus.outer_radius_m,
          annulus.poisson_ratio,
          width_rad,
          regime,
          isFinite(contact) ? contact.residual_m / std::abs(contact.depth_m)
                            : std::numeric_limits<double>::quiet_NaN(),
          !contact.warnings.empty()};
}

}  // namespace

std::vector<ContactRegion> surveyContacts(std::span<const double> alphas) {
  std::vector<ContactRegion> regions;
  for (const double alpha : alphas)
    for (const double poissonRatio : {0.3, 0.5}) {
      const SurfaceKernel kernel({alpha * kOuterRadius_m, kOuterRadius_m, kShearModulus_pa, poissonRatio});
      for (const double width_rad : kWidths_rad)
        for (const Regime regime : {Regime::kFrictionless, Regime::kSliding, Regime::kStick})
          if (alpha <= kThinnest || width_rad <= kWidestThin_rad)
            regions.push_back(contactOf(kernel, width_rad, regime));
    }
  return regions;
}

}  // namespace strainfinger::stability
