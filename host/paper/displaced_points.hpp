#pragma once
// Points of the rubber and where they go: what figs. 2 and 6 draw.

#include <Eigen/Core>
#include <array>
#include <functional>
#include <span>
#include <string>

#include "host/model/harmonic.hpp"
#include "host/plot/picture.hpp"

namespace strainfinger::paper {

/// Columns of what a Displacements gives.
inline constexpr std::array kDisplacements{model::kUr, model::kUt};

/// Displacements [m] at a radius, one row an angle.
using Displacements = std::function<Eigen::MatrixXd(double radius_m, std::span<const double> angles_rad)>;

/// Six arcs from the surface to the core, 0.3 rad to either side of angle 0, as (r, angle, x, y) and where
/// (x, y) goes; a data file named "points".
plot::DataFile displacedPoints(const model::Annulus<double>& annulus, const Displacements& displacements);

/// gnuplot's commands that draw them true to scale, the core to the left: undeformed and deformed positions,
/// a line between; `applied`, a variable of gnuplot's: what the load or indenter is called.
std::string drawDisplacedPoints(const model::Annulus<double>& annulus);

}  // namespace strainfinger::paper
