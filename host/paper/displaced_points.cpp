#include "host/paper/displaced_points.hpp"

#include <cmath>
#include <vector>

namespace strainfinger::paper {
namespace {

constexpr double kReach_rad = 0.3;
constexpr int kArcs = 6, kPointsEachSide = 40;

std::vector<double> pointRow(double r, double angle, double ur, double ut) {
  const double c = std::cos(angle), s = std::sin(angle);
  return {r, angle, r * c, r * s, (r + ur) * c - ut * s, (r + ur) * s + ut * c};
}

}  // namespace

plot::DataFile displacedPoints(const model::Annulus<double>& annulus, const Displacements& displacements) {
  std::vector<double> angles_rad;
  for (int i = -kPointsEachSide; i <= kPointsEachSide; ++i)
    angles_rad.push_back(i * kReach_rad / kPointsEachSide);
  plot::DataFile data{"points", {"radius_m", "angle_rad", "x_m", "y_m", "deformed_x_m", "deformed_y_m"}, {}};
  const double rubber_m = annulus.outer_radius_m - annulus.core_radius_m;
  for (int arc = 0; arc < kArcs; ++arc) {
    const double inner_m =
        arc == kArcs - 1 ? annulus.core_radius_m : annulus.outer_radius_m - rubber_m * arc / (kArcs - 1.0);
    const Eigen::MatrixXd field = displacements(inner_m, angles_rad);
    for (std::size_t i = 0; i < angles_rad.size(); ++i) {
      const auto k = static_cast<Eigen::Index>(i);
      data.rows.push_back(pointRow(inner_m, angles_rad[i], field(k, 0), field(k, 1)));
    }
  }
  return data;
}

}  // namespace strainfinger::paper
