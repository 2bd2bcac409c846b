#include "host/cli/listening.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "host/base/failure.hpp"
#include "host/cli/bus_option.hpp"
#include "host/cli/command.hpp"
#include "host/system/stop_signal.hpp"

namespace strainfinger::cli {

ListeningOptions::ListeningOptions(CLI::App& command, double least_s, double default_s, const char* why)
    : duration_s(default_s) {
  addBusOption(command, bus);
  command
      .add_option("--duration", duration_s,
                  fmt::format("Listen for so long (default {}: {})", default_s, why))
      ->type_name("S")
      ->check(isFrom(least_s, 3600));
}

std::chrono::milliseconds ListeningOptions::duration() const {
  return std::chrono::milliseconds(std::llround(duration_s * 1e3));
}

std::vector<live::BusView> listenTo(std::vector<ListenedBus>& buses, std::chrono::milliseconds duration,
                                    const char* command) {
  using Clock = std::chrono::steady_clock;
  constexpr std::chrono::milliseconds kTurn{20};
  if (buses.empty()) return {};
  const system::StopSignal stop;
  const Clock::time_point end = Clock::now() + duration;
  while (Clock::now() < end && !stop.asked())
    for (ListenedBus& bus : buses) bus.watch().listen(kTurn);
  if (stop.asked()) throw Failure(ExitCode::kInterrupted, fmt::format("{}: interrupted", command));
  std::vector<live::BusView> views;
  for (ListenedBus& bus : buses) views.push_back(bus.watch().view());
  return views;
}

void addExpectOption(CLI::App& command, std::vector<int>& nodes) {
  addList(command, "--expect", nodes, "Nodes that must be there, as in 1,2,5: exit status 4 where one isn't",
          isNode())
      .type_name("N,N");
}

std::vector<int> missingOf(const std::vector<int>& nodes, std::span<const live::BusView> buses) {
  std::vector<int> missing;
  for (const int node : nodes) {
    const auto isThere = [&](const live::FingerView& finger) {
      return finger.node == node && !finger.isSilent();
    };
    if (!std::ranges::any_of(
            buses, [&](const live::BusView& bus) { return std::ranges::any_of(bus.fingers, isThere); }))
      missing.push_back(node);
  }
  return missing;
}

}  // namespace strainfinger::cli
