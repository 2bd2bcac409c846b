#pragma once
// Tractions as Fourier series: what the paper's method finds, and what fields inside the rubber are made of.

#include <Eigen/Core>

#include "host/contact/surface_motion.hpp"
#include "host/contact/tractions.hpp"
#include "host/model/annulus.hpp"

namespace strainfinger::contact {

/// Row n: factors of cos n theta and sin n theta of the pressure (positive when pressing), then of the shear
/// (positive towards +theta) [Pa].
using FourierTractions = Eigen::MatrixX4d;

/// Coefficients 0..harmonics. Error: 1e-15 of the largest. Costs 4 ns a harmonic and node, of which there are
/// 24 and more, 0.75 per harmonic and radian of half width.
FourierTractions fourierTractions(const Tractions& tractions, int harmonics);

Traction tractionAt(const FourierTractions& tractions, double angle_rad);

/// The surface under them, by as many harmonics.
SurfacePoint surfaceAt(const model::Annulus<double>& annulus, const FourierTractions& tractions,
                       double angle_rad);

}  // namespace strainfinger::contact
