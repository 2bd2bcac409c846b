#pragma once
// In place of firmware/core/wide.hpp: bounds of numbers of 64 bits.

#include <algorithm>
#include <limits>

#include "firmware/core/packed.hpp"

namespace strainfinger::firmware {

class Wide {
 public:
  Wide() = default;
  Wide(Number number) : Wide(number.least(), number.most()) {}
  Wide(int number) : Wide(number, number) {}
  Wide(long double least, long double most) : least_(least), most_(most) {
    if (least < -kLimit || most >= kLimit) ++overflows;
  }

  friend Wide operator+(Wide a, Wide b) { return {a.least_ + b.least_, a.most_ + b.most_}; }
  friend Wide operator*(Wide a, Wide b) {
    const auto [least, most] =
        std::minmax({a.least_ * b.least_, a.least_ * b.most_, a.most_ * b.least_, a.most_ * b.most_});
    return {least, most};
  }
  friend Wide operator>>(Wide a, int by) {
    return {std::floor(std::ldexp(a.least_, -by)), std::floor(std::ldexp(a.most_, -by))};
  }

 private:
  static constexpr long double kLimit = 0x1p63L;
  long double least_ = 0, most_ = 0;
};

}  // namespace strainfinger::firmware
