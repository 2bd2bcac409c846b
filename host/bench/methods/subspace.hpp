#pragma once
// Projections onto the two responses: the best loads for a given place without solving for them.

#include "host/bench/methods/sample.hpp"

namespace strainfinger::bench {

/// Both responses over some gauges with the contact at one place, B = U R.
template <typename Real, std::size_t Size>
struct Projection {
  std::array<Real, Size> first, second;  ///< columns of U
  std::array<Real, 3> load;              ///< R^-1: 11, 12, 22 [N/m per strain]

  /// What is projected: its squared length is the energy explained.
  struct Shadow {
    Real first, second;
    Real energy() const { return first * first + second * second; }
  };
  template <typename Strains>  // indexed 0 .. Size - 1
  Shadow of(const Strains& strain) const {
    Shadow shadow{};
    for (std::size_t k = 0; k < Size; ++k) {
      shadow.first += this->first[k] * strain[k];
      shadow.second += this->second[k] * strain[k];
    }
    return shadow;
  }
  Place<Real> placeOf(Real position_pitch, const Shadow& shadow) const {
    return {position_pitch, load[0] * shadow.first + load[1] * shadow.second, load[2] * shadow.second};
  }
};

/// What friction allows: 1.25 times a coefficient of 1, as the firmware's tables have it.
template <typename Real>
bool isPossible(const Place<Real>& place) {
  constexpr Real kCone = 1.25;
  return place.normal > 0 && place.tangential <= kCone * place.normal &&
         -place.tangential <= kCone * place.normal;
}

}  // namespace strainfinger::bench
