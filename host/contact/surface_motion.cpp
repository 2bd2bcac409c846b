#include "host/contact/surface_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "host/contact/fourier_tractions.hpp"
#include "host/model/series.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

constexpr int kDensity = 14;  // of the rule: enough for polynomials of degree 40 besides the edges

/// int cot((theta - phi)/2)/2 dphi over the patch, principal value.
double integralOfPole(const Patch& patch, double angle_rad) {
  return std::log(
      std::abs(std::sin((angle_rad - patch.first_rad()) / 2) / std::sin((angle_rad - patch.last_rad()) / 2)));
}

}  // namespace

/// A segment of a patch: places, weights [rad], and distances point - place [rad].
struct SurfaceMotion::Nodes {
  PatchPoints places;
  ArrayXd weights;
  ArrayXd distances;
};

SurfaceMotion::SurfaceMotion(const SurfaceKernel& kernel, const Tractions& tractions)
    : kernel_(kernel),
      tractions_(tractions),
      rule_(kDensity),
      coefficients_(fourierTractions(tractions, static_cast<int>(kernel.reflection().normal.size()) - 1)) {}

SurfacePoint SurfaceMotion::at(double angle_rad) const { return pointAt(angle_rad, true); }

SurfacePoint SurfaceMotion::displacementAt(double angle_rad) const { return pointAt(angle_rad, false); }

SurfacePoint SurfaceMotion::pointAt(double angle_rad, bool withSlopes) const {
  SurfacePoint point;
  for (const PatchTractions& part : tractions_) addPatch(part, angle_rad, withSlopes, point);
  addReflection(angle_rad, point);
  return point;
}

// The patch is cut at the point, if that is on it, and below the tip of a wedge.
void SurfaceMotion::addPatch(const PatchTractions& part, double angle_rad, bool withSlopes,
                             SurfacePoint& point) const {
  const double x = (angle_rad - part.patch.centre_rad) / part.patch.half_rad;
  const bool isOnIt = std::abs(x) < 1;
  std::vector<double> cuts{-1, 1};
  if (isOnIt) cuts.push_back(x);
  if (part.tip.isThere() && part.tip.position != x) cuts.push_back(part.tip.position);
  std::ranges::sort(cuts);
  const Traction here = withSlopes && isOnIt ? tractionAt({part}, angle_rad) : Traction{};
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    const Nodes nodes = nodesBetween(part.patch, cuts[i], cuts[i + 1], x);
    addDisplacements(part, nodes, point);
    if (withSlopes) addSlopes(part, nodes, here, point);
  }
  if (!withSlopes || !isOnIt) return;
  const double pole = kernel_.evenPole() * integralOfPole(part.patch, angle_rad);
  point.urSlope_m += kernel_.oddStep() * here.shear_pa - pole * here.pressure_pa;
  point.utSlope_m += kernel_.oddStep() * here.pressure_pa + pole * here.shear_pa;
}

SurfaceMotion::Nodes SurfaceMotion::nodesBetween(const Patch& patch, double from, double to, double x) const {
  const double length = to - from;
  const ArrayXd start = length * rule_.fromStart, end = length * rule_.fromEnd;
  Nodes nodes{{1 + from + start, 1 - to + end}, patch.half_rad * length * rule_.weights, {}};
  if (x >= to)
    nodes.distances = patch.half_rad * (x - to + end);
  else
    nodes.distances = patch.half_rad * (x - from - start);
  for (double& distance : nodes.distances)
    if (std::abs(distance) > std::numbers::pi) distance = std::remainder(distance, 2 * std::numbers::pi);
  return nodes;
}

// A node so close to the point or to the tip of a wedge that rounding put it there has no weight either.
void SurfaceMotion::addDisplacements(const PatchTractions& part, const Nodes& nodes,
                                     SurfacePoint& point) const {
  const ArrayXd pressures = nodes.weights * part.pressure_pa(nodes.places),
                shears = part.friction * pressures + nodes.weights * part.stuck_pa(nodes.places);
  for (Index i = 0; i < pressures.size(); ++i) {
    if (nodes.distances[i] == 0 || !std::isfinite(pressures[i])) continue;
    const KernelPair pair = kernel_.valuesAt(nodes.distances[i]);
    point.ur_m += pair.odd * shears[i] - pair.even * pressures[i];
    point.ut_m += pair.odd * pressures[i] + pair.even * shears[i];
  }
}

void SurfaceMotion::addSlopes(const PatchTractions& part, const Nodes& nodes, Traction here,
                              SurfacePoint& point) const {
  const ArrayXd pressures = part.pressure_pa(nodes.places), shears = part.shear_pa(nodes.places);
  for (Index i = 0; i < pressures.size(); ++i) {
    const double distance = nodes.distances[i];
    if (distance == 0 || !std::isfinite(pressures[i])) continue;
    const auto [even, odd] = kernel_.slopesAt(distance);
    const double pole = kernel_.evenPole() * 0.5 / std::tan(distance / 2);
    point.urSlope_m += nodes.weights[i] * (odd * shears[i] - even * pressures[i] + pole * here.pressure_pa);
    point.utSlope_m += nodes.weights[i] * (odd * pressures[i] + even * shears[i] - pole * here.shear_pa);
  }
}

void SurfaceMotion::addReflection(double angle_rad, SurfacePoint& point) const {
  const Reflection& reflection = kernel_.reflection();
  model::visitMultiples(
      angle_rad, static_cast<int>(reflection.normal.size()) - 1, [&](int n, double c, double s) {
        const auto row = coefficients_.row(n);
        const double pressureEven = row[0] * c + row[1] * s, pressureOdd = row[0] * s - row[1] * c;
        const double shearEven = row[2] * c + row[3] * s, shearOdd = row[2] * s - row[3] * c;
        point.ur_m += reflection.coupling[n] * shearOdd - reflection.normal[n] * pressureEven;
        point.ut_m += reflection.coupling[n] * pressureOdd + reflection.sheared[n] * shearEven;
        point.urSlope_m += n * (reflection.coupling[n] * shearEven + reflection.normal[n] * pressureOdd);
        point.utSlope_m += n * (reflection.coupling[n] * pressureEven - reflection.sheared[n] * shearOdd);
      });
}

}  // namespace strainfinger::contact
