#pragma once
// Which part of a log: the options --from and --to of the subcommands that read one.

#include <CLI/CLI.hpp>

#include "host/can/time_window.hpp"

namespace strainfinger::cli {

/// What of the logs is meant.
void addWindowOptions(CLI::App& command, can::TimeWindow& window);

}  // namespace strainfinger::cli
