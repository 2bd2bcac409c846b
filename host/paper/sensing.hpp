#pragma once
// What a ring of gauges (e_rr) can tell of a contact: the numbers behind the paper's section 6.

#include "host/model/annulus.hpp"

namespace strainfinger::paper {

/// How a semi-elliptic contact of some width compares with a line load, at the gauges, per peak of the line
/// load's strain.
struct WidthEffect {
  double lowersPeak;      ///< by which the peak is lower
  double differsAtWorst;  ///< largest difference after scaling the one to the other's load (least squares)
};
WidthEffect widthEffect(const model::Annulus<double>& annulus, double radius_m, double width_m);

/// Largest difference between a punch's and a semi-ellipse's strain, equal in load and second moment, per
/// peak.
double kindEffect(const model::Annulus<double>& annulus, double radius_m, double width_m);

/// Share of noise-free contacts (even in the angle within half a pitch of a gauge, and in -1 <= Q/P <= 1)
/// whose readings of the three nearest gauges have another solution there with P > 0 and |Q| <= P.
double ambiguousShare(const model::Annulus<double>& annulus, double radius_m, int gauges);

/// Cramer-Rao bound of a contact's width, relative, at a noise of 1 % of the peak of the line load's strain:
/// median over the phase; normal load only, angle and loads unknown too, all gauges used. `withShear`: at
/// each gauge there is another for e_rt, as noisy.
double widthSigma(const model::Annulus<double>& annulus, double radius_m, int gauges, double width_m,
                  bool withShear = false);

}  // namespace strainfinger::paper
