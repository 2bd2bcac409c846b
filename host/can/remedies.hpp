#pragma once
// What to do about what a finger says of itself, for people. "" where there is nothing to do. Commands in
// these texts have `--can BUS`, those to one finger also `-n N`: forNode() says which.

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
std::string_view remedyFor(Count count);           ///< where it is too high
std::string_view remedyFor(CommandStatus status);  ///< of a request that was not done

/// Erases of the settings' memory that wear it out: four pages last 10,000 each (DS12589).
inline constexpr std::uint32_t kWornOut_erases = 40'000;

inline constexpr std::string_view kTwinText = "two fingers have this node number";
inline constexpr std::string_view kTwinRemedy =
    "take one off the bus; `strainfinger config --can BUS -n N --set-node NODE` makes the other another "
    "node, from its next start on";

/// Where another program asks the same finger.
inline constexpr std::string_view kOthersAskRemedy = "let one at a time do so";

/// Of a finger whose HEARTBEAT has another protocol version: its other frames mean something else.
std::string foreignText(std::uint8_t protocol);

/// A remedy whose commands are for this bus, and for any finger on it.
std::string onBus(std::string_view remedy, std::string_view bus);

/// A remedy whose commands are for this finger. Its number is in them even where it is that of the default
/// config: they may be given with another one.
std::string forNode(std::string_view remedy, std::string_view bus, std::uint8_t node);

}  // namespace strainfinger::can
