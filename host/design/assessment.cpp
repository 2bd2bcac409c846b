#include "host/design/assessment.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

#include "common/table_image.hpp"
#include "host/base/failure.hpp"
#include "host/base/quantile.hpp"
#include "host/config/keys.hpp"
#include "host/config/over_range.hpp"
#include "host/config/ring_spacing.hpp"
#include "host/evidence/bound.hpp"
#include "host/tables/readings.hpp"
#include "host/tables/self_check.hpp"
#include "host/tables/table_builder.hpp"

namespace strainfinger::design {
namespace {

/// Places within one pitch, for what the firmware makes of touches there; an even ring has no others.
constexpr int kPlaces = 32;
/// The same for bounds, whose largest value may be within half a degree.
constexpr int kBoundPlaces = 256;
/// A finger that flags a touch at more places than not is none for it.
constexpr double kLeastCertain = 0.5;
/// Of contact.largest_width_m: the answer to a wider touch may be at the end of the tables.
constexpr double kNearlyWidest = 0.98;

config::FingerConfig asDrawn(config::FingerConfig config) {
  config.calibration = {};
  config.as_built = {};
  config.gauges.angles_deg = {};
  return config;
}

double placeOf(const config::FingerConfig& config, int place, int places) {
  return config.gauges.angle_rad(0) + 2 * std::numbers::pi / config.gauges.count * place / places;
}

Bound boundOf(const std::vector<double>& values) { return {medianOf(values), std::ranges::max(values)}; }

Bounds boundsOf(const config::FingerConfig& config, simulation::Touch touch) {
  const evidence::FitModel model(config);
  const bool isFitted = !config.contact.width_m;
  const double halfPitch_m = std::numbers::pi * config.finger.outer_radius_m / config.gauges.count;
  std::vector<double> arcs_m, normals, tangentials, widths_m;
  int identifiable = 0;
  double largest_strain = 0;
  for (int i = 0; i < kBoundPlaces; ++i) {
    touch.angle_rad = placeOf(config, i, kBoundPlaces);
    const evidence::FittedContact contact = model.describe(touch);
    const evidence::Parameters sigma =
        cramerRaoBound(model, contact, isFitted ? evidence::kWidthUnknown : evidence::kWidthKnown,
                       config.gauges.noise_strain);
    arcs_m.push_back(sigma[evidence::kAngle] * config.finger.outer_radius_m);
    normals.push_back(sigma[evidence::kNormal]);
    tangentials.push_back(sigma[evidence::kTangential]);
    identifiable += arcs_m.back() < halfPitch_m && normals.back() < touch.normal_n_per_m ? 1 : 0;
    largest_strain = std::max(largest_strain, model.readings({&contact, 1}).cwiseAbs().maxCoeff());
    if (contact.load.moment_rad2 > 0)
      widths_m.push_back(model.uniformWidthSigma_m(contact.load.moment_rad2, sigma[evidence::kMoment]));
  }
  Bounds bounds{boundOf(arcs_m),
                boundOf(normals),
                boundOf(tangentials),
                {},
                static_cast<double>(identifiable) / kBoundPlaces,
                largest_strain};
  if (isFitted && !widths_m.empty()) bounds.width_m = boundOf(widths_m);
  return bounds;
}

/// The first thing that is wrong with the config, or nothing.
std::string violationOf(const config::FingerConfig& config) {
  const config::Domain& counts = config::keyOf("gauges.count").domain;
  if (!counts.contains(config.gauges.count))
    return fmt::format("gauges.count = {} must be {}", config.gauges.count, counts.text());
  for (const config::Relation& relation : config::relations())
    if (!relation.holds(config)) return relation.violation(config);
  return {};
}

double certainShare(const config::FingerConfig& config, simulation::Touch touch, const TableImage& image) {
  const evidence::FitModel model(config);
  int certain = 0;
  for (int i = 0; i < kPlaces; ++i) {
    touch.angle_rad = placeOf(config, i, kPlaces);
    const evidence::FittedContact contact = model.describe(touch);
    std::vector<std::int32_t> readings_q32;
    for (const double strain : model.readings({&contact, 1}))
      readings_q32.push_back(tables::readingOf(image.constants, strain));
    certain += tables::locateAlone(image, readings_q32, firmware::FitMode::kRefined).isCertain ? 1 : 0;
  }
  return static_cast<double>(certain) / kPlaces;
}

/// Of a finger that the firmware can work with: why it is none for this touch, or nothing.
std::string shortcomingOf(const config::FingerConfig& config, const simulation::Touch& touch,
                          const Bounds& bounds, const Trial& trial) {
  if (config::isOverRange(config.gauges, bounds.largest_strain))
    return fmt::format(
        "a gauge reads a strain of up to {:.3g} under this touch, too near the end of "
        "gauges.full_scale_strain = {}: use a "
        "larger full scale or deeper gauges",
        bounds.largest_strain, config.gauges.full_scale_strain);
  if (touch.normal_n_per_m < trial.detected_n_per_m)
    return fmt::format("a touch of {:.3g} N/m may go unnoticed: the gate opens anywhere from {:.3g} N/m on",
                       touch.normal_n_per_m, trial.detected_n_per_m);
  if (bounds.identifiableShare < 1)
    return fmt::format("at {:.0f} % of the places the readings don't determine the touch",
                       100 * (1 - bounds.identifiableShare));
  if (trial.certainShare < kLeastCertain && !config.contact.width_m &&
      touch.width_m > kNearlyWidest * config.contact.largest_width_m)
    return fmt::format(
        "at {:.0f} % of the places the firmware flags this touch as uncertain, because it is as wide as the "
        "tables cover: a larger contact.largest_width_m than {} is needed",
        100 * (1 - trial.certainShare), config.contact.largest_width_m);
  if (trial.certainShare < kLeastCertain)
    return fmt::format(
        "at {:.0f} % of the places the firmware flags this touch as uncertain, even without noise",
        100 * (1 - trial.certainShare));
  if (config::isSparse(config))
    return fmt::format(
        "at the surface the gauges are up to {:.4g} times their depth apart, more than {}: the "
        "standard errors are too small between gauges; use more gauges, or deeper ones",
        config::widestGapInDepths(config), config::kSparse);
  return {};
}

}  // namespace

Assessment assess(const config::FingerConfig& finger, const simulation::Touch& touch) {
  const config::FingerConfig config = asDrawn(finger);
  Assessment found;
  found.problem = violationOf(config);
  try {
    found.bounds = boundsOf(config, touch);
    if (!found.problem.empty()) return found;
    const TableImage image = tables::buildTableImage(config);
    const tables::SelfCheck check = tables::selfCheck(image);
    found.trial = Trial{sizeof(TableImage), certainShare(config, touch, image), check.detected_n_per_m,
                        2 * check.halfScale_n_per_m};
    tables::requireLocatable(image, check);
    found.problem = shortcomingOf(config, touch, *found.bounds, *found.trial);
  } catch (const Failure& failure) {
    if (found.problem.empty()) found.problem = failure.what();
    std::ranges::replace(found.problem, '\n', ' ');
  }
  return found;
}

}  // namespace strainfinger::design
