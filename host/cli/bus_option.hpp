#pragma once
// Which bus: the option --can of every subcommand that listens or speaks on one, and --interface of those
// that read a log of several.

#include <CLI/CLI.hpp>
#include <string>

namespace strainfinger::cli {

/// Adds --can: a name for can::openBus(). The option, for what else holds of it (required()).
CLI::Option* addBusOption(CLI::App& command, std::string& name);

/// Adds --interface: the name, in a log, of the interface whose frames are meant; "" without it: all. The
/// option, for what else holds of it.
CLI::Option* addInterfaceOption(CLI::App& command, std::string& name);

}  // namespace strainfinger::cli
