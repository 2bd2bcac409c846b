#pragma once
// Fits without some of the gauges: saturated ones, broken ones.

#include <bit>
#include <cstdint>
#include <span>

#include "firmware/core/locate.hpp"
#include "firmware/core/tangent.hpp"

namespace strainfinger::firmware {

/// A contact that the remaining gauges may show.
struct Candidate {
  Placement place{};
  std::int32_t explained = -1;  ///< energy of the remaining readings; -1: none
  bool admissible = false;      ///< found to the end, presses, within the friction cone

  bool betterThan(const Candidate& other) const { return standing() > other.standing(); }

 private:
  /// Noise may move a contact out of the cone, and a last step be missing: neither hides more than 1/512.
  std::int32_t standing() const { return admissible ? explained : explained - (explained >> 9); }
};

/// Follows the remaining readings from a view to the nearest best fit; at most eight steps.
Candidate followed(const Problem& problem, const RingSignal& signal, View view);

/// The two best contacts of the whole ring, for the remaining gauges. Cost: 128 projections with 16 gauges
/// and up to fifteen fits; only rings with a gauge out of use pay it.
struct Rivals {
  Candidate best;
  Candidate second;
};
Rivals searchRemaining(const Problem& problem, const RingSignal& signal);

/// With more gauges out than one in eight of the ring, another contact can look like the one that is there.
constexpr bool tooManyOut(GaugeSet leftOut, int gauges) { return std::popcount(leftOut) > gauges / 8; }

/// Fits one contact to the readings that are not in `leftOut`, which are replaced in `strains_q32` by what
/// the others say they should be: a fit to all of them is then the fit to the others. Its errors are those of
/// the others; where these cannot tell, the fit is not settled. `energy`: gateEnergy() of the others.
Fit locateWithout(const TableImage& tables, GaugeSet leftOut, std::span<std::int32_t> strains_q32,
                  std::uint32_t energy);

}  // namespace strainfinger::firmware
