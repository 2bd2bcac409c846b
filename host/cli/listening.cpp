#include "host/cli/listening.hpp"

#include <fmt/format.h>

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

}  // namespace strainfinger::cli
