#pragma once
// How this node's frames share the controller, and what it listens to.

#include <array>

#include "common/frame_layout.hpp"
#include "firmware/board/stm32g431/fdcan_port.hpp"

namespace strainfinger::stm32g431 {

/// An old touch or heartbeat is worth nothing once there is a newer one; parts of a response belong together.
/// Touches never wait for anything else of this node.
constexpr SendRule sendRule(std::uint16_t id) {
  const auto is = [id](FunctionCode function) { return nodeOf(id, function).has_value(); };
  const bool touch = is(FunctionCode::kContact) || is(FunctionCode::kForce) || is(FunctionCode::kPatch) ||
                     is(FunctionCode::kContact2) || is(FunctionCode::kForce2);
  return {.newestWins = touch || is(FunctionCode::kHeartbeat), .background = !touch};
}

/// All that the finger reads: requests to this node.
constexpr std::array<std::uint16_t, 1> identifiersFor(std::uint8_t node) {
  return {canId(FunctionCode::kRequest, node)};
}

}  // namespace strainfinger::stm32g431
