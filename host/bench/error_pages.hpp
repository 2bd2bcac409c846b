#pragma once
// The sweeps as pictures, and as pages for the people who use a finger and for those who design one.

#include <string>
#include <vector>

#include "host/bench/error_sweeps.hpp"
#include "host/plot/picture.hpp"

namespace strainfinger::bench {

/// Errors of place and loads over position and load direction, as heat maps.
plot::Picture errorMapPicture(const std::vector<ErrorCell>& cells);

/// Error of place over each of the other quantities, as curves.
plot::Picture errorCurvesPicture(const std::vector<ErrorCell>& cells);

/// Markdown: what there is to know in short, worst cases, pictures. Figures in mm and N/m.
std::string errorPage(const std::vector<ErrorCell>& cells, const SweepSettings& settings);

/// Markdown: a table of each sweep, and of the worst places of the map.
std::string errorTables(const std::vector<ErrorCell>& cells, const SweepSettings& settings);

}  // namespace strainfinger::bench
