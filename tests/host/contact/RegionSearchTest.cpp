#include "host/contact/region_search.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "host/base/angles.hpp"
#include "host/base/failure.hpp"
#include "host/contact/overlap.hpp"
#include "host/contact/surface_motion.hpp"
#include "tests/host/contact/fingers.hpp"
#include "tests/host/contact/requests.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::contact;
using namespace strainfinger::testing;

namespace {

constexpr unsigned kSeed = 2026;  // of the first random shape, the next has the next

/// Every 2 um over +-2.5 mm.
template <typename Height>
Indenter finelyMeasured(Height height) {
  std::vector<double> x, y;
  for (int i = -1250; i <= 1250; ++i) {
    x.push_back(i * 2e-6);
    y.push_back(height(x.back()));
  }
  return Indenter::measured(x, y);
}

double bump(double x_m, double at_m, double width_m, double height_m) {
  return -height_m * std::exp(-std::pow((x_m - at_m) / width_m, 2));
}

/// 3 to 10 um wide, 10 to 40 um high, 0.5 to 0.8 mm from the normal.
Indenter randomBump(std::mt19937& random) {
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  const double width_m = draw(3e-6, 10e-6);
  const double height_m = draw(10e-6, 40e-6), at_m = std::copysign(draw(0.5e-3, 0.8e-3), draw(-1, 1));
  return finelyMeasured([=](double x) { return bump(x, at_m, width_m, height_m); });
}

/// Two of 100 to 500 um, 10 to 100 um high, within 1 mm of the normal.
Indenter randomBumps(std::mt19937& random) {
  const auto draw = [&](double low, double high) {
    return std::uniform_real_distribution<double>(low, high)(random);
  };
  std::array<double, 6> drawn{};
  for (std::size_t i = 0; i < 6; i += 3) {
    drawn[i] = draw(-1e-3, 1e-3);
    drawn[i + 1] = draw(100e-6, 500e-6);
    drawn[i + 2] = draw(10e-6, 100e-6);
  }
  return measured([=](double x) {
    return bump(x, drawn[0], drawn[1], drawn[2]) + bump(x, drawn[3], drawn[4], drawn[5]);
  });
}

/// Between the edges of the regions.
double leastPressure_pa(const Contact& contact) {
  double least_pa = std::numeric_limits<double>::infinity();
  for (const PatchTractions& part : contact.tractions)
    for (double x = -0.999; x < 1; x += 0.001) {
      const double angle_rad = part.patch.centre_rad + x * part.patch.half_rad;
      least_pa = std::min(least_pa, tractionAt(contact.tractions, angle_rad).pressure_pa);
    }
  return least_pa;
}

/// How deep the shape is inside the rubber at a measured point where nothing presses; there must be one.
double deepestInside_m(const Indenter& indenter, const Contact& contact) {
  const SurfaceKernel kernel(kDefaultFinger);
  const SurfaceMotion motion(kernel, contact.tractions);
  constexpr double kNone = -std::numeric_limits<double>::infinity();
  double deepest_m = kNone;
  for (const double x_m : indenter.positions_m()) {
    const double angle_rad = x_m / kSurface_m;
    if (tractionAt(contact.tractions, angle_rad).pressure_pa != 0) continue;
    const double above_m = x_m * angle_rad / 2 + indenter.height(x_m) - contact.approach_m;
    deepest_m = std::max(deepest_m, motion.displacementAt(angle_rad).ur_m - above_m);
  }
  CHECK_TRUE_TEXT(deepest_m > kNone, "every measured point is pressed");
  return deepest_m;
}

std::string refusalOf(const ContactRequest& request) {
  try {
    solve(request);
  } catch (const Failure& failure) {
    return failure.what();
  }
  return "";
}

}  // namespace

TEST_GROUP(RegionSearch) {};

// A quarter of a cell, 39 um over the whole shape, away from where cells look by themselves.
TEST(RegionSearch, ABumpOfFourMicrometresBesideTheContactTouches) {
  for (const double at_m : {-0.791e-3, 0.9086e-3}) {
    ContactRequest request = ofLoad(5);
    request.indenter = finelyMeasured([=](double x) { return bump(x, at_m, 4e-6, 60e-6); });
    const Contact contact = solve(request);
    LONGS_EQUAL(2, contact.tractions.size());
    const Patch& touch = contact.tractions[at_m > 0].patch;
    DOUBLES_EQUAL(at_m, kSurface_m * touch.centre_rad, 4e-6);
    CHECK_TRUE(deepestInside_m(request.indenter, contact) < 1e-12 + contact.residual_m);
  }
}

// The spline is smooth about the tip, for as many terms as resolve the distance of points; fewer ring there.
TEST(RegionSearch, AMeasuredWedgeIsNearlyTheWedgeAndSaysHowNearly) {
  const double slope = std::tan(10 * kRadPerDeg);
  for (ContactRequest request : {ofWidth(1e-3), ofWidth(2e-3), ofLoad(20), ofLoad(60)}) {
    request.indenter = Indenter::wedge(80);
    const Contact known = solve(request);
    request.indenter = measured([=](double x) { return slope * std::abs(x); });
    const Contact contact = solve(request);
    DOUBLES_EQUAL(known.normal_n_per_m, contact.normal_n_per_m, 1e-3 * known.normal_n_per_m);
    DOUBLES_EQUAL(known.width_m, contact.width_m, 1e-3 * known.width_m);
    LONGS_EQUAL(contact.residual_m > 1e-6 * contact.depth_m, contact.warnings.size());
  }
}

TEST(RegionSearch, NoRandomBumpIsInsideTheRubber) {
  std::size_t regions = 0;
  for (const bool isNarrow : {true, false})
    for (unsigned seed = kSeed; seed < kSeed + (isNarrow ? 3 : 8); ++seed) {
      std::mt19937 random(seed);
      ContactRequest request = ofLoad(isNarrow ? 4 : 30);
      request.indenter = isNarrow ? randomBump(random) : randomBumps(random);
      const Contact contact = solve(request);
      const std::string text = "seed " + std::to_string(seed);
      CHECK_TRUE_TEXT(deepestInside_m(request.indenter, contact) < 1e-12, text.c_str());
      CHECK_TRUE_TEXT(contact.residual_m < 1e-12, text.c_str());
      CHECK_TRUE_TEXT(leastPressure_pa(contact) >= 0, text.c_str());
      regions += contact.tractions.size();
    }
  CHECK_TRUE(regions > 14);  // or few bumps touched
}

// Shares and widths, per nm, of the table in limits.md; the plane without noise has the known width.
TEST(RegionSearch, NoiseThatIsSolvedTellsWhatItLeaves) {
  for (const double noise_nm : {1.0, 10.0}) {
    std::mt19937 random(8);
    std::normal_distribution<double> noise(0, noise_nm * 1e-9);
    ContactRequest request = ofLoad(20);
    request.indenter = measured([&](double) { return noise(random); });
    const Contact contact = solve(request);
    STRCMP_CONTAINS("inaccurate: 160 terms", contact.warnings.at(0).c_str());
    CHECK_TRUE(contact.residual_m < 2e-5 * noise_nm * contact.deepest_m);
    DOUBLES_EQUAL(1.932184257e-3, contact.width_m, 2e-4 * noise_nm * contact.width_m);
  }
}

TEST(RegionSearch, NoiseEndsInAnErrorThatTellsWhatToDo) {
  for (const double noise_m : {1e-6, 20e-6}) {
    std::mt19937 random(7);
    std::normal_distribution<double> noise(0, noise_m);
    ContactRequest request = ofLoad(20);
    request.indenter = measured([&](double) { return noise(random); });
    STRCMP_CONTAINS("smooth the profile", refusalOf(request).c_str());
  }
}

TEST(RegionSearch, AWidthThatBumpsBesideItForbidAreRefused) {
  ContactRequest request = ofWidth(1.6e-3);
  request.indenter = finelyMeasured([](double x) { return bump(std::abs(x), 0.9e-3, 20e-6, 60e-6); });
  STRCMP_CONTAINS("its width jumps", refusalOf(request).c_str());
}

TEST(RegionSearch, AHollowThatTouchesAtTheEndOfItsMeasurementIsRefused) {
  for (ContactRequest request : {ofLoad(20), ofWidth(1e-3)}) {
    request.indenter = measured([](double x) { return -std::abs(x); });
    STRCMP_CONTAINS("nearest to the finger at its end", refusalOf(request).c_str());
  }
}

TEST(RegionSearch, AWidthBeyondTheShapeIsRefused) {
  ContactRequest request = ofWidth(6e-3);
  request.indenter = finelyMeasured([](double) { return 0.0; });
  STRCMP_CONTAINS("only 0.005 m long", refusalOf(request).c_str());
}

// The tractions of a plane, then a spike of 1 um 0.2 mm beside them, where the gap is known.
TEST(RegionSearch, OverlapsAreFoundWithTheirDepth) {
  const SurfaceKernel kernel(kDefaultFinger);
  const Contact contact = solve(ofWidth(1e-3));
  const double x_m = 0.7e-3, angle_rad = x_m / kSurface_m;
  const double gap_m =
      x_m * angle_rad / 2 - contact.approach_m - SurfaceMotion(kernel, contact.tractions).at(angle_rad).ur_m;
  for (const double height_m : {gap_m - 20e-9, gap_m + 20e-9}) {
    const Indenter spiked = finelyMeasured([=](double x) { return bump(x, x_m, 6e-6, height_m); });
    const auto overlaps = findOverlaps(kernel, spiked, contact.tractions, contact.approach_m, 1e-12);
    LONGS_EQUAL(height_m > gap_m, overlaps.size());
    if (overlaps.empty()) continue;
    DOUBLES_EQUAL(x_m, kSurface_m * overlaps[0].deepest_rad, 1e-6);
    CHECK_TRUE(overlaps[0].depth_m > 20e-9 && overlaps[0].depth_m < 40e-9);  // its tip leans to the contact
  }
}
