// The primitives as the firmware has them. Its namespace has another name here: the executable of the proof
// has bounds for numbers in that one.
#include <concepts>

#include "firmware/core/integers.hpp"
#include "tests/firmware/ranges/primitives/primitive.hpp"

namespace strainfinger::firmware {
namespace {

Number number(const ranges::Interval& known) { return static_cast<Number>(known.least); }
Wide wide(const ranges::Interval& known) { return static_cast<Wide>(known.least); }
int whole(const ranges::Interval& known) { return static_cast<int>(known.least); }
Short kept(const ranges::Interval& known) { return static_cast<Short>(known.least); }

template <std::integral Result>
ranges::Interval boundsOf(Result result) {
  return {static_cast<long double>(result), static_cast<long double>(result)};
}

}  // namespace
}  // namespace strainfinger::firmware

#include "tests/firmware/ranges/primitives/list.hpp"

std::vector<strainfinger::ranges::Primitive> strainfinger::ranges::firmwarePrimitives() {
  return firmware::primitives();
}
