#pragma once
// What tests of contacts ask for.

#include <cmath>
#include <numbers>
#include <vector>

#include "host/contact/contact.hpp"
#include "tests/host/contact/fingers.hpp"

namespace strainfinger::testing {

using contact::Contact;
using contact::ContactRequest;
using contact::ContactSize;
using contact::Indenter;
using contact::Regime;
using contact::SurfaceKernel;

inline ContactRequest ofWidth(double width_m) {
  ContactRequest request;
  request.size = {ContactSize::Kind::kWidth, width_m};
  return request;
}

inline ContactRequest ofLoad(double load_n_per_m) {
  ContactRequest request;
  request.size = {ContactSize::Kind::kLoad, load_n_per_m};
  return request;
}

inline ContactRequest sliding(double friction) {
  ContactRequest request = ofWidth(2e-3);
  request.regime = Regime::kSliding;
  request.friction = friction;
  return request;
}

inline ContactRequest sticking(double tangential_n_per_m) {
  ContactRequest request = ofWidth(2e-3);
  request.regime = Regime::kStick;
  request.tangential_n_per_m = tangential_n_per_m;
  return request;
}

inline Contact solve(const ContactRequest& request, const model::Annulus<double>& finger = kDefaultFinger) {
  return solveContact(SurfaceKernel(finger), request);
}

/// Measured every 10 um over +-4 mm.
template <typename Height>
Indenter measured(Height height) {
  std::vector<double> x, y;
  for (int i = -400; i <= 400; ++i) {
    x.push_back(i * 10e-6);
    y.push_back(height(x.back()));
  }
  return Indenter::measured(x, y);
}

/// Waves 1 mm long and 50 um high: several regions of contact.
inline Indenter waves() {
  return measured([](double x) { return 25e-6 * (1 - std::cos(2 * std::numbers::pi * x / 1e-3)); });
}

}  // namespace strainfinger::testing
