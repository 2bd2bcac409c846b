#pragma once
// What a survey found, as tables and as a picture.

#include <string>

#include "host/plot/picture.hpp"
#include "tests/stability/survey.hpp"

namespace strainfinger::stability {

/// The bar: where the conditioning allows, no error is above.
inline constexpr double kBar = 1e-13;

/// CSV, a row a region: its bounds, samples, counts, the worst error of each row of the model.
std::string harmonicTable(const std::vector<HarmonicRegion>& regions);
std::string fieldTable(const std::vector<FieldRegion>& regions);

/// Markdown: worst of all samples by alpha and harmonic, by place and Poisson's ratio, by alpha and depth, by
/// alpha and width.
std::string summary(const std::vector<HarmonicRegion>& harmonics, const std::vector<FieldRegion>& fields);

/// Heat maps of the same.
plot::Picture heatMaps(const std::vector<HarmonicRegion>& harmonics, const std::vector<FieldRegion>& fields);

/// Whether all errors are below the bar and everything is finite.
template <typename Region>
bool holds(const std::vector<Region>& regions) {
  for (const Region& region : regions)
    if (!(region.worst.largest() <= kBar) || region.worst.notFinite > 0) return false;
  return !regions.empty();
}

}  // namespace strainfinger::stability
