#include "host/shape/curvature.hpp"

#include <cmath>

#include "host/contact/contact.hpp"

// last: its macros redefine new
#include <CppUTest/TestHarness.h>

using namespace strainfinger;
using namespace strainfinger::shape;

TEST_GROUP(Curvature) {
  const model::Annulus<double> finger{8.9e-3, 12.7e-3, 8.3e4, 0.5};
  const CurvatureScale scale{finger};

  contact::Contact contactOf(double radius_m, double load_n_per_m) const {
    contact::ContactRequest request;
    request.indenter = contact::Indenter::cylinder(radius_m);
    request.size = {contact::ContactSize::Kind::kLoad, load_n_per_m};
    return contact::solveContact(contact::SurfaceKernel(finger), request);
  }
};

// Known loads of a flat indenter, computed for this project before the solver was written.
TEST(Curvature, AFlatIndenterHasTheKnownLoads) {
  DOUBLES_EQUAL(21.4939181405, scale.flatLoad_n_per_m(2e-3 / 12.7e-3), 1e-9);
  DOUBLES_EQUAL(261.802646, scale.flatLoad_n_per_m(6e-3 / 12.7e-3), 1e-5);
}

TEST(Curvature, IsThatOfTheCylinderThatWasPressed) {
  for (const double radius_m : {1e-3, 5e-3, 1.0}) {
    const contact::Contact contact = contactOf(radius_m, 20);
    const double curvature = scale.of(contact.normal_n_per_m, contact.width_m / 12.7e-3).value_per_m;
    DOUBLES_EQUAL(1 / radius_m, curvature, 1e-6 / radius_m + 1e-6);
  }
}

TEST(Curvature, SlopesAreDerivatives) {
  const double load = 20, width = 0.2, step = 1e-4;
  const auto here = scale.of(load, width);
  const double toLoad = (scale.of(load * std::exp(step), width).value_per_m -
                         scale.of(load * std::exp(-step), width).value_per_m) /
                        (2 * step);
  const double toWidth = (scale.of(load, width * std::exp(step)).value_per_m -
                          scale.of(load, width * std::exp(-step)).value_per_m) /
                         (2 * step);
  DOUBLES_EQUAL(1, here.toLogLoad_per_m / toLoad, 1e-6);
  DOUBLES_EQUAL(1, here.toLogWidth_per_m / toWidth, 1e-5);
}
