#pragma once
// What a survey found, as tables and as a picture.

#include <string>

#include "host/plot/picture.hpp"
#include "tests/stability/survey.hpp"

namespace strainfinger::stability {

/// The bar: where the conditioning allows, no error is above.
inline constexpr double kBar = 1e-13;

/// Contacts: an answer that is further from the indenter, per depth, has to say so.
inline constexpr double kContactBar = 1e-6;

/// CSV, a row a region: its bounds, samples, counts, the worst error of each row of the model.
std::string harmonicTable(const std::vector<HarmonicRegion>& regions);
std::string fieldTable(const std::vector<FieldRegion>& regions);
std::string contactTable(const std::vector<ContactRegion>& regions);

struct Surveys {
  std::vector<HarmonicRegion> harmonics;
  std::vector<FieldRegion> fields;
  std::vector<ContactRegion> contacts;
};

/// Markdown: worst of all samples by alpha and harmonic, by place and Poisson's ratio, by alpha and depth, by
/// alpha and width; of contacts by alpha and width, with what they warn of apart.
std::string summary(const Surveys& surveys);

/// Heat maps of the same.
plot::Picture heatMaps(const Surveys& surveys);

/// Whether all errors are below the bar and everything is finite.
template <typename Region>
bool holds(const std::vector<Region>& regions) {
  for (const Region& region : regions)
    if (!(region.worst.largest() <= kBar) || region.worst.notFinite > 0) return false;
  return !regions.empty();
}

/// NaNs and infinities that were found, of all surveys.
int countNotFinite(const Surveys& surveys);

/// Whether every contact is finite and either fits or says that it doesn't.
bool holds(const std::vector<ContactRegion>& regions);

}  // namespace strainfinger::stability
