#pragma once
// What to do about what a finger says of itself, for people. "" where there is nothing to do.

#include <cstdint>
#include <string>
#include <string_view>

#include "common/commands.hpp"
#include "common/frames.hpp"

namespace strainfinger::can {

std::string_view remedyFor(FingerFault fault);
std::string_view remedyFor(FingerFlag flag);
std::string_view remedyFor(FingerState state);
std::string_view remedyFor(ResetCause cause);
std::string_view remedyFor(Crash crash);
std::string_view remedyFor(Count count);  ///< where it is too high

/// Of a finger whose HEARTBEAT has another protocol version: its other frames mean something else.
std::string foreignText(std::uint8_t protocol);

/// Of a request that was not done; `bus` as --can takes it.
std::string remedyFor(CommandStatus status, std::string_view bus);

}  // namespace strainfinger::can
