#include "firmware/core/scan.hpp"

#include <limits>

namespace strainfinger::firmware {
namespace {

/// A window that leaves more than this part of the ring's energy, as a power of two, is the wrong one; at its
/// edge, where wrong ones look right, more than that.
constexpr int kLeftShift = 3;
constexpr int kLeftAtEdgeShift = 4;

/// Where sign * (s[i-1] - 2 s[i] + s[i+1]) is largest, the first of equals. Strains within +-2^29.
template <int Sign>
int sharpestBend(std::span<const std::int32_t> strains) {
  const std::int32_t* gauge = strains.data();
  const std::int32_t* const last = gauge + strains.size() - 1;
  const std::int32_t* sharpest = gauge;
  std::int32_t largest = std::numeric_limits<std::int32_t>::min();
  const auto look = [&](const std::int32_t* at, std::int32_t bend) {
    if (Sign * bend > largest) {
      asm("");  // a branch: most bends are not the largest so far
      largest = Sign * bend;
      sharpest = at;
    }
  };
  std::int32_t even = *gauge, intoEven = even - *last;
  const auto lookAtTwo = [&] {
    const std::int32_t odd = gauge[1], intoOdd = odd - even;
    look(gauge, intoOdd - intoEven);
    even = gauge[2];
    intoEven = even - odd;
    look(gauge + 1, intoEven - intoOdd);
    gauge += 2;
  };
  if (strains.size() % 4 == 0) lookAtTwo();
  while (gauge + 1 != last) {
    lookAtTwo();
    lookAtTwo();
  }
  const std::int32_t intoLast = *last - even;
  look(gauge, intoLast - intoEven);
  look(last, *strains.data() - *last - intoLast);
  return static_cast<int>(sharpest - strains.data());
}

/// Where sign * strain is least, the first of equals.
template <int Sign>
int deepest(const std::int32_t* gauge, int gauges) {
  const std::int32_t* const first = gauge;
  const std::int32_t* const end = gauge + gauges;
  const std::int32_t* found = gauge;
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  const auto lookAtTwo = [&] {
    const std::int32_t even = Sign * gauge[0], odd = Sign * gauge[1];
    if (even < least) {
      asm("");  // a branch: most are not the least so far
      least = even;
      found = gauge;
    }
    if (odd < least) {
      asm("");
      least = odd;
      found = gauge + 1;
    }
    gauge += 2;
  };
  for (int left = gauges % 8; left > 0; left -= 2) lookAtTwo();
  while (gauge != end) {
    lookAtTwo();
    lookAtTwo();
    lookAtTwo();
    lookAtTwo();
  }
  return static_cast<int>(found - first);
}

int bendAnchor(const Problem& problem) {
  return problem.tables.constants.anchor_sign > 0 ? sharpestBend<1>(problem.strains)
                                                  : sharpestBend<-1>(problem.strains);
}

/// Contacts midway between two gauges may bend the strains most two gauges away.
[[gnu::noinline]] void lookBeside(const Problem& problem, Region& region) {
  region.lookedBeside = true;
  Start* start = region.besides.data();
  for (const int away : {-2, 2}) {
    const int centre = wrapped(region.anchor + away, problem.gauges());
    const Signal signal = windowSignal(problem.strains, centre, problem.up);
    const BestTwo peaks = bestTwo(scannedSides(problem.tables.rows, signal, kMidwayRow, kScanReach));
    const bool better = peaks.first.energy > region.peaks.first.energy;
    *start++ = better ? startAt(region.centre, region.peaks.first) : startAt(centre, peaks.first);
    if (!better) continue;
    region.centre = centre;
    region.signal = signal;
    region.peaks = peaks;
  }
}

/// The same contact from the next gauge's window.
void changeWindow(const Problem& problem, Region& region) {
  Peak& best = region.peaks.first;
  const int side = best.row < 0 ? -1 : 1;
  region.centre = wrapped(region.centre + side, problem.gauges());
  region.signal = windowSignal(problem.strains, region.centre, problem.up);
  best.row -= side * kRowsPerPitch;
}

}  // namespace

int deepestGauge(const std::int32_t* strains, int gauges, int sign) {
  return sign > 0 ? deepest<1>(strains, gauges) : deepest<-1>(strains, gauges);
}

void lookAtBend(const Problem& problem, int first, Region& region) {
  region.anchor = region.centre = bendAnchor(problem);
  scanWindow(problem, first, kScanReach, region);
  const Peak& best = region.peaks.first;
  const bool atEdge = absolute(best.row) == kScanReach;
  const std::int32_t left = problem.ringEnergy >> (atEdge ? kLeftAtEdgeShift : kLeftShift);
  if (best.energy < problem.ringEnergy - left - problem.noise) lookBeside(problem, region);
  if (absolute(best.row) == kScanReach && !mayWin(problem, region.peaks)) changeWindow(problem, region);
}

}  // namespace strainfinger::firmware
