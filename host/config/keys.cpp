#include "host/config/keys.hpp"

#include <fmt/format.h>

#include <numbers>
#include <vector>

#include "common/commands.hpp"

namespace strainfinger::config {
namespace {

/// Bits on the bus of an 8-byte frame with an 11-bit identifier, stuffed at worst: 8 n + 44 fixed bits, 3 of
/// interframe space, a stuff bit for every 4 of the 34 + 8 n - 1 that are subject to it.
constexpr int kWorstFrame_bits = 8 * 8 + 44 + 3 + (34 + 8 * 8 - 1) / 4;
constexpr int kFramesPerContact = 2;

template <auto Section, auto Member>
constexpr auto slot() {
  return +[](FingerConfig & config) -> auto& { return (config.*Section).*Member; };
}

std::vector<Key> makeKeys() {
  using F = FingerConfig;
  return {
      {"finger", "core_radius_m", slot<&F::finger, &Finger::core_radius_m>(), Domain::above(0, 1),
       "radius of the rigid core"},
      {"finger", "outer_radius_m", slot<&F::finger, &Finger::outer_radius_m>(), Domain::above(0, 1),
       "radius of the rubber's surface, greater than core_radius_m"},
      {"finger", "length_m", slot<&F::finger, &Finger::length_m>(), Domain::above(0, 1),
       "length of the contact line along the finger; turns N/m into N"},
      {"finger", "shear_modulus_pa", slot<&F::finger, &Finger::shear_modulus_pa>(), Domain::above(0, 1e12),
       "shear modulus of the rubber"},
      {"finger", "poisson_ratio", slot<&F::finger, &Finger::poisson_ratio>(), Domain::between(0, 0.5),
       "Poisson's ratio of the rubber; 0.5: incompressible"},
      {"gauges", "count", slot<&F::gauges, &Gauges::count>(), Domain::evenBetween(kMinGauges, kMaxGauges),
       "gauges in the ring, evenly spaced"},
      {"gauges", "radius_m", slot<&F::gauges, &Gauges::radius_m>(), Domain::above(0, 1),
       "where the gauges are: in the rubber, core_radius_m <= radius_m < outer_radius_m"},
      {"gauges", "component", slot<&F::gauges, &Gauges::component>(),
       Domain::between(0, static_cast<double>(kComponentNames.size() - 1)), "the strain the gauges read"},
      {"gauges", "first_angle_deg", slot<&F::gauges, &Gauges::first_angle_deg>(), Domain::below(0, 360),
       "where gauge 0 is, counter-clockwise seen from the tip; gauge i is i 360/count further"},
      {"gauges", "arc_length_m", slot<&F::gauges, &Gauges::arc_length_m>(), Domain::between(0, 1),
       "length of a gauge along the ring, averaged over; 0: a point; at most one pitch"},
      {"gauges", "noise_strain", slot<&F::gauges, &Gauges::noise_strain>(), Domain::above(0, 0.1),
       "standard deviation of a conditioned reading, quantisation included"},
      {"gauges", "full_scale_strain", slot<&F::gauges, &Gauges::full_scale_strain>(), Domain::above(0, 0.1),
       "the converter covers +- this"},
      {"gauges", "adc_bits", slot<&F::gauges, &Gauges::adc_bits>(), Domain::between(8, 16),
       "resolution of the converter"},
      {"contact", "friction_coefficient", slot<&F::contact, &Contact::friction_coefficient>(),
       Domain::between(0, 10), "tangential load is at most this times the normal load"},
      {"contact", "width_m", slot<&F::contact, &Contact::width_m>(), Domain::between(0, 1),
       "width over which a contact presses; 0: a line; at most outer_radius_m"},
      {"can", "node", slot<&F::can, &Can::node>(), Domain::between(1, 63), "node number on the bus"},
      {"can", "bitrate", slot<&F::can, &Can::bitrate>(),
       Domain::oneOf({10'000, 20'000, 50'000, 125'000, 250'000, 500'000, 800'000, 1'000'000}),
       "bits per second (CiA 301, table of bit rates)"},
      {"can", "contact_rate_hz", slot<&F::can, &Can::contact_rate_hz>(),
       Domain::between(kSlowestContactRate_hz, kFastestContactRate_hz),
       "contacts are reported at most this often"},
      {"calibration", "gain", slot<&F::calibration, &Calibration::gain>(), Domain::between(0.5, 2),
       "what each gauge reads over what a gauge of this finger should, from `strainfinger calibrate`; an "
       "empty list: not calibrated"},
  };
}

double pitchArc_m(const Gauges& gauges) { return 2 * std::numbers::pi * gauges.radius_m / gauges.count; }
double contactLoad_bps(const Can& can) { return can.contact_rate_hz * kFramesPerContact * kWorstFrame_bits; }

std::vector<Relation> makeRelations() {
  using Config = const FingerConfig&;
  return {
      {[](Config c) { return c.finger.core_radius_m < c.finger.outer_radius_m; },
       {"finger.core_radius_m", "finger.outer_radius_m"},
       [](Config c) {
         return fmt::format("finger.core_radius_m = {} must be less than finger.outer_radius_m = {}",
                            c.finger.core_radius_m, c.finger.outer_radius_m);
       }},
      {[](Config c) {
         return c.finger.core_radius_m <= c.gauges.radius_m && c.gauges.radius_m < c.finger.outer_radius_m;
       },
       {"gauges.radius_m", "finger.core_radius_m", "finger.outer_radius_m"},
       [](Config c) {
         return fmt::format(
             "gauges.radius_m = {} is outside the rubber: it must be at least finger.core_radius_m = {}, "
             "less than finger.outer_radius_m = {}",
             c.gauges.radius_m, c.finger.core_radius_m, c.finger.outer_radius_m);
       }},
      {[](Config c) { return c.gauges.arc_length_m <= pitchArc_m(c.gauges); },
       {"gauges.arc_length_m", "gauges.count", "gauges.radius_m"},
       [](Config c) {
         return fmt::format(
             "gauges.arc_length_m = {}: neighbours overlap; it must be at most the pitch {} that "
             "gauges.count = {} "
             "and gauges.radius_m = {} leave",
             c.gauges.arc_length_m, pitchArc_m(c.gauges), c.gauges.count, c.gauges.radius_m);
       }},
      {[](Config c) { return c.gauges.noise_strain >= c.gauges.quantisation_strain(); },
       {"gauges.noise_strain", "gauges.adc_bits", "gauges.full_scale_strain"},
       [](Config c) {
         return fmt::format(
             "gauges.noise_strain = {} is less than the quantisation alone, {:.3g}, that gauges.adc_bits = "
             "{} "
             "over +-gauges.full_scale_strain = {} leaves; use more bits, a smaller full scale or more noise",
             c.gauges.noise_strain, c.gauges.quantisation_strain(), c.gauges.adc_bits,
             c.gauges.full_scale_strain);
       }},
      {[](Config c) { return c.contact.width_m <= c.finger.outer_radius_m; },
       {"contact.width_m", "finger.outer_radius_m"},
       [](Config c) {
         return fmt::format("contact.width_m = {} must be at most finger.outer_radius_m = {}",
                            c.contact.width_m, c.finger.outer_radius_m);
       }},
      {[](Config c) { return contactLoad_bps(c.can) <= c.can.bitrate; },
       {"can.contact_rate_hz", "can.bitrate"},
       [](Config c) {
         return fmt::format(
             "can.contact_rate_hz = {} needs up to {} bit/s, more than can.bitrate = {}; it must be at most "
             "{}",
             c.can.contact_rate_hz, contactLoad_bps(c.can), c.can.bitrate,
             c.can.bitrate / (kFramesPerContact * kWorstFrame_bits));
       }},
      {[](Config c) {
         return c.calibration.gain.empty() ||
                c.calibration.gain.size() == static_cast<std::size_t>(c.gauges.count);
       },
       {"calibration.gain", "gauges.count"},
       [](Config c) {
         return fmt::format("calibration.gain has {} numbers; it must have one a gauge, gauges.count = {}",
                            c.calibration.gain.size(), c.gauges.count);
       }},
  };
}

}  // namespace

std::string Key::dotted() const { return fmt::format("{}.{}", section, name); }

std::span<const Key> keys() {
  static const std::vector<Key> table = makeKeys();
  return table;
}

std::span<const Relation> relations() {
  static const std::vector<Relation> table = makeRelations();
  return table;
}

}  // namespace strainfinger::config
