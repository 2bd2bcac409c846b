// What the proof has a model of is what the firmware does: of known numbers exactly that, of bounds no less.
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <iomanip>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "firmware/core/integers.hpp"
#include "tests/firmware/ranges/primitives/primitive.hpp"
#include "tests/firmware/ranges/ranges_group.hpp"

#include <CppUTest/TestHarness.h>

namespace strainfinger::firmware {
namespace {

template <typename T>
T of(const ranges::Interval& known) {
  return {static_cast<Exact>(known.least), static_cast<Exact>(known.most)};
}
Number number(const ranges::Interval& known) { return of<Number>(known); }
Wide wide(const ranges::Interval& known) { return of<Wide>(known); }
int whole(const ranges::Interval& known) { return static_cast<int>(known.least); }
Short kept(const ranges::Interval& known) { return of<Short>(known); }

template <typename Result>
ranges::Interval boundsOf(const Result& result) {
  return {static_cast<long double>(result.least()), static_cast<long double>(result.most())};
}
ranges::Interval boundsOf(int result) {
  return {static_cast<long double>(result), static_cast<long double>(result)};
}

}  // namespace
}  // namespace strainfinger::firmware

#include "tests/firmware/ranges/primitives/list.hpp"

using namespace strainfinger;
using namespace strainfinger::firmware;
using strainfinger::ranges::Primitive;

TEST_GROUP_BASE(Primitives, RangesGroup) {
  static constexpr unsigned kSeed = 61;
  std::mt19937_64 random{kSeed};
  const std::vector<Primitive> models = primitives(), shipped = ranges::firmwarePrimitives();
  using Arguments = std::vector<Interval>;

  void setup() override {
    RangesGroup::setup();
    std::printf("seed %u ", kSeed);
  }

  static Interval known(long double number) { return {number, number}; }
  /// Of every way that the model goes.
  static Interval modelled(const Primitive& model, const Arguments& arguments) {
    Interval all{0x1p64L, -0x1p64L};
    forEachWay([&] {
      const Interval way = model.result(arguments.data());
      all = {std::min(all.least, way.least), std::max(all.most, way.most)};
    });
    return all;
  }
  static std::string said(const std::string& name, const Arguments& arguments) {
    std::ostringstream text;
    text << std::setprecision(20) << name << " of";
    for (const Interval& each : arguments) text << ' ' << each.least << " .. " << each.most;
    return text.str();
  }
  static void checkExact(const Primitive& model, const Primitive& own, const Arguments& arguments) {
    const Interval bounds = modelled(model, arguments);
    const long double result = own.result(arguments.data()).least;
    const bool is = model.isExact ? bounds.least == result && bounds.most == result
                                  : bounds.least <= result && bounds.most >= result;
    if (!is || overflows != 0) FAIL(said(model.name, arguments).c_str());
  }

  static std::vector<long double> corners(const Domain& domain) {
    std::vector<long double> all;
    for (const long double each :
         {domain.least, domain.least + 1, -1.0L, 0.0L, 1.0L, domain.most - 1, domain.most})
      if (each >= domain.least && each <= domain.most) all.push_back(each);
    return all;
  }
  /// Of any size, so that small ones are as frequent.
  long double anyOf(const Domain& domain) {
    const int down = std::uniform_int_distribution(0, 64)(random);
    const long double of = std::uniform_real_distribution<long double>(domain.least, domain.most)(random);
    return std::clamp(std::trunc(down < 32 ? of : std::ldexp(of, 32 - down)), domain.least, domain.most);
  }
  Interval anyBounds(const Domain& domain) {
    const long double one = anyOf(domain), other = anyOf(domain);
    return domain.isPlain ? known(one) : Interval{std::min(one, other), std::max(one, other)};
  }
  long double anyWithin(const Interval& bounds) {
    switch (std::uniform_int_distribution(0, 3)(random)) {
      case 0:
        return bounds.least;
      case 1:
        return bounds.most;
      default:
        return anyOf({bounds.least, bounds.most});
    }
  }
  template <typename Check>
  void forEachPrimitive(Check check) {
    LONGS_EQUAL(models.size(), shipped.size());
    for (std::size_t i = 0; i < models.size(); ++i) check(models[i], shipped[i]);
  }
};

TEST(Primitives, AreWhatTheFirmwareDoesAtEveryCorner) {
  forEachPrimitive([](const Primitive& model, const Primitive& own) {
    std::vector<Arguments> all{{}};
    for (const Domain& domain : model.domain) {
      std::vector<Arguments> longer;
      for (const Arguments& before : all)
        for (const long double corner : corners(domain)) {
          longer.push_back(before);
          longer.back().push_back(known(corner));
        }
      all = longer;
    }
    for (const Arguments& arguments : all) checkExact(model, own, arguments);
  });
}

TEST(Primitives, AreWhatTheFirmwareDoesOfAnyNumbers) {
  forEachPrimitive([&](const Primitive& model, const Primitive& own) {
    for (int trial = 0; trial < 500; ++trial) {
      Arguments arguments;
      for (const Domain& domain : model.domain) arguments.push_back(known(anyOf(domain)));
      checkExact(model, own, arguments);
    }
  });
}

TEST(Primitives, HaveBoundsThatHoldWhatTheFirmwareMakesOfNumbersWithin) {
  forEachPrimitive([&](const Primitive& model, const Primitive& own) {
    for (int trial = 0; trial < 200; ++trial) {
      Arguments bounds;
      for (const Domain& domain : model.domain) bounds.push_back(anyBounds(domain));
      const Interval result = modelled(model, bounds);
      for (int point = 0; point < 10; ++point) {
        Arguments numbers;
        for (const Interval& each : bounds) numbers.push_back(known(anyWithin(each)));
        const long double found = own.result(numbers.data()).least;
        if (found < result.least || found > result.most) FAIL(said(model.name, bounds).c_str());
      }
    }
  });
}
