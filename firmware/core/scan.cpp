#include "firmware/core/scan.hpp"

#include <limits>

namespace strainfinger::firmware {
namespace {

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
int deepest(std::span<const std::int32_t> strains) {
  const std::int32_t* gauge = strains.data();
  const std::int32_t* const end = gauge + strains.size();
  const std::int32_t* found = gauge;
  std::int32_t least = std::numeric_limits<std::int32_t>::max();
  const auto look = [&](const std::int32_t* at, std::int32_t reading) {
    if (Sign * reading < least) {
      asm("");
      least = Sign * reading;
      found = at;
    }
  };
  const auto lookAtTwo = [&] {
    const std::int32_t even = gauge[0], odd = gauge[1];
    look(gauge, even);
    look(gauge + 1, odd);
    gauge += 2;
  };
  if (strains.size() % 4 != 0) lookAtTwo();
  while (gauge != end) {
    lookAtTwo();
    lookAtTwo();
  }
  return static_cast<int>(found - strains.data());
}

}  // namespace

Anchor deepestAnchor(const Problem& problem) {
  const int gauge = problem.tables.constants.anchor_sign > 0 ? deepest<1>(problem.strains) : deepest<-1>(problem.strains);
  const std::int32_t reading = raised(problem.strains[static_cast<std::size_t>(gauge)], problem.up) >> 16;
  const std::uint32_t own = static_cast<std::uint32_t>(reading * reading) * 4;
  const std::uint32_t all = static_cast<std::uint32_t>(problem.ringEnergy) >> 11;
  if (own >= all * 26214) return {gauge, 12};
  if (own >= all * 20316) return {gauge, 20};
  if (own >= all * 5243) return {gauge, 28};
  return {bendAnchor(problem), kScanReach};
}

int bendAnchor(const Problem& problem) {
  return problem.tables.constants.anchor_sign > 0 ? sharpestBend<1>(problem.strains)
                                                  : sharpestBend<-1>(problem.strains);
}

}  // namespace strainfinger::firmware
