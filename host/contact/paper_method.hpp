#pragma once
// The paper's own way to a contact's tractions: the pseudo-inverse of T C, cut off at small singular values.

#include "host/contact/contact.hpp"
#include "host/contact/slope_map.hpp"

namespace strainfinger::contact {

struct PaperOptions {
  int harmonics = 300;  ///< n_c
  double cutoff = 0.1;  ///< singular values below this times the largest are left out
  SlopeRows rows = SlopeRows::kPrinted;
  WindowCut window = WindowCut::kHalf;
};

/// What the paper's method makes of a contact of given width centred on the indenter's normal.
struct PaperContact {
  FourierTractions tractions;  ///< not zero outside the contact: the window is cut
  int kept = 0;                ///< singular values
  int keptEven = 0;            ///< of them those whose pressure is even
  double normal_n_per_m = 0;   ///< all around, what leaks out of the contact included
  double depth_m = 0;          ///< at the centre
  double residual_m = 0;       ///< worst distance from the indenter's shape, from its mean over the contact
};

/// Frictionless: the pressure's columns only (with the shear's too, the least answer has shear of 2.6 % of
/// the peak pressure at a cut-off of 0.1 and of 99 % at 0.001). Against SpectralSolver at 2 mm, n_c = 300: a
/// load 19 % low and an error of 0.41 of the peak at a cut-off of 0.1; at best 0.1 of the peak. Halves with
/// twice the harmonics: the pressure's edge is a square root. Domain: as SlopeMap, 0 <= cutoff < 1. Throws
/// Failure(kUsage) outside it. Costs 100 ms for 300 harmonics.
PaperContact solveByPaper(const model::Annulus<double>& annulus, const Indenter& indenter, double width_m,
                          const PaperOptions& options);

/// What that is off by, against the contact of the same width by SpectralSolver, per `scale_pa`.
struct PaperErrors {
  double scale_pa = 0;     ///< its pressure at the centre; its mean pressure where that is infinite (a wedge)
  double inside = 0;       ///< worst of the pressure within the contact, where that is finite
  double centre = 0;       ///< of the pressure at the centre, absolute; infinite where that is
  double load = 0;         ///< of the normal load, relative
  double outside = 0;      ///< largest pressure outside, from 0.65 % of a half width beyond the edges on
  double leakedShare = 0;  ///< of the integral of the pressure's square: what is outside
};

/// `exact` is centred on the indenter's normal. Costs 10 ms for 300 harmonics.
PaperErrors errorsOf(const PaperContact& contact, const Contact& exact);

}  // namespace strainfinger::contact
