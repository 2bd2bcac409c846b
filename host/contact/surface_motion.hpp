#pragma once
// What tractions do to the surface, computed from them alone.

#include <vector>

#include "host/contact/surface_kernel.hpp"
#include "host/contact/tanh_sinh.hpp"
#include "host/contact/tractions.hpp"

namespace strainfinger::contact {

/// The surface at an angle: displacements [m], and their derivatives to theta [m/rad].
struct SurfacePoint {
  double ur_m = 0;
  double ut_m = 0;
  double urSlope_m = 0;
  double utSlope_m = 0;
};

/// Integrates kernel and tractions by the double exponential rule from the point to the edges of each patch:
/// not what the solver does, which it is there to check. Error: 1e-13 of the largest displacement, slopes
/// 1e-11 of the largest (1e-8 within 1e-9 half widths of an edge). At an edge of a patch, or below the tip
/// of a wedge, slopes are infinite or not a number.
class SurfaceMotion {
 public:
  /// Keeps a reference to the kernel.
  SurfaceMotion(const SurfaceKernel& kernel, const Tractions& tractions);

  /// Costs about 20 us a patch.
  SurfacePoint at(double angle_rad) const;
  /// The same without the slopes, in half the time; beside a patch in a fifth.
  SurfacePoint displacementAt(double angle_rad) const;

 private:
  /// A part of a patch: its nodes, their loads [Pa rad] and weights [rad].
  struct Segment {
    double from, to;
    PatchPoints places;
    Eigen::ArrayXd weights, pressures, shears;
  };
  /// What moves points that are not on the patch: the whole patch cut at the tip, and, where nothing is
  /// singular any more, as few line loads as its polynomials need.
  struct Beside {
    std::vector<Segment> near;
    std::vector<LineTraction> far;
  };
  SurfacePoint pointAt(double angle_rad, bool withSlopes) const;
  Segment segmentOf(const PatchTractions& part, double from, double to) const;
  Eigen::ArrayXd distancesOf(const Patch& patch, const Segment& segment, double x) const;
  void addFromBeside(const PatchTractions& part, const Beside& beside, double angle_rad,
                     SurfacePoint& point) const;
  void addPatch(const PatchTractions& part, double angle_rad, bool withSlopes, SurfacePoint& point) const;
  void addDisplacements(const Eigen::ArrayXd& distances, const Segment& segment, SurfacePoint& point) const;
  void addSlopes(const Eigen::ArrayXd& distances, const Segment& segment, Traction here,
                 SurfacePoint& point) const;
  void addReflection(double angle_rad, SurfacePoint& point) const;

  const SurfaceKernel& kernel_;
  Tractions tractions_;
  TanhSinhRule rule_;
  Eigen::MatrixX4d coefficients_;  // as FourierTractions
  std::vector<Beside> beside_;     // of each patch
};

}  // namespace strainfinger::contact
