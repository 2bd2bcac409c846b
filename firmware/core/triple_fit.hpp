#pragma once
// The three-reading fit: offset and two loads from three gauges of a window, exactly.

#include <optional>

#include "firmware/core/triple_step.hpp"
#include "firmware/core/window_fit.hpp"

namespace strainfinger::firmware {

/// tripleSystem() of a triple by its number, in one place.
TripleSystem systemOf(const FitRow& row, std::uint8_t triple, const Projections& projection);

/// Newton steps of the three readings from a fit whose step was taken, until the next one would no longer
/// matter: its projections and length are then theirs. Returns their number in kTripleList; nothing: they
/// lead away from it, or nowhere.
std::optional<std::uint8_t> solveTriple(const FitTable& rows, int mirrorSign, WindowFit& fit);

}  // namespace strainfinger::firmware
