#include "host/study/calibration_session.hpp"

#include "host/base/angles.hpp"
#include "host/evidence/touched_ring.hpp"
#include "host/evidence/uniform.hpp"
#include "host/simulation/noise.hpp"

namespace strainfinger::study {
namespace {

/// Seeds of what is drawn beside the finger, so that nothing repeats its draws.
constexpr std::uint64_t kFingerSeeds = 1'000'000, kSessionSeeds = 2'000'000;

/// [N/m] A mark is pressed with so much, or more.
constexpr double kFirm_n_per_m = 15;

enum Junk : int { kTwoContacts, kSlip, kSaturated, kJunkKinds };

/// What the ring reads of a touch that went wrong, `other` being another touch.
Eigen::VectorXd junkReadings(const evidence::TouchedRing& ring, const simulation::Touch& touch,
                             const simulation::Touch& other, int kind, double fullScale_strain) {
  const std::vector<simulation::Touch> both{touch, other};
  if (kind == kTwoContacts) return ring.exact(both);
  simulation::Touch slipped = touch;
  slipped.angle_rad += 10 * kRadPerDeg;
  if (kind == kSlip) return (ring.exact(touch) + ring.exact(slipped)) / 2;
  Eigen::VectorXd saturated = ring.exact(touch);
  Eigen::Index largest = 0;
  saturated.cwiseAbs().maxCoeff(&largest);
  saturated[largest] = -fullScale_strain;
  return saturated;
}

}  // namespace

config::FingerConfig randomFinger(std::uint64_t seed) {
  const simulation::Noise draws(kFingerSeeds + seed);
  config::FingerConfig config;
  config.as_built = {.seed = static_cast<int>(seed),
                     .angle_deg = 0.5,
                     .depth_m = 0.05e-3,
                     .gain = 0.03,
                     .core_radius_m = 0.2e-3 * evidence::uniform(draws, 0, 0),
                     .poisson_ratio = 0.03 * (evidence::uniform(draws, 0, 2) - 0.5)};
  return config;
}

Session sessionOf(const config::FingerConfig& finger, const SessionPlan& plan, std::uint64_t seed) {
  const evidence::TouchedRing ring(finger, kSessionSeeds + seed);
  const evidence::TouchDraws draws(finger.gauges, plan.ranges, kSessionSeeds + seed);
  const simulation::Noise chance(kSessionSeeds + seed);
  Session session{finger, Eigen::MatrixXd(plan.touches, finger.gauges.count), {}, {}};
  int directions = 0;
  for (int i = 0; i < plan.touches; ++i) {
    const auto number = static_cast<std::uint64_t>(i);
    const simulation::Touch touch = draws.at(number);
    calibration::KnownTouch known;
    if (i < plan.knownLoads) known.normal_n_per_m = touch.normal_n_per_m;
    const bool isDirection =
        i >= plan.knownLoads && directions < plan.knownDirections && touch.normal_n_per_m >= kFirm_n_per_m;
    if (isDirection) known.angle_deg = touch.angle_rad / kRadPerDeg;
    directions += isDirection;
    const bool isJunk =
        i >= plan.knownLoads && !isDirection && evidence::uniform(chance, number, 20) + 0.5 < plan.junk;
    const auto otherNumber = number + static_cast<std::uint64_t>(plan.touches);
    const Eigen::VectorXd exact = isJunk ? junkReadings(ring, touch, draws.at(otherNumber), i % kJunkKinds,
                                                        finger.gauges.full_scale_strain)
                                         : ring.exact(touch);
    session.readings.row(i) = ring.noisy(exact, number);
    session.known.push_back(known);
    session.isJunk.push_back(isJunk);
  }
  return session;
}

}  // namespace strainfinger::study
