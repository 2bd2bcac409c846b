#include "host/contact/contact.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "host/base/failure.hpp"
#include "host/contact/surface_motion.hpp"
#include "tests/host/contact/fingers.hpp"
#include "tests/host/contact/known_contacts.hpp"
#include "tests/host/contact/requests.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::contact;
using namespace strainfinger::testing;

namespace {

void equalRelative(double known, double value, double tolerance) {
  DOUBLES_EQUAL(known, value, tolerance * std::abs(known));
}

/// Pressure nowhere negative, the surface nowhere above the indenter. Lengths in m.
void isUnilateral(const ContactRequest& request, const model::Annulus<double>& finger = kDefaultFinger) {
  const SurfaceKernel kernel(finger);
  const Contact contact = solveContact(kernel, request);
  const SurfaceMotion motion(kernel, contact.tractions);
  const double half_rad = contact.width_m / (2 * finger.outer_radius_m);
  for (double x = -0.9995; x < 1; x += 0.01)
    CHECK_TRUE(tractionAt(contact.tractions, contact.offset_rad + half_rad * x).pressure_pa > 0);
  for (const double distance : {1e-4, 1e-3, 1e-2, 0.1, 0.3, 1.0, 2.0})
    for (const double side : {-1.0, 1.0}) {
      const double angle_rad = contact.offset_rad + side * half_rad * (1 + distance);
      const double x_m = finger.outer_radius_m * angle_rad;
      const double indenter_m = x_m * angle_rad / 2 + request.indenter.height(x_m) - contact.approach_m;
      CHECK_TRUE(motion.at(angle_rad).ur_m < indenter_m + 1e-12);
    }
}

/// Other points of collocation, more than twice the terms, on the patch that was found: tractions, load, and
/// the tilt, which a contact off its place has: slope times the distance.
void isFoundByMoreTerms(const ContactRequest& request, const model::Annulus<double>& finger) {
  const SurfaceKernel kernel(finger);
  const Contact contact = solveContact(kernel, request);
  const Patch& patch = contact.tractions[0].patch;
  const PatchSolution finer = SpectralSolver(kernel, request.regime, request.friction, 2 * contact.terms + 5)
                                  .solve({patch}, request.indenter, request.tangential_n_per_m);
  const double peak_pa = tractionAt(finer.tractions, contact.offset_rad + 0.3 * patch.half_rad).pressure_pa;
  equalRelative(kSurface_m * totalTraction(finer.tractions).pressure_pa, contact.normal_n_per_m, 1e-11);
  DOUBLES_EQUAL(0, finer.tilt_m[0], 1e-9 * patch.half_rad * kSurface_m);
  for (const double x : {-0.999, -0.7, 0.05, 0.3, 0.99}) {
    const double angle_rad = contact.offset_rad + x * patch.half_rad;
    const Traction known = tractionAt(finer.tractions, angle_rad),
                   value = tractionAt(contact.tractions, angle_rad);
    DOUBLES_EQUAL(known.pressure_pa, value.pressure_pa, 1e-10 * peak_pa);
    DOUBLES_EQUAL(known.shear_pa, value.shear_pa, 1e-10 * peak_pa);
  }
  CHECK_TRUE(contact.residual_m < 1e-10 * contact.depth_m);
}

}  // namespace

TEST_GROUP(Contact) {};

TEST(Contact, AMeasuredPlaneAndAMeasuredParabolaAreWhatTheyAre) {
  for (const bool isFlat : {true, false})
    for (const ContactRequest& size : {ofWidth(2e-3), ofLoad(20), ofLoad(1e-3)}) {
      ContactRequest known = size, request = size;
      known.indenter = isFlat ? Indenter::flat() : Indenter::cylinder(5e-3);
      request.indenter = measured([&](double x) { return isFlat ? 0 : x * x / 10e-3; });
      const Contact contact = solve(request);
      equalRelative(solve(known).normal_n_per_m, contact.normal_n_per_m, 1e-10);
      equalRelative(solve(known).width_m, contact.width_m, 1e-10);
      DOUBLES_EQUAL(0, contact.offset_rad, 1e-9);
      LONGS_EQUAL(0, contact.warnings.size());
    }
}

// Turned by a slope s a flat indenter touches r_b theta = -s r_b off.
TEST(Contact, ATiltedPlaneTouchesBesideItsOrigin) {
  ContactRequest request = ofLoad(20);
  request.indenter = measured([](double x) { return 0.05 * x; });
  const Contact contact = solve(request);
  equalRelative(1.932184257e-3, contact.width_m, 1e-9);
  DOUBLES_EQUAL(-0.05, contact.offset_rad, 1e-9);
}

TEST(Contact, WavesTouchInRegionsAsManyAsTheLoadMakes) {
  const auto regions = [](double load_n_per_m) {
    ContactRequest request = ofLoad(load_n_per_m);
    request.indenter = waves();
    const Contact contact = solve(request);
    LONGS_EQUAL(0, contact.warnings.size());  // nothing pulls, nothing penetrates
    equalRelative(load_n_per_m, contact.normal_n_per_m, 1e-11);
    return contact.tractions.size();
  };
  LONGS_EQUAL(1, regions(1e-3));
  LONGS_EQUAL(1, regions(1));
  LONGS_EQUAL(3, regions(20));
}

TEST(Contact, RegionsOfASlidingContactFitTheirIndenter) {
  ContactRequest request = ofLoad(20);
  request.indenter = waves();
  request.regime = Regime::kSliding;
  request.friction = 0.5;
  const Contact contact = solve(request);
  LONGS_EQUAL(3, contact.tractions.size());
  CHECK_TRUE(contact.residual_m < 1e-13);
  equalRelative(10, contact.tangential_n_per_m, 1e-11);
}

TEST(Contact, RegionsHaveTheWidthAskedFor) {
  ContactRequest request = ofWidth(2.1e-3);
  request.indenter = waves();
  const Contact contact = solve(request);
  LONGS_EQUAL(3, contact.tractions.size());
  equalRelative(2.1e-3, contact.width_m, 1e-11);
}

TEST(Contact, AWidthThatIsJumpedOverFails) {
  ContactRequest request = ofWidth(1.5e-3);
  request.indenter = waves();
  CHECK_THROWS(Failure, solve(request));
}

TEST(Contact, AShapeThatEndsWithinTheContactFails) {
  ContactRequest request = ofLoad(300);
  request.indenter = Indenter::measured({-1e-3, -0.5e-3, 0.5e-3, 1e-3}, {0, 0, 0, 0});
  CHECK_THROWS(Failure, solve(request));
}

TEST(Contact, FlatContactsHaveTheKnownLoadsAndPeaks) {
  for (const KnownFlat& known : kKnownFlats) {
    const Contact contact = solve(ofWidth(2 * known.half_m));
    equalRelative(known.load_n_per_m, contact.normal_n_per_m, 2e-9);  // what the digits resolve
    equalRelative(known.peak_pa, tractionAt(contact.tractions, 0).pressure_pa, 2e-9);
  }
}

TEST(Contact, TheContactOfTwoMillimetresIsKnownToTwelveDigits) {
  const Contact contact = solve(ofWidth(2e-3));
  DOUBLES_EQUAL(21.4939181405, contact.normal_n_per_m, 5.1e-11);
  DOUBLES_EQUAL(13686.2526384, tractionAt(contact.tractions, 0).pressure_pa, 5.1e-8);
  DOUBLES_EQUAL(72.0332531e-6, contact.depth_m, 5.1e-14);
  CHECK_TRUE(contact.residual_m < 1e-17);
  DOUBLES_EQUAL(0, contact.offset_rad, 0);
}

// P = pi E* a^2 / (4 r_b), p0 = E* a / (2 r_b), E* = 4 mu.
TEST(Contact, ANarrowContactIsHertzian) {
  const double half_m = 0.05e-3, modulus_pa = 4 * kDefaultFinger.shear_modulus_pa;
  const Contact contact = solve(ofWidth(2 * half_m));
  equalRelative(std::numbers::pi * modulus_pa * half_m * half_m / (4 * kSurface_m), contact.normal_n_per_m,
                1e-4);
  for (const double x : {0.0, 0.5, -0.9, 0.99}) {
    const double known = modulus_pa * half_m / (2 * kSurface_m) * std::sqrt(1 - x * x);
    equalRelative(known, tractionAt(contact.tractions, x * half_m / kSurface_m).pressure_pa, 1.1e-4);
  }
}

TEST(Contact, OtherFingersAreStifferThanHertz) {
  for (const KnownFinger& known : kKnownFingers) {
    const auto finger = fingerOf(known.alpha, known.poissonRatio);
    const double modulus_pa = 2 * finger.shear_modulus_pa / (1 - known.poissonRatio);
    const double hertz = std::numbers::pi * modulus_pa * 1e-6 / (4 * kSurface_m);
    equalRelative(known.overHertz, solve(ofWidth(2e-3), finger).normal_n_per_m / hertz, 1e-6);
  }
}

TEST(Contact, ALoadHasTheKnownWidth) {
  for (const KnownWidth& known : kKnownWidths) {
    const Contact contact = solve(ofLoad(known.load_n_per_m));
    equalRelative(known.width_m, contact.width_m, 1.2e-9);
    equalRelative(known.load_n_per_m, contact.normal_n_per_m, 1e-12);
  }
}

TEST(Contact, LoadAndWidthAreInverses) {
  for (const double width_m : {1e-6, 1e-3, 12e-3, 30e-3}) {
    const double load = solve(ofWidth(width_m)).normal_n_per_m;
    equalRelative(width_m, solve(ofLoad(load)).width_m, 1e-11);
  }
}

// u_r's slope is r_b (1 + r_b / R) theta: the same contact, scaled.
TEST(Contact, ACylinderScalesTheFlatContact) {
  ContactRequest request = ofWidth(2e-3);
  request.indenter = Indenter::cylinder(5e-3);
  equalRelative(21.4939181405 * (1 + 12.7 / 5), solve(request).normal_n_per_m, 1e-11);
}

TEST(Contact, AWedgeCarriesTheKnownLoad) {
  for (const KnownWedge& known : kKnownWedges) {
    ContactRequest request = ofWidth(2e-3);
    request.indenter = Indenter::wedge(known.half_angle_deg);
    const Contact contact = solve(request);
    equalRelative(known.load_n_per_m, contact.normal_n_per_m, 1e-6);
    CHECK_TRUE(contact.residual_m < 1e-6 * contact.depth_m);
  }
}

// All that is singular below the tip is known: the rest converges as below a smooth indenter.
TEST(Contact, MoreTermsFindTheSameContactBelowAWedge) {
  for (const double alpha : {0.7, 0.93})
    for (const double width_m : {1e-3, 6e-3})
      for (ContactRequest request : {ofWidth(2e-3), sliding(0.5), sliding(-1), sticking(0), sticking(10)}) {
        request.indenter = Indenter::wedge(75);
        request.size.value = width_m;
        isFoundByMoreTerms(request, fingerOf(alpha, 0.5));
      }
}

// At 13 nm a wedge's faces rise 300,000 times as much as a plane bends away.
TEST(Contact, AWedgeSlidesOnTheNarrowestContactToo) {
  for (const double poissonRatio : {0.5, 0.3}) {
    ContactRequest request = sliding(0.5);
    request.indenter = Indenter::wedge(80);
    request.size.value = 1e-6 * kSurface_m;
    const Contact contact = solve(request, fingerOf(0.7, poissonRatio));
    CHECK_TRUE(contact.warnings.empty());
    CHECK_TRUE(contact.residual_m < 1e-6 * contact.deepest_m);
  }
}

// Below nu = 1/2 tractions have a step at the tip besides, and other exponents at the edges.
TEST(Contact, AWedgeThatSlidesOnCompressibleRubberPressesAllOver) {
  for (const double poissonRatio : {0.45, 0.3, 0.0})
    for (const double friction : {0.5, -1.0})
      for (const double width_m : {2e-3, 6e-3}) {
        ContactRequest request = sliding(friction);
        request.indenter = Indenter::wedge(80);
        request.size.value = width_m;
        const Contact contact = solve(request, fingerOf(0.7, poissonRatio));
        CHECK_TRUE(contact.warnings.empty());
        CHECK_TRUE(contact.residual_m < 1e-6 * contact.depth_m);
        const auto finer =
            SpectralSolver(SurfaceKernel(fingerOf(0.7, poissonRatio)), Regime::kSliding, friction, 80)
                .solve({contact.tractions[0].patch}, request.indenter, 0);
        equalRelative(kSurface_m * totalTraction(finer.tractions).pressure_pa, contact.normal_n_per_m, 2e-6);
        DOUBLES_EQUAL(0, finer.tilt_m[0], 2e-6 * contact.depth_m);
      }
}

TEST(Contact, SlidingMovesTheContactAsKnown) {
  for (const KnownSliding& known : kKnownSliding) {
    const Contact contact = solve(sliding(known.friction), fingerOf(8.9 / 12.7, known.poissonRatio));
    equalRelative(known.load_n_per_m, contact.normal_n_per_m, known.loadTolerance);
    equalRelative(known.offset_m, contact.offset_rad * kSurface_m, known.offsetTolerance);
    equalRelative(known.depth_m, contact.depth_m, known.poissonRatio == 0.5 ? 1e-9 : 1e-5);
    equalRelative(known.friction * contact.normal_n_per_m, contact.tangential_n_per_m, 1e-14);
  }
}

TEST(Contact, SlidingTheOtherWayIsItsMirrorImage) {
  for (const double poissonRatio : {0.5, 0.4}) {
    const auto finger = fingerOf(0.7, poissonRatio);
    const Contact to = solve(sliding(0.8), finger), fro = solve(sliding(-0.8), finger);
    equalRelative(to.normal_n_per_m, fro.normal_n_per_m, 1e-11);
    equalRelative(-to.offset_rad, fro.offset_rad, 1e-9);
  }
}

TEST(Contact, StickingCarriesTheKnownLoads) {
  const Contact still = solve(sticking(0)), rubbed = solve(sticking(10.746959));
  DOUBLES_EQUAL(21.7513727, still.normal_n_per_m, 5.1e-8);
  DOUBLES_EQUAL(71.3844240e-6, still.depth_m, 5.1e-14);
  DOUBLES_EQUAL(13854.50, tractionAt(still.tractions, 0).pressure_pa, 5.1e-3);
  DOUBLES_EQUAL(21.7513727, rubbed.normal_n_per_m, 5.1e-8);
  DOUBLES_EQUAL(10.746959, rubbed.tangential_n_per_m, 1e-12);
  DOUBLES_EQUAL(0.06135e-3, rubbed.offset_rad * kSurface_m, 5.1e-9);
  DOUBLES_EQUAL(75.44e-6, rubbed.shift_m, 5.1e-9);
}

// Shear over pressure passes 1/2 at x/a = 0.880 and 1 at 0.940: full stick is a limit, not a law of friction.
TEST(Contact, StickingNeedsEndlessFrictionAtItsEdges) {
  const Contact contact = solve(sticking(0));
  const auto ratio = [&](double x) {
    const Traction traction = tractionAt(contact.tractions, x * 1e-3 / kSurface_m);
    return std::abs(traction.shear_pa) / traction.pressure_pa;
  };
  DOUBLES_EQUAL(0.5, ratio(0.880), 0.005);
  DOUBLES_EQUAL(1, ratio(0.940), 0.02);
}

TEST(Contact, NothingPullsAndNothingPenetrates) {
  for (const Indenter& indenter : {Indenter::flat(), Indenter::cylinder(2e-3), Indenter::wedge(70)})
    for (const double load_n_per_m : {1e-3, 3.0, 200.0}) {
      ContactRequest request = ofLoad(load_n_per_m);
      request.indenter = indenter;
      isUnilateral(request);
    }
}

TEST(Contact, NothingPenetratesWithFrictionOrInAThinLayer) {
  for (const double friction : {0.5, -1.0}) isUnilateral(sliding(friction));
  for (const double alpha : {0.5, 0.85, 0.93})
    for (const double width_m : {0.5e-3, 6e-3}) isUnilateral(ofWidth(width_m), fingerOf(alpha, 0.5));
  isUnilateral(ofWidth(4e-3), fingerOf(0.7, 0.3));
}

TEST(Contact, ThinLayersAndWideContactsConverge) {
  for (const double alpha : {0.7, 0.85, 0.93, 0.97})
    for (const double width_m : {0.5e-3, 2e-3, 6e-3}) {
      const Contact contact = solve(ofWidth(width_m), fingerOf(alpha, 0.5));
      CHECK_TRUE(contact.residual_m < 1e-11 * contact.depth_m);
      CHECK_TRUE(contact.warnings.empty());
    }
}

// alpha 0.7 to 0.93, 0.5 to 6 mm: load to 1e-11 (8e-13 here), tractions to 1e-10 of the peak (4e-12), the
// centre to 1e-9 rad.
TEST(Contact, MoreTermsFindTheSameContactInEveryRegimeAndFinger) {
  for (const double alpha : {8.9 / 12.7, 0.7, 0.85, 0.93})
    for (const double width_m : {0.5e-3, 2e-3, 4e-3, 6e-3})
      for (ContactRequest request : {ofWidth(2e-3), sliding(0.5), sliding(1), sticking(0), sticking(10)}) {
        request.size.value = width_m;
        isFoundByMoreTerms(request, fingerOf(alpha, 0.5));
      }
}

TEST(Contact, OfGivenLoadMoreTermsFindTheSameWidth) {
  for (const double alpha : {0.7, 0.93})
    for (ContactRequest request : {ofLoad(1), sliding(0.5), sticking(0)}) {
      request.size = {ContactSize::Kind::kLoad, 20};
      isFoundByMoreTerms(request, fingerOf(alpha, 0.5));
    }
}

// By the numpy reference of known_contacts.hpp; friction takes 5 % off the frictionless load.
TEST(Contact, SlidingOnAThinLayerCarriesTheKnownLoad) {
  equalRelative(41.974701, solve(ofWidth(2e-3), fingerOf(0.93, 0.5)).normal_n_per_m, 2e-8);
  equalRelative(39.767612, solve(sliding(1), fingerOf(0.93, 0.5)).normal_n_per_m, 2e-8);
}

TEST(Contact, WhatIsNotResolvedAtAllIsNoAnswer) {
  const auto thin = fingerOf(0.99, 0.5);
  CHECK_FALSE(solve(ofWidth(10e-3), thin).warnings.empty());
  CHECK_THROWS(Failure, solve(ofWidth(20e-3), thin));
}

TEST(Contact, RefusesWhatIsOutsideItsDomain) {
  const double nan = std::nan(""), infinity = std::numeric_limits<double>::infinity();
  for (const double value : {0.0, -1.0, nan, infinity}) {
    CHECK_THROWS(Failure, solve(ofWidth(value)));
    CHECK_THROWS(Failure, solve(ofLoad(value)));
  }
  CHECK_THROWS(Failure, solve(ofWidth(40e-3)));
  CHECK_THROWS(Failure, solve(ofLoad(1e9)));
  CHECK_THROWS(Failure, solve(sliding(11)));
  CHECK_THROWS(Failure, solve(sliding(nan)));
}

// A bonded incompressible layer of thickness h below a half contact a >> h (lubrication): under a flat
// indenter, whose profile on the finger is x^2 / 2 r_b, P = 2 mu a^5 / 15 r_b h^3, here with the edges'
// share, some thicknesses, on top. The load that the other way round gives is the same.
TEST(Contact, OfAThinLayerTheLoadFindsItsNarrowContact) {
  constexpr double kLayer_m = 5e-6, kLoad_n_per_m = 10;
  const model::Annulus<double> thin = fingerOf(1 - kLayer_m / kSurface_m, 0.5);
  const SurfaceKernel kernel(thin);
  const Contact contact = solveContact(kernel, ofLoad(kLoad_n_per_m));
  const double half_m =
      std::pow(7.5 * kLoad_n_per_m * kSurface_m * std::pow(kLayer_m, 3) / thin.shear_modulus_pa, 0.2);
  DOUBLES_EQUAL(half_m, contact.width_m / 2 + 1.5 * kLayer_m, 0.2 * kLayer_m);
  equalRelative(kLoad_n_per_m, solveContact(kernel, ofWidth(contact.width_m)).normal_n_per_m, 1e-6);
}

TEST(Contact, TooWideForAThinLayerIsSaidAtOnce) {
  const SurfaceKernel kernel(fingerOf(1 - 1e-6 / kSurface_m, 0.5));
  CHECK_THROWS(Failure, solveContact(kernel, ofWidth(1e-3)));
}
