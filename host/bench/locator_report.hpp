#pragma once
// The results as a table to read, a table to compute with, and a picture.

#include <cstdio>
#include <string>
#include <vector>

#include "host/bench/locator_results.hpp"
#include "host/plot/picture.hpp"

namespace strainfinger::bench {

/// Markdown: one row a method.
std::string locatorMarkdown(const std::vector<MethodResult>& results, const Counts& counts);

/// How many times ours the cheapest method costs that is at least as good: one sentence for lines and one for
/// touches of any width; empty when nothing was counted.
std::string locatorVerdict(const std::vector<MethodResult>& results, const Counts& counts);

/// CSV: one row a method and level. Columns that end in _counted and were not are empty.
void writeLocatorCsv(std::FILE* stream, const std::vector<MethodResult>& results, const Counts& counts);

/// Error over instructions on a Cortex-M4, a panel for each level with noise and below it a close-up of what
/// lies around the best of ours; time on this machine when nothing was counted.
plot::Picture locatorPicture(const std::vector<MethodResult>& results, const Counts& counts);

}  // namespace strainfinger::bench
