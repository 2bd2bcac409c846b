#include "firmware/core/scan.hpp"

#include <limits>

namespace strainfinger::firmware {
namespace {

/// Where sign * (s[i-1] - 2 s[i] + s[i+1]) is largest, the first of equals. Strains within +-2^29.
template <int Sign>
int sharpestBend(std::span<const std::int32_t> strains) {
  const std::int32_t* const begin = strains.data();
  const std::int32_t* const last = begin + strains.size() - 1;
  const std::int32_t* sharpest = begin;
  std::int32_t before = *last, at = *begin;
  std::int32_t largest = std::numeric_limits<std::int32_t>::min();
  const auto look = [&](const std::int32_t* gauge, std::int32_t a, std::int32_t b, std::int32_t c) {
    const std::int32_t bend = Sign * (a + c - 2 * b);
    if (bend > largest) [[unlikely]] {
      largest = bend;
      sharpest = gauge;
    }
  };
  const std::int32_t* gauge = begin;
  for (;; gauge += 2) {
    const std::int32_t next = gauge[1];
    look(gauge, before, at, next);
    if (gauge + 1 == last) break;
    const std::int32_t afterNext = gauge[2];
    look(gauge + 1, at, next, afterNext);
    before = next;
    at = afterNext;
  }
  look(last, at, *last, *begin);
  return static_cast<int>(sharpest - begin);
}

}  // namespace

int bendAnchor(const Problem& problem) {
  return problem.tables.constants.anchor_sign > 0 ? sharpestBend<1>(problem.strains)
                                                  : sharpestBend<-1>(problem.strains);
}

}  // namespace strainfinger::firmware
