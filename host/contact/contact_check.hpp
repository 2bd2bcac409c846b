#pragma once
// What a contact is held against after it was found: its own tractions, and the indenter.

#include <optional>

#include "host/contact/contact.hpp"

namespace strainfinger::contact {

/// Whether tractions oscillate at the edges, as they do where a compressible rubber sticks: ever faster
/// towards them, so that no number of terms converges.
bool isIllPosed(const SurfaceKernel& kernel, const ContactRequest& request);

/// How far u_r is from an indenter at worst, where it touches, and u_t from shift_m if given [m]: between the
/// solver's points, close to the edges too.
double residual(const SurfaceKernel& kernel, const Indenter& indenter, const Tractions& tractions,
                double approach_m, std::optional<double> shift_m = {});

/// Fills in the residual and the warnings of a contact that has everything else.
/// Throws Failure(kFailure) if more than a tenth of the depth is unresolved, or if a compressible rubber
/// sticks and the edges' resolution decides the load by more than a tenth.
void checkContact(const SurfaceKernel& kernel, const ContactRequest& request, Contact& contact);

}  // namespace strainfinger::contact
