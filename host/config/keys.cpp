#include "host/config/keys.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <vector>

#include "common/commands.hpp"
#include "common/frame_layout.hpp"

namespace strainfinger::config {
namespace {

/// A gauge further off its place is not glued but misplaced. With it, neighbours at half the pitch of the
/// densest ring, 32 gauges, keep their order.
constexpr double kMostOffset_deg = 2.5;

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
       "gauges in the ring"},
      {"gauges", "radius_m", slot<&F::gauges, &Gauges::radius_m>(), Domain::above(0, 1),
       "where the gauges are: in the rubber, core_radius_m <= radius_m < outer_radius_m"},
      {"gauges", "component", slot<&F::gauges, &Gauges::component>(),
       Domain::between(0, static_cast<double>(kComponentNames.size() - 1)), "the strain the gauges read"},
      {"gauges", "first_angle_deg", slot<&F::gauges, &Gauges::first_angle_deg>(), Domain::below(0, 360),
       "where gauge 0 of an even ring is, counter-clockwise seen from the tip; gauge i is i 360/count "
       "further"},
      {"gauges", "arc_length_m", slot<&F::gauges, &Gauges::arc_length_m>(), Domain::between(0, 1),
       "length of a gauge along the ring, averaged over; 0: a point; at most one pitch"},
      {"gauges", "noise_strain", slot<&F::gauges, &Gauges::noise_strain>(), Domain::above(0, 0.1),
       "standard deviation of a conditioned reading, quantisation included"},
      {"gauges", "full_scale_strain", slot<&F::gauges, &Gauges::full_scale_strain>(), Domain::above(0, 0.06),
       "largest strain that the converter covers: its range is from minus this to plus this"},
      {"gauges", "adc_bits", slot<&F::gauges, &Gauges::adc_bits>(), Domain::between(8, 16),
       "resolution of the converter in bits: the steps of simulated codes, and the least noise_strain; 12 "
       "for the board in firmware/board"},
      {"gauges", "model_error", slot<&F::gauges, &Gauges::model_error>(), Domain::between(0, 1),
       "standard deviation of the difference between a reading and the model (build tolerances, rubber), as "
       "a fraction of that reading; an eighth of the same for its neighbours' readings and a sixteenth of "
       "that "
       "for the touch's largest one are added; 0.05: the finger has not been calibrated, and up to twice as "
       "much is used where a depth error of tolerance.depth_m changes its readings much, as near the core; "
       "0: the finger is exactly as configured"},
      {"gauges", "angle_deg", slot<&F::gauges, &Gauges::angles_deg>(), Domain::below(0, 360),
       "where each gauge is, counter-clockwise from gauge to gauge, for a ring that is not even; an empty "
       "list: the ring is even"},
      {"contact", "friction_coefficient", slot<&F::contact, &Contact::friction_coefficient>(),
       Domain::between(0, 10),
       "coefficient of friction between the rubber and what touches it: the tangential load is at most this "
       "times the normal load, and it decides which part of a contact sticks (Mindlin's partial slip); enter "
       "the true value, because the reported standard errors don't cover a wrong one"},
      {"contact", "width_m", slot<&F::contact, &Contact::width_m>(), Domain::between(0, 1),
       "known width of a contact, an arc of the surface: that of the uniform pressure with the same second "
       "moment, 0.87 times a Hertzian contact's; readings are taken for those of a semi-ellipse with this "
       "moment; 0: a line load; at most largest_width_m; left out: unknown, fitted with each touch"},
      {"contact", "largest_width_m", slot<&F::contact, &Contact::largest_width_m>(), Domain::above(0, 1),
       "widest contact that the tables cover; at most outer_radius_m"},
      {"can", "node", slot<&F::can, &Can::node>(), Domain::between(kFirstNode, kLastNode),
       "node number on the bus"},
      {"can", "bitrate", slot<&F::can, &Can::bitrate>(),
       Domain::oneOf({10'000, 20'000, 50'000, 125'000, 250'000, 500'000, 800'000, 1'000'000}),
       "bits per second (CiA 301, table of bit rates)"},
      {"can", "contact_rate_hz", slot<&F::can, &Can::contact_rate_hz>(),
       Domain::between(kSlowestContactRate_hz, kFastestContactRate_hz),
       "contacts are reported at most this often"},
      {"calibration", "gain", slot<&F::calibration, &Calibration::gain>(), Domain::between(0.5, 2),
       "what each gauge reads over what a gauge of this finger should, from `strainfinger calibrate`; an "
       "empty list: not calibrated"},
      {"calibration", "angle_offset_deg", slot<&F::calibration, &Calibration::angle_offset_deg>(),
       Domain::between(-kMostOffset_deg, kMostOffset_deg),
       "angle of each gauge less where [gauges] says it is, counter-clockwise positive; an empty list: not "
       "calibrated"},
      {"calibration", "depth_offset_m", slot<&F::calibration, &Calibration::depth_offset_m>(),
       Domain::between(-1, 1),
       "how much deeper each gauge is than gauges.radius_m, positive towards the core; an empty list: not "
       "calibrated"},
      {"calibration", "place_error_m", slot<&F::calibration, &Calibration::place_error_m>(),
       Domain::between(0, 1),
       "standard error of all places that the calibration leaves, an arc of the surface"},
      {"calibration", "load_error", slot<&F::calibration, &Calibration::load_error>(), Domain::between(0, 1),
       "standard error of all loads that the calibration leaves, over the normal load"},
      {"calibration", "moment_error_m2", slot<&F::calibration, &Calibration::moment_error_m2>(),
       Domain::between(0, 1),
       "standard error of all second moments of pressure that the calibration leaves, of width_m^2 / 12 "
       "where it is uniform"},
      {"tolerance", "angle_deg", slot<&F::tolerance, &Tolerance::angle_deg>(),
       Domain::above(0, kMostOffset_deg),
       "calibrate: standard deviation of a gauge's angle from the drawing"},
      {"tolerance", "depth_m", slot<&F::tolerance, &Tolerance::depth_m>(), Domain::above(0, 1),
       "standard deviation of a gauge's depth from the drawing: used by calibrate, and to increase "
       "gauges.model_error of a finger that is not calibrated, at most twofold"},
      {"tolerance", "gain", slot<&F::tolerance, &Tolerance::gain>(), Domain::above(0, 0.5),
       "calibrate: standard deviation of a gauge's gain, relative"},
      {"tolerance", "zero_strain", slot<&F::tolerance, &Tolerance::zero_strain>(), Domain::above(0, 0.1),
       "calibrate: standard deviation of what taring leaves of a gauge's zero"},
      {"tolerance", "core_radius_m", slot<&F::tolerance, &Tolerance::core_radius_m>(), Domain::above(0, 1),
       "standard deviation of the core's radius from the drawing: used by calibrate, and for the standard "
       "error of loads of a finger that is not calibrated"},
      {"tolerance", "poisson_ratio", slot<&F::tolerance, &Tolerance::poisson_ratio>(), Domain::above(0, 0.5),
       "standard deviation of Poisson's ratio from finger.poisson_ratio: used as core_radius_m"},
      {"tolerance", "shear_modulus", slot<&F::tolerance, &Tolerance::shear_modulus>(), Domain::above(0, 1),
       "calibrate: standard deviation of the shear modulus, relative"},
      {"as_built", "seed", slot<&F::as_built, &AsBuilt::seed>(),
       Domain::between(0, std::numeric_limits<int>::max()),
       "simulations only: the number of a random finger; another number is another finger with the same "
       "standard deviations"},
      {"as_built", "angle_deg", slot<&F::as_built, &AsBuilt::angle_deg>(),
       Domain::between(0, kMostOffset_deg), "simulations only: standard deviation of the gauges' angles"},
      {"as_built", "depth_m", slot<&F::as_built, &AsBuilt::depth_m>(), Domain::between(0, 1),
       "simulations only: standard deviation of the gauges' depths; none leaves the rubber"},
      {"as_built", "gain", slot<&F::as_built, &AsBuilt::gain>(), Domain::between(0, 0.2),
       "simulations only: standard deviation of the gauges' gains, relative"},
      {"as_built", "core_radius_m", slot<&F::as_built, &AsBuilt::core_radius_m>(), Domain::between(-1, 1),
       "simulations only: true radius of the core less finger.core_radius_m"},
      {"as_built", "poisson_ratio", slot<&F::as_built, &AsBuilt::poisson_ratio>(), Domain::between(-0.5, 0.5),
       "simulations only: true Poisson's ratio less finger.poisson_ratio"},
      {"as_built", "shear_modulus_pa", slot<&F::as_built, &AsBuilt::shear_modulus_pa>(),
       Domain::between(-1e12, 1e12), "simulations only: true shear modulus less finger.shear_modulus_pa"},
  };
}

}  // namespace

std::string Key::dotted() const { return fmt::format("{}.{}", section, name); }

std::span<const Key> keys() {
  static const std::vector<Key> table = makeKeys();
  return table;
}

const Key& keyOf(std::string_view dotted) {
  return *std::ranges::find_if(keys(), [&](const Key& key) { return key.dotted() == dotted; });
}

}  // namespace strainfinger::config
