#pragma once
// A locator on a finger as drawn, for tests of what it does set by set.

#include <algorithm>
#include <cmath>
#include <vector>

#include "firmware/core/locator.hpp"
#include "tests/firmware/core/model_ring.hpp"

#include <CppUTest/TestHarness.h>

namespace strainfinger {

struct LocatedFinger : Utest {
  const ModelRing ring{ModelRing::asDrawn()};
  firmware::Locator locator{firmware::FitMode::kRefined};
  static constexpr int kLongestSearch = 400;  ///< sample sets

  void update(const ModelRing& of, const std::vector<double>& strains, firmware::GaugeSet gauges) {
    locator.update(of.tables(), of.raw(strains), gauges);
  }
  void update(const std::vector<double>& strains) { update(ring, strains, ring.allGauges()); }
  /// Until the search, if there is one, is over; returns the updates that it took.
  int settle(const std::vector<double>& strains) { return settle(strains, ring.allGauges()); }
  int settle(const std::vector<double>& strains, firmware::GaugeSet gauges) {
    int updates = 0;
    do update(ring, strains, gauges);
    while (locator.answer().searching && ++updates < kLongestSearch);
    return updates;
  }
  Press found(int contact = 0) const { return foundBy(locator, ring, contact); }
  static Press foundBy(const firmware::Locator& by, const ModelRing& of, int contact = 0) {
    return of.pressOf(by.answer().solution.contact[static_cast<std::size_t>(contact)], by.answer().shift);
  }
  /// Largest difference of place and loads, over the Cramer-Rao bound.
  double sigmasBetween(const Press& a, const Press& b, const Eigen::Vector4d& bound) const {
    return std::max({std::abs(ring.between(a.position_pitch, b.position_pitch)) / bound[0],
                     std::abs(a.normal - b.normal) / bound[1],
                     std::abs(a.tangential - b.tangential) / bound[2]});
  }
  double off_pitch(const Press& press, int contact = 0) const {
    return std::abs(ring.between(press.position_pitch, found(contact).position_pitch));
  }
  bool areBothFound(const Press& one, const Press& other, double within_pitch) const {
    if (locator.answer().solution.hypothesis.contacts != 2) return false;
    return (off_pitch(one, 0) < within_pitch && off_pitch(other, 1) < within_pitch) ||
           (off_pitch(one, 1) < within_pitch && off_pitch(other, 0) < within_pitch);
  }
  bool isAccepted(const std::vector<std::int32_t>& strains_q32, std::uint32_t noise_q4) {
    locator.release();
    do locator.update(ring.tables(), strains_q32, ring.allGauges(), noise_q4);
    while (locator.answer().searching);
    return locator.answer().accepted && locator.answer().solution.hypothesis.contacts == 1;
  }
};

}  // namespace strainfinger
