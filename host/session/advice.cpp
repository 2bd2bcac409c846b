#include "host/session/advice.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/session/rules.hpp"

namespace strainfinger::session {
namespace {

/// Arcs of which a batch of touches gains so much of what it would gain in the best one are asked for with
/// it.
constexpr double kAboutAsGood = 0.6;

double apart_deg(double a_deg, double b_deg, double period_deg) {
  return std::abs(std::remainder(a_deg - b_deg, period_deg));
}

/// Directions that tell the ring's turn: not the same as, nor opposite of another that counts.
int directionsThatCount(const std::vector<double>& known_deg, double least_deg) {
  std::vector<double> counted;
  for (const double angle_deg : known_deg)
    if (std::ranges::none_of(counted,
                             [&](double other) { return apart_deg(angle_deg, other, 180) < least_deg; }))
      counted.push_back(angle_deg);
  return static_cast<int>(counted.size());
}

std::vector<bool> uncovered(const Coverage& coverage, int least) {
  std::vector<bool> wanted;
  for (const int touches : coverage.touches) wanted.push_back(touches < least);
  return wanted;
}

/// Arcs by what they gain: the run around the best of those that are about as good.
ArcRun runOfGain(const std::vector<double>& gains) {
  const int arcs = static_cast<int>(gains.size());
  const auto best = std::max_element(gains.begin(), gains.end());
  const auto isGood = [&](int arc) {
    return gains[static_cast<std::size_t>((arc + arcs) % arcs)] >= kAboutAsGood * *best;
  };
  const int middle = static_cast<int>(best - gains.begin());
  int first = middle, last = middle;
  while (last - first + 1 < arcs && isGood(first - 1)) --first;
  while (last - first + 1 < arcs && isGood(last + 1)) ++last;
  return {(first + arcs) % arcs, last - first + 1};
}

int gaugeForPress(const std::vector<double>& sigmas) {
  return static_cast<int>(std::min_element(sigmas.begin(), sigmas.end()) - sigmas.begin());
}

/// The gauge with most touches about it, whose place and depth are known best.
int coveredGauge(const Coverage& coverage) {
  const auto most = std::max_element(coverage.touches.begin(), coverage.touches.end());
  return static_cast<int>(most - coverage.touches.begin()) / 2;
}

/// Another press of known load is worth asking for.
bool isLoadWanted(const config::Gauges& gauges, const Coverage& coverage,
                  const std::optional<Assessment>& assessment) {
  if (!assessment) return coverage.loads == 0;
  return assessment->unitOfForce > kGoals.unitOfForce &&
         std::ranges::min(assessment->unitAfterPress) <=
             (1 - kGoals.leastUnitGain) * assessment->unitOfForce &&
         coverage.loads < kGoals.mostPressesPerGauge * gauges.count;
}

double worstZero(const Assessment& assessment) {
  double worst = 0;
  for (const GaugeSigmas& gauge : assessment.gauges) worst = std::max(worst, gauge.zero_strain);
  return worst;
}

}  // namespace

Advice nextAdvice(const config::Gauges& gauges, const Coverage& coverage,
                  const std::optional<Assessment>& assessment, const Unavailable& unavailable) {
  using Kind = Advice::Kind;
  if (coverage.untouched == 0) return {Kind::kLeaveAlone};
  const ArcRun gap = longestRun(uncovered(coverage, kGoals.leastPerArc));
  if (gap.count > 0) return {Kind::kRoll, gap};
  if (!unavailable.loads && isLoadWanted(gauges, coverage, assessment))
    return {
        Kind::kPress, {}, assessment ? gaugeForPress(assessment->unitAfterPress) : coveredGauge(coverage)};
  const bool angleIsKnown = !assessment || assessment->zeroOfAngle_deg <= kGoals.zeroOfAngle_deg;
  const int directions = directionsThatCount(coverage.directions_deg, kGoals.directionsApart_deg);
  if ((directions < kGoals.directions || !angleIsKnown) && !unavailable.directions) return {Kind::kMark};
  if (!assessment) return {Kind::kWait};
  if (worstZero(*assessment) > kGoals.zero * gauges.noise_strain) return {Kind::kLeaveAlone};
  if (assessment->bestGain() >= kGoals.leastGain) return {Kind::kRoll, runOfGain(assessment->arcGains)};
  return {Kind::kDone};
}

std::string textOf(const Advice& advice, const config::Gauges& gauges) {
  switch (advice.kind) {
    case Advice::Kind::kLeaveAlone:
      return fmt::format("Leave it alone for {:.0f} s.", kGoals.untouched_s);
    case Advice::Kind::kRoll:
      return fmt::format(
          "Roll it along a table edge {}, with light and with firm pressure, and rub it to either side.",
          nameOf(gauges, advice.where));
    case Advice::Kind::kPress:
      return fmt::format(
          "Press it with a known weight, or on a scale, over gauge {} ({:.0f} deg). Hold it still, then "
          "enter the load.",
          advice.gauge, gauges.angle_deg(advice.gauge));
    case Advice::Kind::kMark:
      return "Press it at a mark whose angle you know, not one used already nor its opposite. Hold it still, "
             "then enter the angle.";
    case Advice::Kind::kWait:
      return "Roll it all around while the first fit is made.";
    case Advice::Kind::kMend:
      return "Stop: gauges or wires must be mended first, as said where it says \"no fit yet\". End the "
             "session (q), mend them, and start again with another -o.";
    case Advice::Kind::kDone:
      break;
  }
  return "Nothing is left to gain.";
}

}  // namespace strainfinger::session
