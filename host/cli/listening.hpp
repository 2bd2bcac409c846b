#pragma once
// Listening to buses for a while, to hear which fingers there are and how they are.

#include <CLI/CLI.hpp>
#include <chrono>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "host/can/bus_port.hpp"
#include "host/config/finger_config.hpp"
#include "host/live/bus_watch.hpp"

namespace strainfinger::cli {

struct ListeningOptions {
  /// `why`: of that default, for --help.
  ListeningOptions(CLI::App& command, double least_s, double default_s, const char* why);
  std::chrono::milliseconds duration() const;

  std::string bus;  ///< empty: not said
  double duration_s;
};

/// Adds --expect: nodes that must be there.
void addExpectOption(CLI::App& command, std::vector<int>& nodes);

/// Those of `nodes` that are on none of the buses, or silent there.
std::vector<int> missingOf(const std::vector<int>& nodes, std::span<const live::BusView> buses);

/// A bus that is open.
class ListenedBus {
 public:
  ListenedBus(std::unique_ptr<can::BusPort> port, const config::FingerConfig& config)
      : port_(std::move(port)), watch_(std::make_unique<live::BusWatch>(*port_, config)) {}
  can::BusPort& port() { return *port_; }
  live::BusWatch& watch() { return *watch_; }

 private:
  std::unique_ptr<can::BusPort> port_;
  std::unique_ptr<live::BusWatch> watch_;
};

/// What was heard on each in all that time, at once where there is none. Throws Failure(kInterrupted) at
/// Ctrl-C, in the name of `command`.
std::vector<live::BusView> listenTo(std::vector<ListenedBus>& buses, std::chrono::milliseconds duration,
                                    const char* command);

}  // namespace strainfinger::cli
