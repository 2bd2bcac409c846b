#include "firmware/core/scan.hpp"

#include <limits>

namespace strainfinger::firmware {
namespace {

/// A scan that leaves more than this part of the ring's energy, as a power of two, is in the wrong window.
constexpr int kLeftShift = 3;

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
  const std::size_t inner = strains.size() - 2;
  if (inner % 4 != 0) lookAtTwo();
  if (inner % 8 >= 4) {
    lookAtTwo();
    lookAtTwo();
  }
  while (gauge + 1 != last) {
    lookAtTwo();
    lookAtTwo();
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
  for (unsigned left = static_cast<unsigned>(gauges) % 8; left != 0; left -= 2) lookAtTwo();
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

/// Takes another start if it is better.
void lookAlso(const Problem& problem, int centre, Region& region) {
  const Start other = midwayStart(problem, wrapped(centre, problem.gauges()));
  if (other.energy <= region.peaks.first.energy) return;
  region.centre = other.centre;
  region.signal = signalAround(problem, other.centre);
  region.peaks = {{other.energy, other.row}, {-1, 0}};
}

/// The same contact from the next gauge's window.
void changeWindow(const Problem& problem, Region& region) {
  Peak& best = region.peaks.first;
  const int side = best.row < 0 ? -1 : 1;
  region.centre = wrapped(region.centre + side, problem.gauges());
  region.signal = signalAround(problem, region.centre);
  best.row -= side * kRowsPerPitch;
}

}  // namespace

int deepestGauge(const std::int32_t* strains, int gauges, int sign) {
  return sign > 0 ? deepest<1>(strains, gauges) : deepest<-1>(strains, gauges);
}

Signal signalAround(const Problem& problem, int centre) {
  return windowSignal(problem.strains, centre, problem.up);
}

Start midwayStart(const Problem& problem, int centre) {
  const Signal signal = signalAround(problem, centre);
  const Sides sides = scannedSides(problem.tables.rows, signal, kMidwayRow, kScanReach);
  return startAt(centre, sides.minus.energy > sides.plus.energy ? sides.minus : sides.plus);
}

void lookAtBend(const Problem& problem, int first, Region& region) {
  region.anchor = region.centre = bendAnchor(problem);
  region.signal = windowSignal(problem.strains, region.centre, problem.up);
  region.peaks = bestTwo(scannedSides(problem.tables.rows, region.signal, first, kScanReach));
  const Peak& best = region.peaks.first;
  const auto also = [&](int away) { lookAlso(problem, region.anchor + away, region); };
  if (best.energy < problem.ringEnergy - (problem.ringEnergy >> kLeftShift) - problem.noise) {
    // Midway between two gauges, two or three from here; where it looks like this edge, three on the other
    // side.
    if (absolute(best.row) == kScanReach) {
      also(best.row < 0 ? 3 : -3);
    } else {
      also(-2);
      also(2);
    }
  }
  if (absolute(best.row) == kScanReach && !mayWin(problem, region.peaks)) changeWindow(problem, region);
}

}  // namespace strainfinger::firmware
