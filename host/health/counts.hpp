#pragma once
// What a finger counts.

#include <cstdint>
#include <optional>
#include <vector>

#include "common/commands.hpp"
#include "host/can/bus_port.hpp"

namespace strainfinger::health {

struct Counted {
  Count count;
  std::optional<std::uint32_t> value;  ///< nothing: it didn't say
};

/// Asks for each count, until one is not answered. Cost: a few milliseconds, a second where nobody answers.
std::vector<Counted> askForCounts(can::BusPort& port, std::uint8_t node);

}  // namespace strainfinger::health
