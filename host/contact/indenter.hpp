#pragma once
// What presses on the finger.

#include <Eigen/Core>
#include <memory>
#include <string>
#include <vector>

namespace strainfinger::contact {

/// The profile of a rigid indenter: its height above its tangent plane at x = 0, positive away from the
/// finger, as a function of the arc x = r_b theta on the surface; where it touches,
///     u_r = -depth + x^2 / (2 r_b) + height(x)
/// (the paper's convention: a flat indenter's slope is r_b theta; another one, as r_b (1/cos theta - 1),
/// gives loads that differ by 0.4 % at a width of 2 mm and 3.5 % at 6 mm). A value; copies share a measured
/// shape.
class Indenter {
 public:
  static constexpr int kPowers = 6;  ///< of the spline through measured points

  static Indenter flat();
  /// Domain: radius_m > 0; the axis is parallel to the finger's.
  static Indenter cylinder(double radius_m);
  /// A blade with its edge on the finger; half_angle_deg is between its axis and each face. Domain: above 0,
  /// below 90.
  static Indenter wedge(double half_angle_deg);
  /// Through measured points by a spline of the fifth degree (not-a-knot), so that a measured parabola is
  /// that parabola, and what the spline itself is rough by at its points is below 1e-12 m of contacts. Throws
  /// Failure(kUsage) unless there are four points or more with rising positions.
  static Indenter measured(std::vector<double> position_m, std::vector<double> height_m);

  double height(double x_m) const;
  double slope(double x_m) const;  ///< d height / dx; at the edge of a wedge: 0

  bool isSymmetric() const { return spline_ == nullptr; }
  bool isMeasured() const { return spline_ != nullptr; }
  /// d height / dx just after x = 0 for a wedge, whose slope jumps by twice that; 0 for the others.
  double edgeSlope() const { return edgeSlope_; }
  /// Where the profile is known: all of it, or from the first to the last measured point.
  double firstPosition_m() const;
  double lastPosition_m() const;
  struct Swing {
    double height_m = 0;
    double position_m = 0;  ///< where
  };
  /// How far the curve through measured points is, at worst, from the cubic through the four that are
  /// nearest, half way between any two of them from first_m to last_m and three beyond: where heights jump
  /// the curve swings, and what it swings by is not the shape that was measured. 0 of the others.
  Swing swing(double first_m, double last_m) const;
  /// Of the measured points; none of the others.
  std::vector<double> positions_m() const { return spline_ ? spline_->position_m : std::vector<double>{}; }

 private:
  struct Spline {
    std::vector<double> position_m;
    Eigen::Matrix<double, kPowers, Eigen::Dynamic> pieces;  ///< columns: powers of 0..1 between two points
  };
  struct Place {
    Eigen::Index piece;
    double share;  ///< of the way from its first point to the next
  };
  Indenter(double curvature_per_m, double edgeSlope)
      : curvature_per_m_(curvature_per_m), edgeSlope_(edgeSlope) {}
  Place place(double x_m) const;

  double curvature_per_m_;
  double edgeSlope_;
  std::shared_ptr<const Spline> spline_;
};

}  // namespace strainfinger::contact
