#include "host/contact/surface_motion.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "host/base/angles.hpp"
#include "host/contact/fourier_tractions.hpp"
#include "host/model/series.hpp"

namespace strainfinger::contact {
namespace {

using Eigen::ArrayXd;
using Eigen::Index;

int degreeOf(const Tractions& tractions) {
  Index most = 0;
  for (const PatchTractions& part : tractions)
    most = std::max({most, part.smooth.coefficients.size(), part.stuck.coefficients.size()});
  return static_cast<int>(most);
}

/// int cot((theta - phi)/2)/2 dphi over the patch, principal value.
double integralOfPole(const Patch& patch, double angle_rad) {
  return std::log(
      std::abs(std::sin((angle_rad - patch.first_rad()) / 2) / std::sin((angle_rad - patch.last_rad()) / 2)));
}

}  // namespace

SurfaceMotion::SurfaceMotion(const SurfaceKernel& kernel, const Tractions& tractions)
    : kernel_(kernel),
      tractions_(tractions),
      rule_(TanhSinhRule::ofDegree(degreeOf(tractions))),
      coefficients_(fourierTractions(tractions, static_cast<int>(kernel.reflection().normal.size()) - 1)) {
  for (const PatchTractions& part : tractions_) {
    const bool isCut = part.tip.isThere();
    const double cut = isCut ? part.tip.position : 1;
    Beside beside{{segmentOf(part, -1, cut)}, lineTractions({part}, 0)};
    if (isCut) beside.near.push_back(segmentOf(part, cut, 1));
    beside_.push_back(std::move(beside));
  }
}

SurfacePoint SurfaceMotion::at(double angle_rad) const { return pointAt(angle_rad, true); }

SurfacePoint SurfaceMotion::displacementAt(double angle_rad) const { return pointAt(angle_rad, false); }

SurfacePoint SurfaceMotion::pointAt(double angle_rad, bool withSlopes) const {
  SurfacePoint point;
  for (std::size_t k = 0; k < tractions_.size(); ++k) {
    const Patch& patch = tractions_[k].patch;
    if (withSlopes || std::abs(angle_rad - patch.centre_rad) < patch.half_rad)
      addPatch(tractions_[k], angle_rad, withSlopes, point);
    else
      addFromBeside(tractions_[k], beside_[k], angle_rad, point);
  }
  addReflection(angle_rad, point);
  return point;
}

SurfaceMotion::Segment SurfaceMotion::segmentOf(const PatchTractions& part, double from, double to) const {
  const double length = to - from;
  Segment segment{from, to, {1 + from + length * rule_.fromStart, 1 - to + length * rule_.fromEnd},
                  {},   {}, {}};
  segment.weights = part.patch.half_rad * length * rule_.weights;
  segment.pressures = segment.weights * part.pressure_pa(segment.places);
  segment.shears = part.friction * segment.pressures + segment.weights * part.stuck_pa(segment.places);
  return segment;
}

/// Distances of the segment's nodes from a place, from the end next to it so that none loses digits.
ArrayXd SurfaceMotion::distancesOf(const Patch& patch, const Segment& segment, double x) const {
  const double length = segment.to - segment.from;
  ArrayXd distances = x >= segment.to ? ArrayXd(x - segment.to + length * rule_.fromEnd)
                                      : ArrayXd(x - segment.from - length * rule_.fromStart);
  distances *= patch.half_rad;
  for (double& distance : distances)
    if (std::abs(distance) > std::numbers::pi) distance = std::remainder(distance, 2 * std::numbers::pi);
  return distances;
}

void SurfaceMotion::addFromBeside(const PatchTractions& part, const Beside& beside, double angle_rad,
                                  SurfacePoint& point) const {
  constexpr double kFar = 1.3;  // half widths: 24 nodes more than terms leave 2.1^-48 of the kernel
  const double from_rad = shortWay_rad(angle_rad, part.patch.centre_rad);
  if (std::abs(from_rad) < kFar * part.patch.half_rad) {
    for (const Segment& segment : beside.near)
      addDisplacements(distancesOf(part.patch, segment, from_rad / part.patch.half_rad), segment, point);
    return;
  }
  for (const LineTraction& line : beside.far) {
    const auto [even, odd] = kernel_.valuesAt(shortWay_rad(angle_rad, line.angle_rad));
    point.ur_m += odd * line.shear_pa_rad - even * line.pressure_pa_rad;
    point.ut_m += odd * line.pressure_pa_rad + even * line.shear_pa_rad;
  }
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
    const Segment segment = segmentOf(part, cuts[i], cuts[i + 1]);
    const ArrayXd distances = distancesOf(part.patch, segment, x);
    addDisplacements(distances, segment, point);
    if (withSlopes) addSlopes(distances, segment, here, point);
  }
  if (!withSlopes || !isOnIt) return;
  const double pole = kernel_.evenPole() * integralOfPole(part.patch, angle_rad);
  point.urSlope_m += kernel_.oddStep() * here.shear_pa - pole * here.pressure_pa;
  point.utSlope_m += kernel_.oddStep() * here.pressure_pa + pole * here.shear_pa;
}

// A node so close to the point or to the tip of a wedge that rounding put it there has no weight either.
void SurfaceMotion::addDisplacements(const ArrayXd& distances, const Segment& segment,
                                     SurfacePoint& point) const {
  for (Index i = 0; i < distances.size(); ++i) {
    const double pressure = segment.pressures[i], shear = segment.shears[i];
    if (distances[i] == 0 || !std::isfinite(pressure)) continue;
    const auto [even, odd] = kernel_.valuesAt(distances[i]);
    point.ur_m += odd * shear - even * pressure;
    point.ut_m += odd * pressure + even * shear;
  }
}

void SurfaceMotion::addSlopes(const ArrayXd& distances, const Segment& segment, Traction here,
                              SurfacePoint& point) const {
  for (Index i = 0; i < distances.size(); ++i) {
    const double distance = distances[i], pressure = segment.pressures[i], shear = segment.shears[i];
    if (distance == 0 || !std::isfinite(pressure)) continue;
    const auto [even, odd] = kernel_.slopesAt(distance);
    const double pole = segment.weights[i] * kernel_.evenPole() * 0.5 / std::tan(distance / 2);
    point.urSlope_m += odd * shear - even * pressure + pole * here.pressure_pa;
    point.utSlope_m += odd * pressure + even * shear - pole * here.shear_pa;
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
