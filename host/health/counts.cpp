#include "host/health/counts.hpp"

#include "host/can/ask.hpp"

namespace strainfinger::health {

std::vector<Counted> askForCounts(can::BusPort& port, std::uint8_t node) {
  std::vector<Counted> counts;
  bool isAnswering = true;
  for (const ValueName& name : kCountNames) {
    const Count count{name.value};
    std::optional<std::uint32_t> value;
    if (isAnswering) {
      const auto response = can::ask(port, node, countRequest(count)).response;
      if (response && response->status == CommandStatus::kDone) value = response->value;
    }
    isAnswering = value.has_value();
    counts.push_back({count, value});
  }
  return counts;
}

}  // namespace strainfinger::health
