#pragma once
// The sweeps as pictures, and as a page for the people who use a finger.

#include <string>
#include <vector>

#include "host/bench/error_sweeps.hpp"
#include "host/plot/picture.hpp"

namespace strainfinger::bench {

/// Errors of place and loads over position and load direction, as heat maps.
plot::Picture errorMapPicture(const std::vector<ErrorCell>& cells);

/// Error of place over each of the other quantities, as curves.
plot::Picture errorCurvesPicture(const std::vector<ErrorCell>& cells);

/// Markdown; worst cases first. Figures in mm and N/m.
std::string errorPage(const std::vector<ErrorCell>& cells, const SweepSettings& settings);

}  // namespace strainfinger::bench
