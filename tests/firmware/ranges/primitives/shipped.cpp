// The primitives as the firmware has them. Its namespace has another name here: the executable of the proof
// has bounds for numbers in that one.
#include <array>
#include <concepts>

#include "common/table_image.hpp"
#include "firmware/core/wide.hpp"
#include "tests/firmware/ranges/primitives/primitive.hpp"

namespace strainfinger::firmware {
namespace {

Number number(const ranges::Bounds& known) { return static_cast<Number>(known.least); }
Wide wide(const ranges::Bounds& known) { return static_cast<Wide>(known.least); }
Natural natural(const ranges::Bounds& known) { return static_cast<Natural>(known.least); }
int whole(const ranges::Bounds& known) { return static_cast<int>(known.least); }
constexpr FoldedWeights kColumn{};
const FoldedWeights& aColumn() { return kColumn; }

template <std::integral Result>
ranges::Bounds boundsOf(Result result) {
  return {static_cast<long double>(result), static_cast<long double>(result)};
}

}  // namespace
}  // namespace strainfinger::firmware

#include "tests/firmware/ranges/primitives/list.hpp"

std::vector<strainfinger::ranges::Primitive> strainfinger::ranges::firmwarePrimitives() {
  return firmware::primitives();
}
