#pragma once
// What a contact exerts on the surface: functions on one or several patches, zero outside.

#include <Eigen/Core>
#include <vector>

#include "host/contact/jacobi.hpp"

namespace strainfinger::contact {

/// An arc of the surface in contact.
struct Patch {
  double centre_rad = 0;
  double half_rad = 0;

  double first_rad() const { return centre_rad - half_rad; }
  double last_rad() const { return centre_rad + half_rad; }
};

/// A place on a patch, x in -1..1 towards +theta, by its distances to both edges, neither of which loses
/// digits at its own edge. x = fromLeft - 1 = 1 - fromRight.
struct PatchPoints {
  Eigen::ArrayXd fromLeft;
  Eigen::ArrayXd fromRight;

  Eigen::ArrayXd x() const { return (fromLeft - fromRight) / 2; }
};

/// (1 - x)^right (1 + x)^left.
Eigen::ArrayXd edgeWeight(EdgeExponents exponents, const PatchPoints& points);

/// (1 - x)^right (1 + x)^left times a series in the weight's orthonormal polynomials [Pa].
struct EdgeSeries {
  EdgeExponents exponents;
  Eigen::VectorXd coefficients;

  Eigen::ArrayXd at(const PatchPoints& points) const;
  double integral() const;  ///< over x
};

/// Below a jump of the indenter's slope at x0, with z = (x - x0) / (1 - x x0):
///     arccosh(1/|z|) log(x) + sgn(z) arccos|z| step(x) [Pa],
/// both zero at the edges; log and step are series in the orthonormal polynomials of kSmoothEdges.
struct TipTraction {
  double position = 0;  ///< x0
  Eigen::VectorXd log;  ///< no coefficients: there is no tip
  Eigen::VectorXd step;

  bool isThere() const { return log.size() > 0; }
  Eigen::ArrayXd at(const PatchPoints& points) const;
  double integral() const;  ///< over x
};

/// Integrals over x in -1..1 of arccosh(1/|z|) times each of the first `count` polynomials of kSmoothEdges.
Eigen::VectorXd tipMoments(double position, int count);

/// shear = friction * pressure + stuck.
struct PatchTractions {
  Patch patch;
  EdgeSeries smooth;
  TipTraction tip{};
  double friction = 0;
  EdgeSeries stuck{};  ///< no coefficients: nothing sticks
  TipTraction stuckTip{};

  Eigen::ArrayXd pressure_pa(const PatchPoints& points) const;
  Eigen::ArrayXd stuck_pa(const PatchPoints& points) const;
  Eigen::ArrayXd shear_pa(const PatchPoints& points) const;
};

/// A traction vector at an angle: pressure positive when pressing, shear positive towards +theta.
struct Traction {
  double pressure_pa = 0;
  double shear_pa = 0;
};

/// A traction concentrated at an angle, per metre of finger and of surface radius.
struct LineTraction {
  double angle_rad;
  double pressure_pa_rad;
  double shear_pa_rad;
};

/// All tractions of a contact, patches in rising order.
using Tractions = std::vector<PatchTractions>;

/// Exactly zero outside the patches and at their edges (there infinite for what sticks).
Traction tractionAt(const Tractions& tractions, double angle_rad);

/// Line tractions whose Fourier coefficients up to `harmonics` are those of the tractions, to rounding.
std::vector<LineTraction> lineTractions(const Tractions& tractions, int harmonics);

/// Integrals over the surface [Pa rad]; times r_b they are loads per metre of finger.
Traction totalTraction(const Tractions& tractions);

}  // namespace strainfinger::contact
