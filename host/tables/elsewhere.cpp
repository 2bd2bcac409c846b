#include "host/tables/elsewhere.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "common/table_image.hpp"
#include "host/tables/window_fit.hpp"

namespace strainfinger::tables {
namespace {

constexpr int kElsewhereOffsets = 64;     ///< a pitch
constexpr int kElsewhereFarthest = 40;    ///< of them, from a window's middle gauge: as far as the fit table
constexpr int kElsewhereDirections = 32;  ///< to either side
constexpr double kBeyondCone = 1.25;
constexpr double kMostOutside = 1.0 / 32;  ///< of the window's energy: what leaves more is in doubt

/// Another offset d standard errors away is within 32 variances of a contact's own, which is where it is
/// told, once noise is (d^2 - 32) / (2 d) standard errors: 5.4 of d^2 = 175.
constexpr double kFirmVariances = 175;

/// An offset of a window.
struct Offset {
  WindowMatrix responses;
  Eigen::Matrix2d inverse;  ///< of their products

  Offset(const model::ImpulseResponse& response, int gaugeCount, double offset_pitch)
      : responses(windowResponse(response, gaugeCount, offset_pitch).value),
        inverse((responses.transpose() * responses).inverse()) {}
  Eigen::Vector2d loads(const WindowVector& readings) const {
    return inverse * (responses.transpose() * readings);
  }
};
using Offsets = std::vector<Offset>;

Offsets offsetsOf(const model::ImpulseResponse& response, int gaugeCount) {
  Offsets offsets;
  for (int i = -kElsewhereFarthest; i <= kElsewhereFarthest; ++i)
    offsets.emplace_back(response, gaugeCount, static_cast<double>(i) / kElsewhereOffsets);
  return offsets;
}

/// What is left at the middle of three offsets, at the least of the parabola through them.
double leastOf(double before, double here, double after) {
  const double bend = before - 2 * here + after, slope = (after - before) / 2;
  return bend > 0 ? std::max(here - slope * slope / (2 * bend), 0.0) : here;
}

/// Of the readings of a contact `own` offsets from the window's middle gauge.
double leastElsewhereOf(const Offsets& offsets, const WindowVector& readings, int own, double cone) {
  std::vector<double> left;
  std::vector<bool> allowed;
  for (const Offset& each : offsets) {
    const Eigen::Vector2d loads = each.loads(readings);
    left.push_back((readings - each.responses * loads).squaredNorm() / readings.squaredNorm());
    allowed.push_back(loads[0] > 0 && std::abs(loads[1]) <= kBeyondCone * cone * loads[0]);
  }
  double least = 1;
  for (std::size_t i = 1; i + 1 < left.size(); ++i) {
    const bool same = std::abs(static_cast<int>(i) - kElsewhereFarthest - own) <= 1;
    if (!same && allowed[i] && left[i] <= left[i - 1] && left[i] <= left[i + 1])
      least = std::min(least, leastOf(left[i - 1], left[i], left[i + 1]));
  }
  return least;
}

/// The window around the deepest reading.
struct Seen {
  WindowVector readings = WindowVector::Zero();
  int own = 0;  ///< the contact's offset from its middle gauge
  double outside = 0;
};
Seen seenOf(const std::vector<double>& ring, int place) {
  const int gauges = static_cast<int>(ring.size());
  const auto deepest = static_cast<int>(std::max_element(ring.begin(), ring.end()) - ring.begin());
  const auto at = [&](int away) {
    return ring[static_cast<std::size_t>((deepest + away + gauges) % gauges)];
  };
  Seen seen;
  for (int k = 0; k < kWindowGauges; ++k) seen.readings[k] = at(k - kWindowReach);
  double energy = 0;
  for (const double reading : ring) energy += reading * reading;
  seen.outside = energy - seen.readings.squaredNorm();
  if (hasOuterPair(gauges))
    seen.readings[kWindowGauges] = (at(kOuterReach) - at(-kOuterReach)) / std::numbers::sqrt2;
  seen.own =
      static_cast<int>(std::remainder(place - deepest * kElsewhereOffsets, gauges * kElsewhereOffsets));
  return seen;
}

}  // namespace

double leastElsewhere(const model::ImpulseResponse& response, int gaugeCount, double cone) {
  const Offsets offsets = offsetsOf(response, gaugeCount);
  const double sign = response.at(0).normal < 0 ? -1 : 1;
  double least = 1;
  for (int place = -kElsewhereOffsets / 2; place <= kElsewhereOffsets / 2; ++place) {
    std::vector<model::ImpulseResponse::Value> values;
    for (int gauge = 0; gauge < gaugeCount; ++gauge)
      values.push_back(response.at((gauge - static_cast<double>(place) / kElsewhereOffsets) * 2 *
                                   std::numbers::pi / gaugeCount));
    for (int step = -kElsewhereDirections; step <= kElsewhereDirections; ++step) {
      std::vector<double> ring;
      for (const auto& value : values)
        ring.push_back(sign * (value.normal + cone * step / kElsewhereDirections * value.tangential));
      Seen seen = seenOf(ring, place);
      if (std::abs(seen.own) < kElsewhereOffsets / 4 ||
          seen.outside > kMostOutside * seen.readings.squaredNorm())
        continue;
      seen.readings *= sign;
      least = std::min(least, leastElsewhereOf(offsets, seen.readings, seen.own, cone));
    }
  }
  return least;
}

int firmExponent(double leastElsewhere) {
  return static_cast<int>(std::ceil(std::log2(kFirmVariances / std::max(leastElsewhere, 1e-12))));
}

}  // namespace strainfinger::tables
