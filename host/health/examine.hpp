#pragma once
// Looking for what is wrong with an interface, a bus or a finger. Each examination finds at least one thing:
// where nothing is wrong, one that is good.

#include <chrono>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "common/frames.hpp"
#include "host/can/bus_port.hpp"
#include "host/health/can_links.hpp"
#include "host/health/counts.hpp"
#include "host/health/finding.hpp"
#include "host/live/finger_view.hpp"

namespace strainfinger::health {

/// `bitrate`: that of the config [bit/s]; nothing: there is none, any will do.
Findings examineLink(const CanLink& link, std::optional<int> bitrate);

/// The bus as a whole, listened to for so long. `state`, `hints`: of its port.
Findings examineBus(const live::BusView& bus, hal::CanState state, const can::BusHints& hints,
                    std::chrono::milliseconds listened);

/// `tables_crc32`: of the tables that it should have, of which HEARTBEAT has the lowest byte; nothing: not
/// known.
Findings examineFinger(const std::string& bus, const live::FingerView& finger,
                       std::optional<std::uint32_t> tables_crc32);

/// Whether requests to a finger can be answered: it is heard, speaks this protocol, has its node number to
/// itself, and is not in state fault.
bool canAnswer(const live::FingerView& finger);

/// What came of askForCounts(). `hints`: of the bus' port.
Findings examineCounts(const std::string& bus, std::uint8_t node, std::span<const Counted> counts,
                       const can::BusHints& hints);

}  // namespace strainfinger::health
