#pragma once
// A fit as quantities with units, and how far to trust them.

#include "common/contact.hpp"
#include "firmware/core/locate.hpp"

namespace strainfinger::firmware {

/// Angle, loads, standard errors, quality. The errors are the Cramer-Rao bound of the readings used, at the
/// noise in the tables, widened to cover another place that noise may hide (Fit::deficit). Cost: three square
/// roots, so only for fits that are reported.
Contact estimate(const TableConstants& constants, const Fit& fit);

}  // namespace strainfinger::firmware
