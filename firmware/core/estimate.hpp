#pragma once
// An answer as quantities with units, and how far to trust them.

#include "common/contact.hpp"
#include "firmware/core/locator.hpp"

namespace strainfinger::firmware {

/// Place, loads, width, their standard errors, and quality of one of the answer's contacts. The errors are
/// the Cramer-Rao bound of the readings used at their variance (noise, rounding and model error) with what no
/// residual shows (the tables' errors of places, loads and second moments), widened to cover a rival that is
/// nearly as likely. Cost: some square roots, so only for what is reported.
Contact estimate(const TableConstants& constants, const Answer& answer, const Linearisation& linearisation,
                 int contact);

}  // namespace strainfinger::firmware
