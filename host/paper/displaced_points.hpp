#pragma once
// Points of the rubber and where they go: what figs. 2 and 6 draw.

#include <Eigen/Core>
#include <array>
#include <functional>
#include <span>

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

/// Draws them true to scale, the core to the left: undeformed and deformed positions, a line between;
/// `applied`: what the load or indenter is called.
inline constexpr const char* kDrawDisplacedPoints = R"(
set size ratio -1
set xlabel 'x (m)'; set ylabel 'y (m)'; set xtics 1e-3; set ytics 1e-3
plot data('points') using 3:4:($5 - $3):($6 - $4) every ::1 with vectors nohead linewidth 0.7 linecolor rgb faint notitle, \
     '' using 3:4 every ::1 with points pointtype 7 pointsize 0.25 linecolor rgb lightBlue title 'undeformed', \
     '' using 5:6 every ::1 with points pointtype 7 pointsize 0.35 linecolor rgb blue title 'deformed', \
     NaN with lines linewidth 2 linecolor rgb vermilion title applied
)";

}  // namespace strainfinger::paper
