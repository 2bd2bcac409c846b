#pragma once
// Maximum likelihood over the whole ring and all places: what no estimator of these readings beats for long.

#include <algorithm>
#include <limits>

#include "host/bench/methods/gauss_newton.hpp"
#include "host/bench/methods/subspace.hpp"

namespace strainfinger::bench {

template <typename Real>
struct GlobalBank {
  static constexpr std::size_t kPerPitch = 16;
  std::array<Projection<Real, kGauges>, kPerPitch> rows;  ///< contact i / kPerPitch pitches beyond gauge 0
};

/// Explained energy on a grid of 256 places; every possible one of its maxima that explains at least half as
/// much as the best is stepped to its end over all gauges, and the one that leaves least is the answer.
template <typename Real>
class GlobalSearch {
 public:
  GlobalSearch(const RingResponse<Real>& response, const GlobalBank<Real>& bank)
      : response_(response), bank_(bank) {}

  Place<Real> operator()(const Ring<Real>& strain) {
    project(strain);
    const Real worthwhile = *std::max_element(energy_.begin(), energy_.end()) / 2;
    Minimum<Real> best{placeWithoutLoads(std::numeric_limits<Real>::quiet_NaN()), kNothing};
    for (int point = 0; point < kPoints; ++point) {
      if (energyAt(point) < worthwhile || !isMaximum(point)) continue;
      const auto end = gaussNewton<kGauges>(response_, strain, places_[indexOf(point)], kSteps);
      if (isPossible(end.place) && end.residual < best.residual) best = end;
    }
    return best.place;
  }

 private:
  static constexpr std::size_t kPerPitch = GlobalBank<Real>::kPerPitch;
  static constexpr int kPoints = static_cast<int>(kPerPitch) * kGauges;
  static constexpr int kSteps = 20;
  static constexpr Real kNothing = std::numeric_limits<Real>::max();

  static std::size_t indexOf(int point) { return static_cast<std::size_t>(point + kPoints) % kPoints; }
  Real energyAt(int point) const { return energy_[indexOf(point)]; }
  bool isMaximum(int point) const {
    return energyAt(point) >= energyAt(point - 1) && energyAt(point) > energyAt(point + 1);
  }

  void project(const Ring<Real>& strain) {
    Ring<Real> turned = strain;
    for (std::size_t point = 0; point < kPoints; ++point) {
      const auto& row = bank_.rows[point % kPerPitch];
      const auto shadow = row.of(turned);
      energy_[point] = shadow.energy();
      places_[point] = row.placeOf(static_cast<Real>(point) / kPerPitch, shadow);
      if ((point + 1) % kPerPitch == 0) std::rotate(turned.begin(), turned.begin() + 1, turned.end());
    }
  }

  const RingResponse<Real>& response_;
  const GlobalBank<Real>& bank_;
  std::array<Real, static_cast<std::size_t>(kPoints)> energy_;
  std::array<Place<Real>, static_cast<std::size_t>(kPoints)> places_;
};

}  // namespace strainfinger::bench
