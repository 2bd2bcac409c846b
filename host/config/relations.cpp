// What has to hold between the keys of finger.toml.

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <vector>

#include "host/base/angles.hpp"
#include "host/config/bus_load.hpp"
#include "host/config/keys.hpp"

namespace strainfinger::config {
namespace {

using Config = const FingerConfig&;

/// Gaps between neighbours, over that of an even ring. Gauges that are nearer tell the same twice; in a gap
/// that is wider a touch is nearly out of sight.
constexpr double kLeastGap = 0.5, kMostGap = 2;

double contactLoad_bps(const Can& can) { return can.contact_rate_hz * kFramesPerContact * kWorstFrame_bits; }

std::vector<double> gaps_deg(const Gauges& gauges) {
  std::vector<double> gaps(static_cast<std::size_t>(gauges.count));
  for (int gauge = 0; gauge < gauges.count; ++gauge)
    gaps[static_cast<std::size_t>(gauge)] = gauges.gap_deg(gauge);
  return gaps;
}

/// Arc between the two gauges that are nearest each other.
double leastPitchArc_m(const Gauges& gauges) {
  const auto gaps = gaps_deg(gauges);
  return *std::min_element(gaps.begin(), gaps.end()) * kRadPerDeg * gauges.radius_m;
}

/// The first gap, from which gauge on, that is not such as kLeastGap and kMostGap allow; none: the count.
int wrongGap(const Gauges& gauges) {
  const auto gaps = gaps_deg(gauges);
  const double even_deg = 360.0 / gauges.count;
  const auto wrong = std::ranges::find_if_not(
      gaps, [&](double gap) { return gap >= kLeastGap * even_deg && gap <= kMostGap * even_deg; });
  return static_cast<int>(wrong - gaps.begin());
}

/// Whether all gaps are allowed and go round the ring once.
bool isRing(const Gauges& gauges) {
  const auto gaps = gaps_deg(gauges);
  return wrongGap(gauges) == gauges.count && std::accumulate(gaps.begin(), gaps.end(), 0.0) < 1.5 * 360;
}

std::string wrongGapText(const Gauges& gauges) {
  const int from = wrongGap(gauges);
  if (from == gauges.count) return "they go round more than once";
  const int to = (from + 1) % gauges.count;
  return fmt::format("from gauge {} to gauge {}, from {} to {}, it is {:.6g}", from, to,
                     gauges.angle_deg(from), gauges.angle_deg(to), gauges.gap_deg(from));
}

template <typename List>
Relation onePerGauge(const char* key, List listOf) {
  return {[=](Config c) {
            return listOf(c).empty() || listOf(c).size() == static_cast<std::size_t>(c.gauges.count);
          },
          {key, "gauges.count"},
          [=](Config c) {
            return fmt::format("{} has {} numbers; it must have one a gauge, gauges.count = {}", key,
                               listOf(c).size(), c.gauges.count);
          }};
}

Relation coreInsideSurface() {
  return {[](Config c) { return c.finger.core_radius_m < c.finger.outer_radius_m; },
          {"finger.core_radius_m", "finger.outer_radius_m"},
          [](Config c) {
            return fmt::format("finger.core_radius_m = {} must be less than finger.outer_radius_m = {}",
                               c.finger.core_radius_m, c.finger.outer_radius_m);
          }};
}

Relation gaugesInRubber() {
  return {[](Config c) {
            return c.finger.core_radius_m <= c.gauges.radius_m && c.gauges.radius_m < c.finger.outer_radius_m;
          },
          {"gauges.radius_m", "finger.core_radius_m", "finger.outer_radius_m"},
          [](Config c) {
            return fmt::format(
                "gauges.radius_m = {} is outside the rubber: it must be at least finger.core_radius_m = {}, "
                "less than finger.outer_radius_m = {}",
                c.gauges.radius_m, c.finger.core_radius_m, c.finger.outer_radius_m);
          }};
}

Relation gaugesAroundTheRing() {
  return {[](Config c) { return isRing(c.gauges); },
          {"gauges.angle_deg", "gauges.count"},
          [](Config c) {
            const double even_deg = 360.0 / c.gauges.count;
            return fmt::format(
                "gauges.angle_deg = [{}] is no ring: the angles must ascend, once round, each {} to {} from "
                "the one before (gauges.count = {}); {}",
                fmt::join(c.gauges.angles_deg, ", "), kLeastGap * even_deg, kMostGap * even_deg,
                c.gauges.count, wrongGapText(c.gauges));
          }};
}

Relation oneSourceOfAngles() {
  return {[](Config c) { return c.gauges.isEven() || c.gauges.first_angle_deg == 0; },
          {"gauges.first_angle_deg", "gauges.angle_deg"},
          [](Config c) {
            return fmt::format(
                "gauges.first_angle_deg = {}: gauges.angle_deg says where each gauge is; leave one of them "
                "out",
                c.gauges.first_angle_deg);
          }};
}

Relation gaugesDontOverlap() {
  return {[](Config c) { return c.gauges.arc_length_m <= leastPitchArc_m(c.gauges); },
          {"gauges.arc_length_m", "gauges.count", "gauges.radius_m", "gauges.angle_deg"},
          [](Config c) {
            return fmt::format(
                "gauges.arc_length_m = {}: neighbours overlap; it must be at most the pitch {} that "
                "gauges.count = {} and gauges.radius_m = {} leave",
                c.gauges.arc_length_m, leastPitchArc_m(c.gauges), c.gauges.count, c.gauges.radius_m);
          }};
}

Relation noiseCoversQuantisation() {
  return {[](Config c) { return c.gauges.noise_strain >= c.gauges.quantisation_strain(); },
          {"gauges.noise_strain", "gauges.adc_bits", "gauges.full_scale_strain"},
          [](Config c) {
            return fmt::format(
                "gauges.noise_strain = {} is less than the quantisation alone, {:.3g}, that gauges.adc_bits "
                "= {} over +-gauges.full_scale_strain = {} leaves; use more bits, a smaller full scale or "
                "more noise",
                c.gauges.noise_strain, c.gauges.quantisation_strain(), c.gauges.adc_bits,
                c.gauges.full_scale_strain);
          }};
}

Relation widthsOnTheFinger() {
  return {[](Config c) { return c.contact.largest_width_m <= c.finger.outer_radius_m; },
          {"contact.largest_width_m", "finger.outer_radius_m"},
          [](Config c) {
            return fmt::format("contact.largest_width_m = {} must be at most finger.outer_radius_m = {}",
                               c.contact.largest_width_m, c.finger.outer_radius_m);
          }};
}

Relation widthCovered() {
  return {[](Config c) { return c.contact.width_m.value_or(0) <= c.contact.largest_width_m; },
          {"contact.width_m", "contact.largest_width_m"},
          [](Config c) {
            return fmt::format("contact.width_m = {} must be at most contact.largest_width_m = {}",
                               c.contact.width_m.value_or(0), c.contact.largest_width_m);
          }};
}

Relation contactsFitOnTheBus() {
  return {[](Config c) { return contactLoad_bps(c.can) <= c.can.bitrate; },
          {"can.contact_rate_hz", "can.bitrate"},
          [](Config c) {
            return fmt::format(
                "can.contact_rate_hz = {} needs up to {} bit/s, more than can.bitrate = {}; it must be at "
                "most {}",
                c.can.contact_rate_hz, contactLoad_bps(c.can), c.can.bitrate, fastestContactRate_hz(c.can));
          }};
}

/// The first gauge that calibration puts outside the rubber, or the count.
int gaugeOutsideRubber(Config c) {
  int gauge = 0;
  while (gauge < c.gauges.count && c.calibrated(gauge).radius_m >= c.finger.core_radius_m &&
         c.calibrated(gauge).radius_m < c.finger.outer_radius_m)
    ++gauge;
  return gauge;
}

Relation calibratedGaugesInRubber() {
  return {[](Config c) { return gaugeOutsideRubber(c) == c.gauges.count; },
          {"calibration.depth_offset_m"},
          [](Config c) {
            const int gauge = gaugeOutsideRubber(c);
            return fmt::format(
                "calibration.depth_offset_m[{}] = {} puts the gauge outside the rubber: gauges.radius_m less "
                "it must be at least finger.core_radius_m = {}, less than finger.outer_radius_m = {}",
                gauge, c.calibration.depth_offset_m[static_cast<std::size_t>(gauge)], c.finger.core_radius_m,
                c.finger.outer_radius_m);
          }};
}

Relation builtCoreBelowGauges() {
  return {[](Config c) {
            const double core_m = c.finger.core_radius_m + c.as_built.core_radius_m;
            return core_m > 0 && core_m <= c.gauges.radius_m;
          },
          {"as_built.core_radius_m", "finger.core_radius_m", "gauges.radius_m"},
          [](Config c) {
            return fmt::format(
                "as_built.core_radius_m = {}: with finger.core_radius_m = {} it must be greater than 0, at "
                "most gauges.radius_m = {}",
                c.as_built.core_radius_m, c.finger.core_radius_m, c.gauges.radius_m);
          }};
}

Relation builtRubberPossible() {
  return {[](Config c) {
            const double ratio = c.finger.poisson_ratio + c.as_built.poisson_ratio;
            return ratio >= 0 && ratio <= 0.5;
          },
          {"as_built.poisson_ratio", "finger.poisson_ratio"},
          [](Config c) {
            return fmt::format(
                "as_built.poisson_ratio = {}: with finger.poisson_ratio = {} it must be 0 to 0.5",
                c.as_built.poisson_ratio, c.finger.poisson_ratio);
          }};
}

Relation builtRubberStiff() {
  return {[](Config c) { return c.finger.shear_modulus_pa + c.as_built.shear_modulus_pa > 0; },
          {"as_built.shear_modulus_pa", "finger.shear_modulus_pa"},
          [](Config c) {
            return fmt::format(
                "as_built.shear_modulus_pa = {}: with finger.shear_modulus_pa = {} it must be greater than 0",
                c.as_built.shear_modulus_pa, c.finger.shear_modulus_pa);
          }};
}

std::vector<Relation> makeRelations() {
  return {
      coreInsideSurface(),
      gaugesInRubber(),
      onePerGauge("gauges.angle_deg", [](Config c) { return c.gauges.angles_deg; }),
      gaugesAroundTheRing(),
      oneSourceOfAngles(),
      gaugesDontOverlap(),
      noiseCoversQuantisation(),
      widthsOnTheFinger(),
      widthCovered(),
      contactsFitOnTheBus(),
      onePerGauge("calibration.gain", [](Config c) { return c.calibration.gain; }),
      onePerGauge("calibration.angle_offset_deg", [](Config c) { return c.calibration.angle_offset_deg; }),
      onePerGauge("calibration.depth_offset_m", [](Config c) { return c.calibration.depth_offset_m; }),
      calibratedGaugesInRubber(),
      builtCoreBelowGauges(),
      builtRubberPossible(),
      builtRubberStiff()};
}

}  // namespace

std::span<const Relation> relations() {
  static const std::vector<Relation> table = makeRelations();
  return table;
}

}  // namespace strainfinger::config
