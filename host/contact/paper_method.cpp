#include "host/contact/paper_method.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/base/failure.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

/// The even or odd part of the indenter's slope d u_r / d theta, weighted like the map's rows.
VectorXd slopePart(const SlopeMap& map, const Indenter& indenter, double radius_m, bool isEven) {
  const auto slope = [&](double angle_rad) {
    return radius_m * (angle_rad + indenter.slope(radius_m * angle_rad));
  };
  VectorXd part(map.angles_rad().size());
  for (Index i = 0; i < part.size(); ++i) {
    const double here = slope(map.angles_rad()[i]), there = slope(-map.angles_rad()[i]);
    part[i] = map.weights()[i] * (isEven ? here + there : here - there) / 2;
  }
  return part;
}

/// Depth and residual: the surface against the indenter's shape.
void compareShapes(const model::Annulus<double>& annulus, const Indenter& indenter, double half_rad,
                   PaperContact& contact) {
  constexpr int kPlaces = 33;
  VectorXd gaps(kPlaces);
  for (int i = 0; i < kPlaces; ++i) {
    const double angle_rad = half_rad * (2.0 * i / (kPlaces - 1) - 1), radius_m = annulus.outer_radius_m;
    const double profile_m = radius_m * angle_rad * angle_rad / 2 + indenter.height(radius_m * angle_rad);
    gaps[i] = surfaceAt(annulus, contact.tractions, angle_rad).ur_m - profile_m;
  }
  contact.depth_m = -gaps[kPlaces / 2];
  contact.residual_m = (gaps.array() - gaps.mean()).abs().maxCoeff();
}

}  // namespace

PaperContact solveByPaper(const model::Annulus<double>& annulus, const Indenter& indenter, double width_m,
                          const PaperOptions& options) {
  if (!(options.cutoff >= 0 && options.cutoff < 1))
    throw Failure(ExitCode::kUsage, "the cut-off must be from 0 to below 1");
  const double radius_m = annulus.outer_radius_m, half_rad = width_m / (2 * radius_m);
  const SlopeMap map(annulus, {width_m / radius_m, options.harmonics, false, options.rows, options.window});
  const std::vector<SingularPair> pairs = singularPairs(map);
  const VectorXd even = slopePart(map, indenter, radius_m, true),
                 odd = slopePart(map, indenter, radius_m, false);
  VectorXd evenUnknowns = VectorXd::Zero(map.block(true).cols()), oddUnknowns = evenUnknowns;
  PaperContact contact;
  for (const SingularPair& pair : pairs) {
    if (!(pair.value > options.cutoff * pairs[0].value)) break;
    ++contact.kept;
    contact.keptEven += pair.isEvenSlope ? 0 : 1;
    const VectorXd& wanted = pair.isEvenSlope ? even : odd;
    (pair.isEvenSlope ? evenUnknowns : oddUnknowns) += pair.unknowns * (pair.slopes.dot(wanted) / pair.value);
  }
  contact.tractions = map.tractions(true, evenUnknowns) + map.tractions(false, oddUnknowns);
  contact.normal_n_per_m = 2 * std::numbers::pi * radius_m * contact.tractions(0, 0);
  compareShapes(annulus, indenter, half_rad, contact);
  return contact;
}

PaperErrors errorsOf(const PaperContact& contact, const Contact& exact) {
  constexpr int kPlaces = 4000;
  constexpr double kBeyond = 1.0065;
  const double half_rad = exact.tractions[0].patch.half_rad, end_rad = std::numbers::pi - kBeyond * half_rad;
  const double centre_pa = tractionAt(exact.tractions, 0).pressure_pa;
  PaperErrors errors;
  errors.scale_pa = std::isfinite(centre_pa) ? centre_pa : exact.normal_n_per_m / exact.width_m;
  double within = 0, beyond = 0;
  for (const double side : {-1.0, 1.0})
    for (int i = 0; i <= kPlaces; ++i) {
      const double t = static_cast<double>(i) / kPlaces, inside_rad = side * half_rad * t;
      const double inside_pa = tractionAt(contact.tractions, inside_rad).pressure_pa;
      const double outside_pa =
          tractionAt(contact.tractions, side * (kBeyond * half_rad + end_rad * t)).pressure_pa;
      const double known_pa = tractionAt(exact.tractions, inside_rad).pressure_pa;
      if (std::isfinite(known_pa))
        errors.inside = std::max(errors.inside, std::abs(inside_pa - known_pa) / errors.scale_pa);
      errors.outside = std::max(errors.outside, std::abs(outside_pa) / errors.scale_pa);
      within += half_rad * inside_pa * inside_pa;
      beyond += end_rad * outside_pa * outside_pa;
    }
  errors.centre = std::abs(tractionAt(contact.tractions, 0).pressure_pa - centre_pa) / errors.scale_pa;
  errors.load = contact.normal_n_per_m / exact.normal_n_per_m - 1;
  errors.leakedShare = beyond / (within + beyond);
  return errors;
}

}  // namespace strainfinger::contact
