#include "host/contact/contact_field.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include "host/base/failure.hpp"
#include "host/contact/contact.hpp"
#include "host/model/field.hpp"
#include "tests/host/contact/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::contact;
using namespace strainfinger::model;
using namespace strainfinger::testing;

namespace {

constexpr std::array kAllRows{kTrr, kTrt, kTtt, kUr, kUt, kErr, kEtt, kErt};
constexpr std::array kAngles_rad{0.0, 0.05, -0.2, 2.0};

/// Uniform tractions over 0.2 rad, as a contact would exert them and as the model knows them.
Tractions uniform() {
  PatchTractions part;
  part.patch = {0, 0.1};
  part.smooth = {{0, 0}, Eigen::VectorXd::Constant(1, 500 * std::sqrt(2.0))};
  part.friction = 0.7;
  return {part};
}

constexpr double kLoad_n_per_m = 500 * 0.2 * kSurface_m;
constexpr SurfaceLoad kUniform{kLoad_n_per_m, 0.7 * kLoad_n_per_m, 0, 0.2};

Eigen::MatrixXd fieldOf(const SurfaceKernel& kernel, const Tractions& tractions, double radius_m) {
  return computeContactField(kernel, tractions, radius_m, kAngles_rad, kAllRows);
}

}  // namespace

TEST_GROUP(ContactField) {};

TEST(ContactField, AgreesWithTheModelUnderAUniformLoad) {
  for (const double poissonRatio : {0.5, 0.3})
    for (const double radius_m : {8.9e-3, 9.4e-3, 12e-3, kSurface_m}) {
      const auto finger = fingerOf(8.9e-3 / kSurface_m, poissonRatio);
      const double at_m = std::max(radius_m, finger.core_radius_m);
      const auto field = fieldOf(SurfaceKernel(finger), uniform(), at_m);
      const auto known = computeField(finger, at_m, kUniform, kAngles_rad, kAllRows);
      for (Eigen::Index i = 0; i < field.cols(); ++i) {
        const double peak = known.col(i).cwiseAbs().maxCoeff();
        DOUBLES_EQUAL(0, (field - known).col(i).cwiseAbs().maxCoeff(), 1e-12 * peak);
      }
    }
}

// A contact's strains at the gauges against a line load's: within 7.4 % at 2 mm, at 0.2 mm the same to 1e-3.
TEST(ContactField, ANarrowContactIsALineLoadToTheGauges) {
  const SurfaceKernel kernel(kDefaultFinger);
  ContactRequest narrow;
  narrow.size.value = 0.2e-3;
  const Contact contact = solveContact(kernel, narrow);
  const SurfaceLoad line{contact.normal_n_per_m, 0, 0, 0};
  const double peak = computeField(kDefaultFinger, 9.4e-3, line, std::array{0.0}, std::array{kErr})(0, 0);
  const double value =
      computeContactField(kernel, contact.tractions, 9.4e-3, std::array{0.0}, std::array{kErr})(0, 0);
  DOUBLES_EQUAL(1, value / peak, 1e-3);
  CHECK_TRUE(value / peak < 1);
}

TEST(ContactField, TheSurfaceUnderAnIndenterHasItsShape) {
  const SurfaceKernel kernel(kDefaultFinger);
  const Contact contact = solveContact(kernel, {});
  const auto field = fieldOf(kernel, contact.tractions, kSurface_m);
  for (const Eigen::Index k : {0, 1}) {
    const double angle_rad = kAngles_rad[static_cast<std::size_t>(k)];
    DOUBLES_EQUAL(kSurface_m * angle_rad * angle_rad / 2 - contact.depth_m, field(k, 3), 1e-16);
    DOUBLES_EQUAL(-tractionAt(contact.tractions, angle_rad).pressure_pa, field(k, 0), 0);
  }
  DOUBLES_EQUAL(0, field(2, 0), 0);
}

TEST(ContactField, IsContinuousUpToTheSurface) {
  const SurfaceKernel kernel(fingerOf(0.7, 0.4));
  ContactRequest sliding;
  sliding.regime = Regime::kSliding;
  sliding.friction = 0.5;
  const Contact contact = solveContact(kernel, sliding);
  const auto surface = fieldOf(kernel, contact.tractions, kSurface_m);
  const auto below = [&](double depth) {
    return fieldOf(kernel, contact.tractions, kSurface_m * (1 - depth));
  };
  const Eigen::MatrixXd above = 3 * below(2e-3) - 3 * below(4e-3) + below(6e-3);  // parabolas
  for (const Eigen::Index row : {0, 1, 2, 5, 6, 7})
    DOUBLES_EQUAL(surface(1, row), above(1, row), 0.01 * surface.col(row).cwiseAbs().maxCoeff());
}

TEST(ContactField, RefusesWhatItCannotSum) {
  const SurfaceKernel kernel(kDefaultFinger);
  for (const double radius_m : {8e-3, 12.699e-3, 12.8e-3, std::nan("")})
    CHECK_THROWS(Failure, fieldOf(kernel, uniform(), radius_m));
}
