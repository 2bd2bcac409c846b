#pragma once
// `replay --recompute`: a recording put through the firmware's code.

#include <functional>
#include <optional>

#include "host/base/table_writer.hpp"
#include "host/can/bus_port.hpp"
#include "host/recompute/recomputer.hpp"

namespace strainfinger::cli {

/// Takes all frames of a recording, in order, from `next`, and prints what came of it on stdout: a row
/// node,sets,left_out,gaps,compared,different,absent. Throws Failure(kVerificationFailed) when a frame
/// differs from what the readings give or is absent, Failure(kFailure) when there was nothing to compare,
/// Failure(kMismatch) when the finger had other tables. `bitrate`: of the bus [bit/s].
void recompute(const std::function<std::optional<can::TimedFrame>()>& next, const TableImage& tables,
               const recompute::RecordedFinger& finger, std::uint32_t bitrate, TableFormat format);

}  // namespace strainfinger::cli
