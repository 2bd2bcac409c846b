#pragma once
// The option --can of every subcommand that listens or speaks on a bus.

#include <CLI/CLI.hpp>
#include <string>

namespace strainfinger::cli {

/// Adds --can: a name for can::openBus(). The option, for what else holds of it (required()).
CLI::Option* addBusOption(CLI::App& command, std::string& name);

}  // namespace strainfinger::cli
