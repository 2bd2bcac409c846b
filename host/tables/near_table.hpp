#pragma once
// What the three readings around a contact tell by themselves.

#include "common/table_image.hpp"
#include "host/tables/fit_table.hpp"

namespace strainfinger::tables {

/// The offset from which on the middle reading and the difference of the two beside it would tell no loads,
/// or two pitches [pitches]; at least kLeastNearPole_q15 / 2^15.
double nearPole(const model::ImpulseResponse& response, int gaugeCount);

/// Responses in units of `peak`; loads * 2^(amplitudeExponent - 1) (1 - offset / pole). From the first row on
/// whose numbers don't fit all are 0.
NearTable nearTable(const WindowResponses& responses, double peak, int amplitudeExponent, double pole_pitch);

}  // namespace strainfinger::tables
