#pragma once
// The three-reading fit: offset and two loads from three gauges of a window, exactly.

#include "firmware/core/triple_step.hpp"
#include "firmware/core/window_fit.hpp"

namespace strainfinger::firmware {

/// The system of a row's best triple at given projections, whose second has the sign of the tangential load.
struct TripleChoice {
  GaugeTriple gauges;
  TripleSystem system;
};
TripleChoice tripleChoice(const FitRow& row, const Projections& projection);

/// Newton steps of the three readings from a fit whose step was taken, until the next one would no longer
/// matter: its projections and length are then theirs. False: they lead away from it, or nowhere.
bool solveTriple(const FitTable& rows, int mirrorSign, WindowFit& fit);

}  // namespace strainfinger::firmware
