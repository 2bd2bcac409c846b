#pragma once
// How sharp an indenter is, from the load and the width of its contact.

#include "host/contact/spectral.hpp"

namespace strainfinger::shape {

/// A round indenter of curvature c on the finger takes the load of a flat one times 1 + c r_b at the same
/// width: both have surface slopes proportional to the arc. So load and width give the curvature, layer
/// included, if the indenter is round (Hertz's assumption).
class CurvatureScale {
 public:
  explicit CurvatureScale(const model::Annulus<double>& annulus);
  CurvatureScale(const CurvatureScale&) = delete;  // the solver refers to the kernel
  CurvatureScale& operator=(const CurvatureScale&) = delete;

  /// Load of a flat, frictionless indenter [N/m], to 1e-7 of it up to 12 mm wide on the default finger.
  /// Domain: 0 < width_rad <= 1. Costs 0.1 ms.
  double flatLoad_n_per_m(double width_rad) const;

  /// The indenter's curvature [1/m], 0: flat; below: hollow. Its derivatives to the logarithms of load and
  /// width [1/m].
  struct Curvature {
    double value_per_m;
    double toLogLoad_per_m;
    double toLogWidth_per_m;
  };
  Curvature of(double load_n_per_m, double width_rad) const;

 private:
  contact::SurfaceKernel kernel_;
  contact::SpectralSolver solver_;
};

}  // namespace strainfinger::shape
