#pragma once
// An answer as quantities with units, and how far to trust them.

#include "common/contact.hpp"
#include "firmware/core/locator.hpp"
#include "firmware/core/units.hpp"

namespace strainfinger::firmware {

/// Standard errors of a linearisation's unknowns [their units] for readings of variance 1; 0: undetermined.
struct UnitErrors {
  Hypothesis hypothesis;
  ContactStates slopesAt;
  std::array<Root, kMostUnknowns> sigma{};

  /// The linearisation's hypothesis and columns are still those that the errors were computed from.
  bool areOf(const Linearisation& linearisation) const {
    return hypothesis == linearisation.hypothesis && slopesAt == linearisation.slopesAt;
  }
};

/// The quality of an uncertain contact is at most this [percent].
inline constexpr std::uint8_t kMostUncertainQuality = 20;

/// Cost: the diagonal of the inverse, and a root for each unknown.
UnitErrors unitErrors(const Linearisation& linearisation);

/// Place, loads, width, their standard errors, and quality of the contact that is told as the first (0) or
/// the second (1). The errors are the Cramer-Rao bound for the readings used and their variance (noise,
/// rounding and model error), together with what no residual shows (errors of places, loads and second
/// moments, from the tables), and are raised to cover a rival that is nearly as likely. Cost: some square
/// roots, so only for what is reported.
Contact estimate(const TableConstants& constants, const Answer& answer, const UnitErrors& errors, int told);

}  // namespace strainfinger::firmware
