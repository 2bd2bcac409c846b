#include "host/tables/elsewhere.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <vector>

#include "common/table_image.hpp"
#include "host/tables/pressed_ring.hpp"
#include "host/tables/window_fit.hpp"

namespace strainfinger::tables {
namespace {

constexpr int kElsewhereOffsets = 64;     ///< a pitch
constexpr int kElsewhereFarthest = 40;    ///< of them, from a window's middle gauge: as far as the fit table
constexpr int kElsewhereDirections = 32;  ///< to either side
constexpr int kNearestContact = kElsewhereOffsets / 4;
constexpr int kFarthestContact = kElsewhereOffsets * 3 / 2;  ///< those beyond leave too much outside
constexpr double kBeyondCone = 1.25;
constexpr double kMostOutside = 1.0 / 28;  ///< of the window's energy: more than 1/32 and noise is in doubt

/// Another offset d standard errors away is within 32 variances of a contact's own, which is where it is
/// told, once noise is (d^2 - 32) / (2 d) standard errors: 5.4 of d^2 = 175.
constexpr double kFirmVariances = 175;

WindowMatrix windowAt(const model::ImpulseResponse& response, int gaugeCount, int offset) {
  return windowResponse(response, gaugeCount, static_cast<double>(offset) / kElsewhereOffsets).value;
}

/// An offset at which a window might be fitted.
struct Offset {
  WindowMatrix responses;
  Eigen::Matrix2d inverse;  ///< of their products
};
using Offsets = std::vector<Offset>;

Offsets offsetsOf(const model::ImpulseResponse& response, int gaugeCount) {
  Offsets offsets;
  for (int i = -kElsewhereFarthest; i <= kElsewhereFarthest; ++i) {
    const WindowMatrix responses = windowAt(response, gaugeCount, i);
    offsets.push_back({responses, (responses.transpose() * responses).inverse()});
  }
  return offsets;
}

/// Energy of readings of a unit normal load and a tangential one.
struct Energy {
  double normal, both, tangential;

  explicit Energy(const Eigen::Matrix2d& form)
      : normal(form(0, 0)), both(form(0, 1) + form(1, 0)), tangential(form(1, 1)) {}
  double of(double load) const { return normal + load * (both + load * tangential); }
};

/// What an offset makes of the readings of contacts at another one.
struct Rival {
  Eigen::Matrix2d loads;  ///< that it takes, per load of theirs
  Energy left;            ///< of the readings, unexplained

  Rival(const Offset& offset, const WindowMatrix& readings)
      : loads(offset.inverse * offset.responses.transpose() * readings),
        left((readings - offset.responses * loads).transpose() * (readings - offset.responses * loads)) {}
  bool isAllowed(double load, double cone) const {
    const double normal = loads(0, 0) + load * loads(0, 1), tangential = loads(1, 0) + load * loads(1, 1);
    return normal > 0 && std::abs(tangential) <= kBeyondCone * cone * normal;
  }
};

/// What is left at the middle of three offsets, at the least of the parabola through them.
double leastBetween(double before, double here, double after) {
  const double bend = before - 2 * here + after, slope = (after - before) / 2;
  return bend > 0 ? std::max(here - slope * slope / (2 * bend), 0.0) : here;
}

/// Contacts so many offsets from a window's middle gauge.
class Contacts {
 public:
  Contacts(const model::ImpulseResponse& response, int gaugeCount, int own)
      : own_(own),
        ring_(response, gaugeCount, static_cast<double>(own) / kElsewhereOffsets),
        readings_(windowAt(response, gaugeCount, own)),
        energy_(readings_.transpose() * readings_) {}

  PressedRing ring(double load) const { return ring_.pressed(load); }
  /// With this load that gauge is the deepest, and too little is left outside the window to be in doubt.
  bool belongHere(const PressedRing& ring, double load) const {
    const double inside = energy_.of(load);
    return ring.deepest == 0 && ring.energy - inside <= kMostOutside * inside;
  }
  std::vector<Rival> rivals(const Offsets& offsets) const {
    std::vector<Rival> rivals;
    rivals.reserve(offsets.size());
    for (const Offset& each : offsets) rivals.emplace_back(each, readings_);
    return rivals;
  }
  /// The least energy that is left at another offset.
  double leastLeft(const std::vector<Rival>& rivals, double load, double cone) const {
    std::vector<double> left;
    left.reserve(rivals.size());
    for (const Rival& each : rivals) left.push_back(each.left.of(load));
    double least = energy_.of(load);
    for (std::size_t i = 1; i + 1 < left.size(); ++i) {
      const bool isSame = std::abs(static_cast<int>(i) - kElsewhereFarthest - own_) <= 1;
      if (!isSame && left[i] <= left[i - 1] && left[i] <= left[i + 1] && rivals[i].isAllowed(load, cone))
        least = std::min(least, leastBetween(left[i - 1], left[i], left[i + 1]));
    }
    return least;
  }

 private:
  int own_;
  RingResponse ring_;
  WindowMatrix readings_;
  Energy energy_;
};

}  // namespace

double leastElsewhere(const model::ImpulseResponse& response, int gaugeCount, double cone) {
  const Offsets offsets = offsetsOf(response, gaugeCount);
  double least = 1;
  // Those on the other side are their mirror images.
  for (int own = kNearestContact; own <= kFarthestContact; ++own) {
    const Contacts contacts(response, gaugeCount, own);
    const std::vector<Rival> rivals = contacts.rivals(offsets);
    for (int step = -kElsewhereDirections; step <= kElsewhereDirections; ++step) {
      const double load = cone * step / kElsewhereDirections;
      const PressedRing ring = contacts.ring(load);
      if (contacts.belongHere(ring, load))
        least = std::min(least, contacts.leastLeft(rivals, load, cone) / ring.energy);
    }
  }
  return least;
}

int firmExponent(double leastLeft) {
  return static_cast<int>(std::ceil(std::log2(kFirmVariances / std::max(leastLeft, 1e-12))));
}

}  // namespace strainfinger::tables
