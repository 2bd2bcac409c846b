#pragma once
// What a finger counts.

#include <cstdint>
#include <vector>

#include "common/commands.hpp"
#include "host/can/bus_port.hpp"

namespace strainfinger::health {

enum class CountAnswer {
  kTold,
  kNotCounted,  ///< by this firmware
  kOthersAsk,   ///< so often that no response is surely of this count
  kSilence,     ///< no answer, though it was asked twice
  kNotSent,     ///< the bus took no request
};

struct Counted {
  Count count;
  CountAnswer answer;
  std::uint32_t value = 0;  ///< 0 where it was not told
};

/// Asks for each count; after silence, or where nothing can be sent, for no more. Cost: a few milliseconds,
/// two seconds where nobody answers.
std::vector<Counted> askForCounts(can::BusPort& port, std::uint8_t node);

}  // namespace strainfinger::health
