#pragma once
// In place of firmware/core/reciprocal.hpp: what it says of its results; ReciprocalTest holds them against
// it.

#include "firmware/core/integers.hpp"

namespace strainfinger::firmware {

struct Reciprocal {
  Number mantissa = 0;
  Number exponent = 0;
};

inline Reciprocal reciprocalOf(const Number& value) {
  if (value.least() < 1) ++overflows;
  return {{(1 << 29) - 4, 1 << 30}, {-60, -30}};
}

inline Number divided(const Number& value, const Reciprocal& by, int bits, const Number& limit) {
  return shifted(Wide{value} * by.mantissa, by.exponent + bits, limit);
}

}  // namespace strainfinger::firmware
