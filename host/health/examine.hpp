#pragma once
// Looking for what is wrong with an interface, a bus or a finger. Each examination finds at least one thing:
// where nothing is wrong, one that is good.

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "common/frames.hpp"
#include "host/can/bus_port.hpp"
#include "host/health/can_links.hpp"
#include "host/health/counts.hpp"
#include "host/health/finding.hpp"
#include "host/live/finger_view.hpp"

namespace strainfinger::health {

/// `bitrate`: that of the config [bit/s].
Findings examineLink(const CanLink& link, int bitrate);

/// The bus as a whole, listened to for so long. `hints`: of its port.
Findings examineBus(const live::BusView& bus, const can::BusHints& hints, std::chrono::milliseconds listened);

/// `tables_crc32`: of the tables that it should have; nothing: not known.
Findings examineFinger(const live::BusView& bus, const live::FingerView& finger,
                       std::optional<std::uint32_t> tables_crc32);

/// Whether its tables may be those of this CRC-32: HEARTBEAT has the lowest byte alone.
bool areTables(const HeartbeatFrame& heartbeat, std::uint32_t crc32);
std::string otherTablesText(const HeartbeatFrame& heartbeat, std::uint32_t crc32);
inline constexpr std::string_view kOtherTablesRemedy =
    "give the config that its tables were made from (-c), or flash those that `strainfinger tables -o FILE` "
    "makes of this one";

/// Whether requests to a finger can be answered: it is heard, speaks this protocol, has its node number to
/// itself, and is not in state fault.
bool canAnswer(const live::FingerView& finger);

/// What came of askForCounts().
Findings examineCounts(const std::string& where, std::span<const Counted> counts);

}  // namespace strainfinger::health
