// What a user is told of a finger that cannot be located with.

#include <fmt/format.h>

#include <numbers>
#include <string>

#include "firmware/core/judge.hpp"
#include "host/base/failure.hpp"
#include "host/tables/self_check.hpp"

namespace strainfinger::tables {
namespace {

constexpr double kMostUncertain = 0.5;  ///< of the contacts

/// Gauges shallower than this part of their spacing see a contact too sharply for the next one to see it too;
/// deeper ones see it too broadly.
constexpr double kSuitableDepth = 0.8;

/// Contacts narrower than this part of the gauges' depth are hardly told from lines: on the default ring
/// tables that cover 0.15 of it can be worked with, those that cover 0.06 cannot.
constexpr double kTellableWidth = 0.1;

std::string adviceFor(const TableParameters& p, double depth_m, double pitch_m) {
  if (depth_m >= kSuitableDepth * pitch_m)
    return "too deep for their spacing; use shallower gauges (a larger gauges.radius_m) or fewer";
  std::string advice =
      "too shallow for their spacing; use more gauges, or deeper ones (a smaller gauges.radius_m, and if "
      "need be finger.core_radius_m)";
  if (p.component == StrainComponent::kShear) advice += ", or gauges.component = \"radial\"";
  return advice;
}

std::string figuresOf(const TableParameters& p) {
  const double depth_m = p.outer_radius_m - p.gauge_radius_m;
  if (p.contact_width_m < 0 && p.largest_width_m < kTellableWidth * depth_m)
    return fmt::format(
        "at {:.3g} m below the surface the gauges hardly tell whether a contact is wider than "
        "contact.largest_width_m = {}: make that larger, or say how wide contacts are (contact.width_m)",
        depth_m, p.largest_width_m);
  const double pitch_m = 2 * std::numbers::pi * p.outer_radius_m / p.gauge_count;
  return fmt::format(
      "the gauges lie {:.3g} m below the surface (gauges.radius_m = {}), where they are {:.3g} m apart "
      "(gauges.count = {}): {}",
      depth_m, p.gauge_radius_m, pitch_m, p.gauge_count, adviceFor(p, depth_m, pitch_m));
}

[[noreturn]] void refuse(const TableImage& image, const std::string& reason) {
  throw Failure(ExitCode::kUsage, fmt::format("contacts cannot be located with these gauges: {};\n{}", reason,
                                              figuresOf(image.parameters)));
}

/// Wherever the gauges are, and however many.
[[noreturn]] void refuseNoise(const TableParameters& p, const std::string& reason) {
  throw Failure(ExitCode::kUsage,
                fmt::format("contacts cannot be located with this noise: {}; gauges.noise_strain = {} is too "
                            "large for gauges.full_scale_strain = {}",
                            reason, p.noise_strain, p.full_scale_strain));
}

/// The weaker contacts that are tried are too near the noise to be sure of, whatever the ring.
bool areWeakOnesFaint(const TableParameters& p) {
  const double reading_strain = SelfCheck::kWeakerLoad / 2 * p.full_scale_strain;
  return reading_strain * reading_strain < firmware::threshold::kWeakSignal * p.noise_strain * p.noise_strain;
}

std::string placeOf(const TableParameters& p, const Misplaced& m) {
  const double pitch_deg = 360.0 / p.gauge_count;
  return fmt::format(
      "a contact of {:.3g} N/m normal load and {:.3g} times that tangential load, {:.3g} m wide and {:.3g} "
      "deg from a gauge, is located {:.3g} deg from its place without a flag ({} fit)",
      m.load_n_per_m, m.direction, m.width_m, m.offset_pitch * pitch_deg, m.error_pitch * pitch_deg,
      m.mode == firmware::FitMode::kRefined ? "refined" : "three-point");
}

}  // namespace

void requireLocatable(const TableImage& image, const SelfCheck& check) {
  if (check.misplaced) refuse(image, placeOf(image.parameters, *check.misplaced));
  if (!(check.detected_n_per_m <= check.halfScale_n_per_m))
    refuseNoise(
        image.parameters,
        fmt::format(
            "where the gauges read least, noise hides contacts of up to {:.3g} N/m, more than half of "
            "full scale ({:.3g} N/m)",
            check.detected_n_per_m, check.halfScale_n_per_m));
  if (check.uncertain <= kMostUncertain * check.contacts) return;
  const std::string reason =
      fmt::format("{} of {} contacts have no certain answer", check.uncertain, check.contacts);
  if (areWeakOnesFaint(image.parameters))
    refuseNoise(image.parameters, fmt::format("{}, as those of {:.3g} N/m are too near it", reason,
                                              SelfCheck::kWeakerLoad * check.halfScale_n_per_m));
  refuse(image, reason);
}

}  // namespace strainfinger::tables
