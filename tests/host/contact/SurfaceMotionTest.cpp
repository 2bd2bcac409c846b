#include "host/contact/surface_motion.hpp"

#include <array>
#include <cmath>

#include "host/model/surface_field.hpp"
#include "tests/host/contact/fingers.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::contact;
using namespace strainfinger::testing;

TEST_GROUP(SurfaceMotion) {
  static constexpr double kPressure_pa = 1000, kFriction = 0.7;
  static constexpr Patch kPatch{0.1, 0.2};

  /// Uniform tractions: what the closed form of model::computeSurfaceField() is for.
  static Tractions uniform() {
    PatchTractions part;
    part.patch = kPatch;
    part.smooth = {{0, 0}, Eigen::VectorXd::Constant(1, kPressure_pa * std::sqrt(2.0))};
    part.friction = kFriction;
    return {part};
  }

  static Eigen::MatrixXd knownAt(const model::Annulus<double>& finger, double angle_rad) {
    const double load = kPressure_pa * 2 * kPatch.half_rad * kSurface_m;
    const model::SurfaceLoad same{load, kFriction * load, kPatch.centre_rad, 2 * kPatch.half_rad};
    return computeSurfaceField(finger, same, std::array{angle_rad},
                               std::array{model::kUr, model::kUt, model::kEtt});
  }
};

TEST(SurfaceMotion, AgreesWithTheClosedFormOfAUniformLoad) {
  for (const double poissonRatio : {0.5, 0.3}) {
    const auto finger = fingerOf(0.7, poissonRatio);
    const SurfaceKernel kernel(finger);
    const SurfaceMotion motion(kernel, uniform());
    for (const double angle_rad : {0.0, 0.15, 0.2999, 0.3001, 0.5, -0.7, 3.0}) {
      const SurfacePoint point = motion.at(angle_rad);
      const Eigen::MatrixXd known = knownAt(finger, angle_rad);
      DOUBLES_EQUAL(known(0, 0), point.ur_m, 2e-17);  // of 4e-5 m
      DOUBLES_EQUAL(known(0, 1), point.ut_m, 2e-17);
      DOUBLES_EQUAL(known(0, 2), (point.ur_m + point.utSlope_m) / kSurface_m, 1e-14);  // of 1e-2
    }
  }
}

TEST(SurfaceMotion, SlopesAreDerivatives) {
  const SurfaceKernel kernel(fingerOf(0.7, 0.3));
  const SurfaceMotion motion(kernel, uniform());
  const double step = 1e-5;
  for (const double angle_rad : {0.0, 0.25, 0.6, -1.0}) {
    const double rise = motion.at(angle_rad + step).ur_m - motion.at(angle_rad - step).ur_m;
    DOUBLES_EQUAL(rise / (2 * step), motion.at(angle_rad).urSlope_m, 1e-7 * 1e-4);
  }
}

TEST(SurfaceMotion, AddsPatchesUp) {
  const SurfaceKernel kernel(kDefaultFinger);
  Tractions other = uniform();
  other[0].patch.centre_rad = 1;
  const Tractions both{uniform()[0], other[0]};
  const double sum =
      SurfaceMotion(kernel, uniform()).at(0.4).ur_m + SurfaceMotion(kernel, other).at(0.4).ur_m;
  DOUBLES_EQUAL(sum, SurfaceMotion(kernel, both).at(0.4).ur_m, 1e-19);
}
