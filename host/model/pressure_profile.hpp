#pragma once
// Shapes that a pressure may have, all by the one number that gauges see of them best: the second moment.

#include <span>

namespace strainfinger::model {

/// Pressures that are even about their centre, of half width h: in t = x / h
enum class Profile {
  kEllipse,  ///< sqrt(1 - t^2): Hertz's, of round and flat indenters
  kUniform,  ///< 1: of a fluid behind a membrane
  kWedge,    ///< arccosh(1 / |t|): of a blade's edge
  kPunch,    ///< 1 / sqrt(1 - t^2): of a flat end with corners
};

std::span<const Profile> allProfiles();

/// "round", "uniform", "wedge", "punch".
const char* nameOf(Profile profile);

/// The half width [rad] of a profile with this second moment about its centre [rad^2], at least 0.
double halfWidth_rad(Profile profile, double moment_rad2);

/// The other way around: the second moment [rad^2] of a profile of this width [rad].
double momentOf(Profile profile, double width_rad);

/// The second moment [rad^2] of the semi-ellipse of this width [rad]: what an equivalent width stands for.
constexpr double momentOfWidth(double width_rad) { return width_rad * width_rad / 16; }

/// The semi-ellipse's width of a moment; of a moment below 0: 0.
double equivalentWidth_rad(double moment_rad2);

/// The uniform pressure's width of a moment, which is w^2 / 12; of a moment below 0: 0.
double uniformWidth_rad(double moment_rad2);

/// What harmonic n of a line load is multiplied by when the load is spread, and its derivative to the moment.
struct SpreadFactor {
  double value;
  double slope;  ///< [1/rad^2]
};

/// A function of n^2 moment, analytic at 0 and continued below it, where no pressure is: there it rises like
/// exp(2 n sqrt(-moment)) for the ellipse. So a fit of a line load's strains may end on either side of 0.
/// Domain: n >= 0, moment a number. Error: 1e-14 of the larger of value and 1. Costs 0.04 us up to n h = 6,
/// 0.2 us beyond.
SpreadFactor spreadFactor(Profile profile, int n, double moment_rad2);

/// Density [1/rad] of a load of 1 at a distance from the centre: 0 outside, infinite where the profile is.
/// Domain: moment > 0.
double density(Profile profile, double moment_rad2, double offset_rad);

}  // namespace strainfinger::model
