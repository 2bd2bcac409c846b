#pragma once
// What a node is told.

#include <optional>

#include "common/commands.hpp"
#include "hal/can_port.hpp"

namespace strainfinger::firmware {

/// Takes one frame from the port, if there is one: the request that it is to this node, if it is one.
template <hal::CanPort Can>
std::optional<RequestFrame> nextRequest(Can& can, std::uint8_t node) {
  const auto frame = can.receive();
  return frame ? readSingleFrame<RequestFrame>(*frame, node) : std::nullopt;
}

}  // namespace strainfinger::firmware
