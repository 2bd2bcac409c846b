#pragma once
// An answer as quantities with units, and how far to trust them.

#include "common/contact.hpp"
#include "firmware/core/locator.hpp"
#include "firmware/core/units.hpp"

namespace strainfinger::firmware {

/// Standard errors of a linearisation's unknowns [their units], of readings of variance 1; 0: undetermined.
struct UnitErrors {
  Hypothesis hypothesis;
  ContactStates slopesAt;
  std::array<Root, kMostUnknowns> sigma{};

  /// Neither the hypothesis nor the columns are others.
  bool areOf(const Linearisation& linearisation) const {
    return hypothesis == linearisation.hypothesis && slopesAt == linearisation.slopesAt;
  }
};

/// The quality of an uncertain contact is at most this [percent].
inline constexpr std::uint8_t kMostUncertainQuality = 20;

/// Cost: a root an unknown, and the diagonal of the inverse.
UnitErrors unitErrors(const Linearisation& linearisation);

/// Place, loads, width, their standard errors, and quality of one of the answer's contacts. The errors are
/// the Cramer-Rao bound of the readings used at their variance (noise, rounding and model error) with what no
/// residual shows (the tables' errors of places, loads and second moments), widened to cover a rival that is
/// nearly as likely. Cost: some square roots, so only for what is reported.
Contact estimate(const TableConstants& constants, const Answer& answer, const UnitErrors& errors,
                 int contact);

}  // namespace strainfinger::firmware
