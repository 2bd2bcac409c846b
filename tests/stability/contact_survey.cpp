#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

#include "host/base/failure.hpp"
#include "tests/stability/all_cores.hpp"
#include "tests/stability/survey.hpp"

namespace strainfinger::stability {
namespace {

using namespace contact;

constexpr std::array kWidths_rad{1e-6, 1e-4, 1e-2, 0.15, std::numbers::pi / 4, std::numbers::pi / 2};

struct NamedIndenter {
  const char* name;
  Indenter indenter;
};

std::array<NamedIndenter, 3> indenters() {
  return {
      {{"flat", Indenter::flat()}, {"cylinder", Indenter::cylinder(5e-3)}, {"wedge", Indenter::wedge(80)}}};
}

/// The pressure too, but beside a wedge's tip, where it has no end.
bool isFinite(const Contact& contact) {
  const double besideTip_rad = 0.1 * contact.width_m / kOuterRadius_m;
  for (const double value :
       {contact.normal_n_per_m, contact.tangential_n_per_m, contact.depth_m, contact.offset_rad,
        contact.residual_m, tractionAt(contact.tractions, contact.offset_rad + besideTip_rad).pressure_pa})
    if (!std::isfinite(value)) return false;
  return true;
}

ContactRegion contactOf(const SurfaceKernel& kernel, double width_rad, Regime regime,
                        const NamedIndenter& pressed) {
  ContactRequest request;
  request.indenter = pressed.indenter;
  request.regime = regime;
  request.friction = 0.5;
  request.size.value = width_rad * kOuterRadius_m;
  const model::Annulus<double>& annulus = kernel.annulus();
  ContactRegion region{annulus.core_radius_m / annulus.outer_radius_m,
                       annulus.poisson_ratio,
                       width_rad,
                       regime,
                       pressed.name,
                       0,
                       false,
                       false};
  try {
    const Contact contact = solveContact(kernel, request);
    region.isWarnedOf = !contact.warnings.empty();
    region.misfit = isFinite(contact) ? contact.residual_m / std::abs(contact.depth_m)
                                      : std::numeric_limits<double>::quiet_NaN();
  } catch (const Failure&) {
    region.isRefused = true;
  }
  return region;
}

/// Contacts far wider than the layer is thick take up to a minute each, to say that they are not resolved: of
/// those on the thinnest layer only some are looked at.
constexpr double kThinnest = 0.998, kNarrow_rad = 0.01;

struct Case {
  double alpha, poissonRatio, width_rad;
  Regime regime;
  NamedIndenter pressed;
};

bool isLookedAt(const Case& each) {
  if (each.alpha < kThinnest || each.width_rad <= kNarrow_rad) return true;
  return each.pressed.name == std::string_view("flat") && each.poissonRatio == 0.5 &&
         each.regime == Regime::kFrictionless;
}

std::vector<Case> casesOf(std::span<const double> alphas, std::span<const double> poissonRatios) {
  std::vector<Case> cases;
  for (const double alpha : alphas)
    for (const double poissonRatio : poissonRatios)
      for (const double width_rad : kWidths_rad)
        for (const Regime regime : {Regime::kFrictionless, Regime::kSliding, Regime::kStick})
          for (const NamedIndenter& pressed : indenters()) {
            const Case each{alpha, poissonRatio, width_rad, regime, pressed};
            if (isLookedAt(each)) cases.push_back(each);
          }
  return cases;
}

}  // namespace

std::vector<ContactRegion> surveyContacts(std::span<const double> alphas,
                                          std::span<const double> poissonRatios) {
  const std::vector<Case> cases = casesOf(alphas, poissonRatios);
  std::vector<ContactRegion> regions(cases.size());
  forEachOnAllCores(cases.size(), [&](std::size_t i) {
    const auto& [alpha, poissonRatio, width_rad, regime, pressed] = cases[i];
    const SurfaceKernel kernel({alpha * kOuterRadius_m, kOuterRadius_m, kShearModulus_pa, poissonRatio});
    regions[i] = contactOf(kernel, width_rad, regime, pressed);
  });
  return regions;
}

}  // namespace strainfinger::stability
